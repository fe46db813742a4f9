/*
 * The prefilter alone: its equation, every status, capacities, rows in any
 * portions; and what the matcher makes of a right view that is prefiltered.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/match.h"
#include "tsr/vision/prefilter.h"
#include "unity.h"

#define WIDTH 37
#define HEIGHT 11
#define STRIDE 40
#define SCRATCH_LEN TSR_PREFILTER_SCRATCH_LEN(WIDTH)

static uint8_t picture[HEIGHT * STRIDE];
static uint8_t filtered[HEIGHT * STRIDE];
static _Alignas(4) uint8_t scratch[SCRATCH_LEN];
static struct tsr_prefilter filter;

void setUp(void)
{
    uint32_t state = 1;
    for (unsigned i = 0; i < sizeof picture; i++) {
        state = state * 1664525u + 1013904223u;
        picture[i] = (uint8_t)(i % STRIDE < 12 ? state >> 24 : i % STRIDE * 3u + (state >> 29));
    }
    memcpy(filtered, picture, sizeof filtered);
}
void tearDown(void) {}

static struct tsr_gray frame(void)
{
    return (struct tsr_gray){filtered, WIDTH, HEIGHT, STRIDE};
}

static int pixel(int x, int y)
{
    x = x < 0 ? 0 : x >= WIDTH ? WIDTH - 1 : x;
    y = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    return picture[y * STRIDE + x];
}

/* docs/math.md, eq. (10), with a division that rounds down. */
static int derivative(int x, int y, int cap)
{
    int sum = 2;
    for (int row = -1; row <= 1; row++) {
        sum += (row == 0 ? 2 : 1) * (pixel(x + 1, y + row) - pixel(x - 1, y + row));
    }
    const int value = (sum - (sum % 4 + 4) % 4) / 4;
    return (value < -cap ? -cap : value > cap ? cap : value) + cap;
}

static void test_equation_in_any_portions(void)
{
    for (uint8_t cap = 1; cap <= TSR_PREFILTER_CAP_MAX; cap++) {
        memcpy(filtered, picture, sizeof filtered);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_prefilter_start(&filter, frame(), cap, scratch, sizeof scratch));
        unsigned calls = 0;
        while (tsr_prefilter_run(&filter, cap) == TSR_AGAIN) {
            calls++;
        }
        TEST_ASSERT_EQUAL((HEIGHT - 1) / cap, calls);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_prefilter_run(&filter, 1));
        for (int y = 0; y < HEIGHT; y++) {
            for (int x = 0; x < WIDTH; x++) {
                TEST_ASSERT_EQUAL(derivative(x, y, cap), filtered[y * STRIDE + x]);
            }
            for (int x = WIDTH; x < STRIDE; x++) {
                TEST_ASSERT_EQUAL(picture[y * STRIDE + x], filtered[y * STRIDE + x]);
            }
        }
    }
}

static enum tsr_status start(struct tsr_gray view, uint8_t cap, size_t scratch_cap)
{
    return tsr_prefilter_start(&filter, view, cap, scratch, scratch_cap);
}

static void test_refuses(void)
{
    struct tsr_gray bad = frame();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_prefilter_start(NULL, frame(), 7, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_prefilter_start(&filter, frame(), 7, NULL, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_prefilter_start(&filter, frame(), 7, scratch + 1, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(frame(), 0, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(frame(), TSR_PREFILTER_CAP_MAX + 1, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(frame(), 7, SCRATCH_LEN - 1));
    bad.pixels = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(bad, 7, SCRATCH_LEN));
    bad = frame();
    bad.width = 0;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(bad, 7, SCRATCH_LEN));
    bad.width = STRIDE + 1;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(bad, 7, SCRATCH_LEN));
    bad = frame();
    bad.height = TSR_IMAGE_HEIGHT_MAX + 1;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(bad, 7, SCRATCH_LEN));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(picture, filtered, sizeof picture);
    TEST_ASSERT_EQUAL(TSR_OK, start(frame(), 7, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_prefilter_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_prefilter_run(&filter, 0));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(picture, filtered, sizeof picture);
}

static void test_one_pixel(void)
{
    struct tsr_gray view = {filtered, 1, 1, 1};
    TEST_ASSERT_EQUAL(TSR_OK, start(view, 7, TSR_PREFILTER_SCRATCH_LEN(1)));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_prefilter_run(&filter, 1));
    TEST_ASSERT_EQUAL(7, filtered[0]);
}

static void test_caps_of_the_matcher(void)
{
    struct tsr_match_config config = {.width = WIDTH, .height = HEIGHT, .disparities = 16, .window = 9};
    TEST_ASSERT_EQUAL(7, tsr_match_prefilter_cap(&config));
    config.prefilter_cap = 3;
    TEST_ASSERT_EQUAL(3, tsr_match_prefilter_cap(&config));
    config.prefilter_cap = 0;
    config.mode = TSR_MATCH_SAD8;
    TEST_ASSERT_EQUAL(1, tsr_match_prefilter_cap(&config));
    config.mode = TSR_MATCH_CENSUS;
    TEST_ASSERT_EQUAL(0, tsr_match_prefilter_cap(&config));
    config.mode = TSR_MATCH_SAD;
    config.width = 3;
    TEST_ASSERT_EQUAL(0, tsr_match_prefilter_cap(&config));
    TEST_ASSERT_EQUAL(0, tsr_match_prefilter_cap(NULL));
}

static void test_only_prefiltered_modes_take_it(void)
{
    const char *field = NULL;
    for (uint8_t mode = TSR_MATCH_SAD; mode <= TSR_MATCH_SSD; mode++) {
        struct tsr_match_config config = {
            .width = WIDTH, .height = HEIGHT, .disparities = 16, .mode = mode, .right_is_prefiltered = true};
        const bool takes = mode == TSR_MATCH_SAD || mode == TSR_MATCH_SAD8;
        TEST_ASSERT_EQUAL(takes ? TSR_OK : TSR_ERR_ARG, tsr_match_check(&config, &field));
        config.right_is_prefiltered = false;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_match_check(&config, NULL));
    }
    TEST_ASSERT_EQUAL_STRING("right_is_prefiltered", field);
}

static void match_views(const uint8_t *right_pixels, uint16_t *map)
{
    static uint8_t left[HEIGHT * STRIDE], right[HEIGHT * STRIDE];
    static _Alignas(TSR_MATCH_SCRATCH_ALIGN) uint8_t match_scratch[TSR_MATCH_SCRATCH_LEN(WIDTH, 16)];
    struct tsr_match match;
    const struct tsr_match_config config = {
        .width = WIDTH, .height = HEIGHT, .disparities = 16, .right_is_prefiltered = true};
    memcpy(left, picture, sizeof left);
    memcpy(right, right_pixels, sizeof right);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_start(&match, &config, (struct tsr_gray){left, WIDTH, HEIGHT, STRIDE},
                                              (struct tsr_gray){right, WIDTH, HEIGHT, STRIDE}, map, WIDTH * HEIGHT,
                                              match_scratch, sizeof match_scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, UINT16_MAX));
}

/* A view from the air may hold anything. */
static void test_values_above_the_cap_count_as_it(void)
{
    static uint8_t wild[HEIGHT * STRIDE], tame[HEIGHT * STRIDE];
    static uint16_t of_wild[WIDTH * HEIGHT], of_tame[WIDTH * HEIGHT];
    for (unsigned i = 0; i < sizeof wild; i++) {
        wild[i] = picture[i] % 31u;
        tame[i] = wild[i] < 14 ? wild[i] : 14;
    }
    match_views(wild, of_wild);
    match_views(tame, of_tame);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(of_tame, of_wild, WIDTH * HEIGHT);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_equation_in_any_portions);
    RUN_TEST(test_refuses);
    RUN_TEST(test_one_pixel);
    RUN_TEST(test_caps_of_the_matcher);
    RUN_TEST(test_only_prefiltered_modes_take_it);
    RUN_TEST(test_values_above_the_cap_count_as_it);
    return UNITY_END();
}
