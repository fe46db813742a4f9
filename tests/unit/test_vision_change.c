/*
 * Change detection: contract, settling, rebase, equations (6) to (9) by hand.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/change.h"
#include "unity.h"

#define WIDTH 16
#define HEIGHT 8
#define CELLS (WIDTH / 4 * HEIGHT / 4)
#define STATE_LEN TSR_CHANGE_STATE_LEN(WIDTH, HEIGHT, 4)

static const struct tsr_change_config config = {.width = WIDTH, .height = HEIGHT};
static uint8_t pixels[WIDTH * HEIGHT];
static uint8_t state[STATE_LEN + 1];
static struct tsr_change change;
static struct tsr_change_result result;
static const struct tsr_gray_view frame = {pixels, WIDTH, HEIGHT, WIDTH};

void setUp(void)
{
    memset(pixels, 100, sizeof pixels);
    memset(state, 0xa5, sizeof state);
    memset(&change, 0xa5, sizeof change);
    memset(&result, 0xa5, sizeof result);
}
void tearDown(void) {}

static void expect_bytes(const void *object, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xa5, ((const uint8_t *)object)[i]);
    }
}

static void expect_bad(struct tsr_change_config bad, const char *name)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_check(&bad, &field));
    TEST_ASSERT_EQUAL_STRING(name, field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_check(&bad, NULL));
    TEST_ASSERT_EQUAL(0, tsr_change_state_len(&bad));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_init(&change, &bad, state, sizeof state));
    expect_bytes(&change, sizeof change);
}

#define EXPECT_BAD(member, value)                                                                                      \
    do {                                                                                                               \
        struct tsr_change_config bad = config;                                                                         \
        bad.member = (value);                                                                                          \
        expect_bad(bad, #member);                                                                                      \
    } while (0)

static void test_check_names_the_bad_field(void)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
    EXPECT_BAD(width, 7);
    EXPECT_BAD(width, TSR_IMAGE_WIDTH_MAX + 1);
    EXPECT_BAD(height, 7);
    EXPECT_BAD(height, TSR_IMAGE_HEIGHT_MAX + 1);
    EXPECT_BAD(reduction, 1);
    EXPECT_BAD(reduction, 3);
    EXPECT_BAD(reduction, 16);
    EXPECT_BAD(amplification, 9);
    EXPECT_BAD(deviation_min, 128);
    EXPECT_BAD(deviation_max, 5);
    EXPECT_BAD(min_cells, CELLS + 1);
}

static void test_defaults_are_the_documented_ones(void)
{
    TEST_ASSERT_EQUAL(STATE_LEN, tsr_change_state_len(&config));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    TEST_ASSERT_EQUAL(4, change.config.reduction);
    TEST_ASSERT_EQUAL(4, change.config.amplification);
    TEST_ASSERT_EQUAL(6, change.config.deviation_min);
    TEST_ASSERT_EQUAL(64, change.config.deviation_max);
    TEST_ASSERT_EQUAL(2, change.config.min_cells);
    TEST_ASSERT_EQUAL(4, change.config.settle_frames);
    const struct tsr_change_config large = {.width = 160, .height = 120};
    static uint8_t room[TSR_CHANGE_STATE_LEN(160, 120, 4)];
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &large, room, sizeof room));
    TEST_ASSERT_EQUAL(6, change.config.min_cells);
    const struct tsr_change_config one_cell = {.width = 8, .height = 8, .reduction = 8};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &one_cell, state, sizeof state));
    TEST_ASSERT_EQUAL(1, change.config.min_cells);
}

static void test_init_refuses_what_it_must(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_init(NULL, &config, state, STATE_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_init(&change, NULL, state, STATE_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_init(&change, &config, NULL, STATE_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_change_init(&change, &config, state, STATE_LEN - 1));
    expect_bytes(&change, sizeof change);
    expect_bytes(state, sizeof state);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    expect_bytes(state, sizeof state);
}

static void test_update_refuses_what_it_must(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    const struct tsr_gray_view none = {NULL, WIDTH, HEIGHT, WIDTH};
    const struct tsr_gray_view bad[] = {
        {pixels, WIDTH - 1, HEIGHT, WIDTH}, {pixels, WIDTH, HEIGHT - 1, WIDTH}, {pixels, WIDTH, HEIGHT, WIDTH - 1}};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_update(NULL, &frame, &result));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_update(&change, NULL, &result));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_update(&change, &frame, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_update(&change, &none, &result));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_rebase(NULL, &frame));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_rebase(&change, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_change_rebase(&change, &none));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_change_update(&change, &bad[i], &result));
        TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_change_rebase(&change, &bad[i]));
    }
    expect_bytes(&result, sizeof result);
    expect_bytes(state, sizeof state);
    TEST_ASSERT_EQUAL(0, change.frames);
}

static void update(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&change, &frame, &result));
}

static void settle(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    for (int i = 0; i < 4; i++) {
        update();
        TEST_ASSERT_TRUE(result.settling);
        TEST_ASSERT_FALSE(result.changed);
        TEST_ASSERT_EQUAL(0, result.changed_cells);
    }
}

static void test_an_object_is_a_change_and_a_still_picture_is_none(void)
{
    settle();
    update();
    TEST_ASSERT_FALSE(result.settling);
    TEST_ASSERT_FALSE(result.changed);
    memset(pixels, 200, WIDTH / 2); /* two rows of four: the mean of two cells rises by 50 */
    memset(pixels + WIDTH, 200, WIDTH / 2);
    update();
    TEST_ASSERT_TRUE(result.changed);
    TEST_ASSERT_EQUAL(2, result.changed_cells);
}

static void test_fewer_cells_than_asked_are_no_change(void)
{
    settle();
    memset(pixels, 255, 4);
    update();
    TEST_ASSERT_EQUAL(1, result.changed_cells);
    TEST_ASSERT_FALSE(result.changed);
}

static void test_the_equations_by_hand(void)
{
    settle();
    memset(pixels, 110, sizeof pixels);
    update();
    /* M = 101, D = 9, V = 6 + sgn(4 * 9 - 6) = 7: 9 > 7 */
    TEST_ASSERT_EQUAL(101, state[0]);
    TEST_ASSERT_EQUAL(7, state[CELLS]);
    TEST_ASSERT_EQUAL(CELLS, result.changed_cells);
    update();
    /* M = 102, D = 8, V = 8: not above */
    TEST_ASSERT_EQUAL(102, state[0]);
    TEST_ASSERT_EQUAL(8, state[CELLS]);
    TEST_ASSERT_EQUAL(0, result.changed_cells);
}

static void test_cell_means_are_rounded_to_nearest(void)
{
    memset(pixels, 0, sizeof pixels);
    memset(pixels, 1, 4);
    memset(pixels + WIDTH, 1, 4); /* 8 of 16: ties up */
    memset(pixels + 4, 1, 4);
    memset(pixels + 4 + WIDTH, 1, 3); /* 7 of 16 */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    update();
    TEST_ASSERT_EQUAL(1, state[0]);
    TEST_ASSERT_EQUAL(0, state[1]);
}

static void test_rebase_makes_the_frame_the_background(void)
{
    settle();
    memset(pixels, 200, sizeof pixels);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_rebase(&change, &frame));
    TEST_ASSERT_EQUAL(200, state[0]);
    TEST_ASSERT_EQUAL(6, state[CELLS]);
    update();
    TEST_ASSERT_FALSE(result.changed);
    TEST_ASSERT_EQUAL(0, result.changed_cells);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    memset(state, 0xa5, sizeof state);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(TSR_OK, tsr_change_rebase(&change, &frame));
    }
    TEST_ASSERT_EQUAL(6, state[CELLS]);
    update();
    TEST_ASSERT_FALSE(result.settling);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_names_the_bad_field);
    RUN_TEST(test_defaults_are_the_documented_ones);
    RUN_TEST(test_init_refuses_what_it_must);
    RUN_TEST(test_update_refuses_what_it_must);
    RUN_TEST(test_an_object_is_a_change_and_a_still_picture_is_none);
    RUN_TEST(test_fewer_cells_than_asked_are_no_change);
    RUN_TEST(test_the_equations_by_hand);
    RUN_TEST(test_cell_means_are_rounded_to_nearest);
    RUN_TEST(test_rebase_makes_the_frame_the_background);
    return UNITY_END();
}
