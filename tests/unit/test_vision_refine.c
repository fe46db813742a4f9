/*
 * The filters of a map after matching: what start refuses, and small maps by hand.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/refine.h"
#include "unity.h"

#define NONE TSR_DISPARITY_INVALID
#define WIDTH 20
#define HEIGHT 12
#define PIXELS (WIDTH * HEIGHT)
#define SIZE_MIN 50 /* the default of speckle removal */

static uint16_t map[PIXELS];
static _Alignas(2) uint8_t scratch[TSR_SPECKLE_SCRATCH_LEN(WIDTH, SIZE_MIN) + 2];
static struct tsr_refine refine;
static union {
    struct tsr_median median;
    struct tsr_speckle speckle;
    struct tsr_fill fill;
    struct tsr_gaussian gaussian;
    struct tsr_diffusion diffusion;
    uint8_t bytes[64];
} work;
static const struct tsr_speckle_config kSpeckle;
static const struct tsr_diffusion_config kDiffusion;

void setUp(void)
{
    memset(map, 0, sizeof map);
    memset(scratch, 0xa5, sizeof scratch);
    memset(&refine, 0xa5, sizeof refine);
    memset(&work, 0xa5, sizeof work);
}
void tearDown(void) {}

static void expect_untouched(const void *object, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xa5, ((const uint8_t *)object)[i]);
    }
}

/* Every filter's start with one signature, as the refusals below are the same. */
typedef enum tsr_status (*start_function)(void *state, uint16_t width, uint16_t height, uint16_t *at, size_t map_cap,
                                          uint8_t *room, size_t room_cap);

static enum tsr_status start_median5(void *state, uint16_t width, uint16_t height, uint16_t *at, size_t map_cap,
                                     uint8_t *room, size_t room_cap)
{
    return tsr_median_start_window(state, 5, width, height, at, map_cap, room, room_cap);
}

static enum tsr_status start_speckle(void *state, uint16_t width, uint16_t height, uint16_t *at, size_t map_cap,
                                     uint8_t *room, size_t room_cap)
{
    return tsr_speckle_start(state, &kSpeckle, width, height, at, map_cap, room, room_cap);
}

static enum tsr_status start_fill(void *state, uint16_t width, uint16_t height, uint16_t *at, size_t map_cap,
                                  uint8_t *room, size_t room_cap)
{
    return tsr_fill_start(state, TSR_FILL_BACKGROUND, width, height, at, map_cap, room, room_cap);
}

static enum tsr_status start_gaussian5(void *state, uint16_t width, uint16_t height, uint16_t *at, size_t map_cap,
                                       uint8_t *room, size_t room_cap)
{
    return tsr_gaussian_start(state, 5, width, height, at, map_cap, room, room_cap);
}

static enum tsr_status start_diffusion(void *state, uint16_t width, uint16_t height, uint16_t *at, size_t map_cap,
                                       uint8_t *room, size_t room_cap)
{
    return tsr_diffusion_start(state, &kDiffusion, width, height, at, map_cap, room, room_cap);
}

static void expect_refusals(start_function start, size_t len)
{
    uint16_t *odd = (uint16_t *)(void *)((uint8_t *)map + 1);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(NULL, WIDTH, HEIGHT, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, WIDTH, HEIGHT, NULL, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, WIDTH, HEIGHT, odd, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, 0, HEIGHT, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, WIDTH, 0, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, TSR_IMAGE_WIDTH_MAX + 1, 1, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, 1, TSR_IMAGE_HEIGHT_MAX + 1, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(&work, WIDTH, HEIGHT, map, PIXELS - 1, scratch, len));
    if (len > 0) {
        TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, WIDTH, HEIGHT, map, PIXELS, NULL, len));
        TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&work, WIDTH, HEIGHT, map, PIXELS, scratch + 1, len));
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(&work, WIDTH, HEIGHT, map, PIXELS, scratch, len - 1));
    }
    expect_untouched(&work, sizeof work);
    expect_untouched(scratch, sizeof scratch);
    TEST_ASSERT_EQUAL(TSR_OK, start(&work, WIDTH, HEIGHT, map, PIXELS, len > 0 ? scratch : NULL, len));
}

static void test_start_refuses_what_it_must(void)
{
    expect_refusals(start_median5, TSR_MEDIAN_SCRATCH_LEN(WIDTH));
    setUp();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_median_start_window(&work.median, 4, WIDTH, HEIGHT, map, PIXELS, scratch, sizeof scratch));
    expect_refusals(start_speckle, TSR_SPECKLE_SCRATCH_LEN(WIDTH, SIZE_MIN));
    setUp();
    expect_refusals(start_fill, 0);
    setUp();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_fill_start(&work.fill, TSR_FILL_RULE_COUNT, WIDTH, HEIGHT, map, PIXELS, NULL, 0));
    expect_refusals(start_gaussian5, TSR_GAUSSIAN_SCRATCH_LEN(WIDTH, 5));
    setUp();
    for (uint8_t window = 0; window < 8; window++) {
        enum tsr_status wanted = window == 3 || window == 5 ? TSR_OK : TSR_ERR_ARG;
        TEST_ASSERT_EQUAL(
            wanted, tsr_gaussian_start(&work.gaussian, window, WIDTH, HEIGHT, map, PIXELS, scratch, sizeof scratch));
    }
    setUp();
    expect_refusals(start_diffusion, TSR_DIFFUSION_SCRATCH_LEN(WIDTH));
}

static void test_run_refuses_what_it_must(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_speckle_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_fill_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gaussian_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_diffusion_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_speckle_run(&work.speckle, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_fill_run(&work.fill, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gaussian_run(&work.gaussian, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_diffusion_run(&work.diffusion, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_run(&refine, 0));
}

static void test_check_names_the_bad_field(void)
{
    const char *field = NULL;
    const struct tsr_speckle_config one = {.min_size = 1};
    const struct tsr_speckle_config many = {.min_size = TSR_SPECKLE_SIZE_MAX + 1};
    const struct tsr_diffusion_config often = {.iterations = TSR_DIFFUSION_ITERATIONS_MAX + 1};
    const struct tsr_diffusion_config fast = {.rate_q8 = 65};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_speckle_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_speckle_check(&one, &field));
    TEST_ASSERT_EQUAL_STRING("min_size", field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_speckle_check(&many, NULL));
    TEST_ASSERT_EQUAL(0, tsr_speckle_scratch_len(&many, WIDTH));
    TEST_ASSERT_EQUAL(4 * WIDTH + 6 * 49, tsr_speckle_scratch_len(&kSpeckle, WIDTH));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_diffusion_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_diffusion_check(&often, &field));
    TEST_ASSERT_EQUAL_STRING("iterations", field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_diffusion_check(&fast, &field));
    TEST_ASSERT_EQUAL_STRING("rate_q8", field);
}

static void expect_bad(struct tsr_refine_config config, const char *name)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_check(&config, &field));
    TEST_ASSERT_EQUAL_STRING(name, field);
    TEST_ASSERT_EQUAL(0, tsr_refine_scratch_len(&config));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_start(&refine, &config, map, PIXELS, scratch, sizeof scratch));
    expect_untouched(&refine, sizeof refine);
}

static void test_refine_refuses_what_it_must(void)
{
    const struct tsr_refine_config good = {
        .width = WIDTH, .height = HEIGHT, .steps = {TSR_REFINE_MEDIAN3, TSR_REFINE_SPECKLE, TSR_REFINE_FILL}};
    const char *field = NULL;
    struct tsr_refine_config bad = good;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
    bad.width = 0;
    expect_bad(bad, "width");
    bad = good;
    bad.height = TSR_IMAGE_HEIGHT_MAX + 1;
    expect_bad(bad, "height");
    bad = good;
    bad.steps[1] = TSR_REFINE_STEP_COUNT;
    expect_bad(bad, "steps");
    bad = good;
    bad.steps[5] = TSR_REFINE_FILL; /* behind the end */
    expect_bad(bad, "steps");
    bad = good;
    bad.speckle.min_size = 1;
    expect_bad(bad, "min_size");
    bad = good;
    bad.diffusion.rate_q8 = 65;
    expect_bad(bad, "rate_q8");
    bad = good;
    bad.fill_rule = TSR_FILL_RULE_COUNT;
    expect_bad(bad, "fill_rule");

    size_t len = tsr_refine_scratch_len(&good);
    TEST_ASSERT_EQUAL(TSR_SPECKLE_SCRATCH_LEN(WIDTH, SIZE_MIN), len);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_start(NULL, &good, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_start(&refine, NULL, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_start(&refine, &good, NULL, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_refine_start(&refine, &good, map, PIXELS, NULL, len));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_refine_start(&refine, &good, map, PIXELS - 1, scratch, len));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_refine_start(&refine, &good, map, PIXELS, scratch, len - 1));
    expect_untouched(&refine, sizeof refine);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_start(&refine, &good, map, PIXELS, scratch, len));
    TEST_ASSERT_EQUAL(4 * HEIGHT, tsr_refine_rows_total(&refine));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_refine_run(&refine, 4 * HEIGHT - 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_run(&refine, 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_run(&refine, 1));
    TEST_ASSERT_EQUAL(4 * HEIGHT, tsr_refine_rows_done(&refine));
}

static void test_a_chain_without_steps_changes_nothing(void)
{
    const struct tsr_refine_config config = {.width = WIDTH, .height = HEIGHT};
    map[0] = 7;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_start(&refine, &config, map, PIXELS, NULL, 0));
    TEST_ASSERT_EQUAL(0, tsr_refine_rows_total(&refine));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_run(&refine, 1));
    TEST_ASSERT_EQUAL(7, map[0]);
}

static void run_step(enum tsr_refine_step step, const struct tsr_speckle_config *speckle, uint16_t *values,
                     uint16_t width, uint16_t height)
{
    struct tsr_refine_config config = {.width = width, .height = height, .steps = {(uint8_t)step}};
    config.speckle = speckle != NULL ? *speckle : kSpeckle;
    config.diffusion.iterations = 1;
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_refine_start(&refine, &config, values, (size_t)width * height, scratch, sizeof scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_run(&refine, UINT16_MAX));
}

static void test_median5_by_hand(void)
{
    uint16_t values[25];
    for (unsigned i = 0; i < 25; i++) {
        values[i] = (uint16_t)(7u * i % 25u);
    }
    run_step(TSR_REFINE_MEDIAN5, NULL, values, 5, 5);
    TEST_ASSERT_EQUAL(12, values[12]);
    TEST_ASSERT_EQUAL(10, values[0]); /* 0 2 7 9 10 14 17 20 24: all a corner has */
    /* More than half of the nine that lie inside, then just less. */
    uint16_t five[9] = {5, NONE, 5, NONE, 5, NONE, 5, NONE, 5};
    run_step(TSR_REFINE_MEDIAN5, NULL, five, 3, 3);
    for (unsigned i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL(5, five[i]);
    }
    uint16_t four[9] = {5, NONE, 5, NONE, NONE, NONE, 5, NONE, 5};
    run_step(TSR_REFINE_MEDIAN5, NULL, four, 3, 3);
    for (unsigned i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL_HEX16(NONE, four[i]);
    }
}

static void test_speckle_by_hand(void)
{
    /* An island of three, a ring that closes below, and a bridge by a gradient. */
    const uint16_t before[] = {
        90, NONE, 50, 50, 50, /* */
        90, 90,   50, 9,  50, /* */
        10, 17,   50, 50, 50, /* */
    };
    uint16_t wanted[15];
    memcpy(wanted, before, sizeof wanted);
    wanted[0] = wanted[5] = wanted[6] = wanted[8] = wanted[10] = wanted[11] = NONE;
    const struct tsr_speckle_config four = {.min_size = 4, .max_difference_q4 = 7};
    uint16_t values[15];
    memcpy(values, before, sizeof values);
    run_step(TSR_REFINE_SPECKLE, &four, values, 5, 3);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(wanted, values, 15);
    const struct tsr_speckle_config three = {.min_size = 3, .max_difference_q4 = 7};
    wanted[0] = wanted[5] = wanted[6] = 90;
    memcpy(values, before, sizeof values);
    run_step(TSR_REFINE_SPECKLE, &three, values, 5, 3);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(wanted, values, 15);
    const struct tsr_speckle_config pair = {.min_size = 2, .max_difference_q4 = 6};
    memcpy(values, before, sizeof values);
    run_step(TSR_REFINE_SPECKLE, &pair, values, 5, 3);
    TEST_ASSERT_EQUAL_HEX16(NONE, values[10]); /* 10 and 17 differ by more than 6 */
    TEST_ASSERT_EQUAL_HEX16(NONE, values[11]);
}

static void test_fill_by_hand(void)
{
    uint16_t values[] = {
        NONE, NONE, NONE, NONE, /* */
        NONE, 9,    NONE, 4,    /* */
        NONE, NONE, NONE, NONE, /* */
        3,    NONE, NONE, NONE, /* */
    };
    const uint16_t wanted[] = {9, 9, 4, 4, 9, 9, 4, 4, 9, 9, 4, 4, 3, 3, 3, 3};
    run_step(TSR_REFINE_FILL, NULL, values, 4, 4);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(wanted, values, 16);
    uint16_t nothing[] = {NONE, NONE};
    run_step(TSR_REFINE_FILL, NULL, nothing, 2, 1);
    TEST_ASSERT_EQUAL_HEX16(NONE, nothing[0]);
}

static void test_gaussian_by_hand(void)
{
    uint16_t full[] = {0, 0, 0, 0, 8, 0, 0, 0, 0};
    const uint16_t smoothed[] = {1, 1, 1, 1, 2, 1, 1, 1, 1}; /* 8/9 8/12 8/9 8/12 32/16 ... */
    run_step(TSR_REFINE_GAUSSIAN3, NULL, full, 3, 3);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(smoothed, full, 9);
    uint16_t row[] = {10, NONE, 40, 43, NONE};
    const uint16_t wide[] = {14, NONE, 38, 42, NONE}; /* 100 / 7, 422 / 11, 418 / 10 */
    run_step(TSR_REFINE_GAUSSIAN5, NULL, row, 5, 1);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(wide, row, 5);
}

static void test_diffusion_by_hand(void)
{
    uint16_t row[] = {100, 116, NONE, 500, 30};
    /* c(16) = 128: 128 16 64 / 2^16 = 2; c(470) = 0 */
    const uint16_t wanted[] = {102, 114, NONE, 500, 30};
    run_step(TSR_REFINE_DIFFUSION, NULL, row, 5, 1);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(wanted, row, 5);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_start_refuses_what_it_must);
    RUN_TEST(test_run_refuses_what_it_must);
    RUN_TEST(test_check_names_the_bad_field);
    RUN_TEST(test_refine_refuses_what_it_must);
    RUN_TEST(test_a_chain_without_steps_changes_nothing);
    RUN_TEST(test_median5_by_hand);
    RUN_TEST(test_speckle_by_hand);
    RUN_TEST(test_fill_by_hand);
    RUN_TEST(test_gaussian_by_hand);
    RUN_TEST(test_diffusion_by_hand);
    return UNITY_END();
}
