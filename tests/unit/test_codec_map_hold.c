/*
 * Unit tests: what tsr/codec/map_hold.h promises.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/map_hold.h"
#include "unity.h"

#define WIDTH 24
#define HEIGHT 20
#define STRIDE (WIDTH + 2)
#define OUTSIDE 0xa5a5

static const struct tsr_map_info info = {.width = WIDTH, .height = HEIGHT, .disparities = 32, .step_log2 = 3};
static uint16_t earlier[HEIGHT * WIDTH], map[HEIGHT * STRIDE], scratch[WIDTH + 1];
static const struct tsr_map_reference reference = {earlier, WIDTH, 7};

void setUp(void)
{
    for (unsigned i = 0; i < HEIGHT * WIDTH; i++) {
        earlier[i] = (uint16_t)(i % 11 == 3 ? TSR_DISPARITY_INVALID : 8 * (i % 60));
    }
    for (unsigned i = 0; i < HEIGHT * STRIDE; i++) {
        map[i] = OUTSIDE;
    }
    for (unsigned y = 0; y < HEIGHT; y++) {
        memcpy(map + y * STRIDE, earlier + y * WIDTH, WIDTH * sizeof map[0]);
    }
    scratch[WIDTH] = OUTSIDE;
}

void tearDown(void) {}

/* Another value than the reference's, one step away or with no match. */
static void change(unsigned x, unsigned y, unsigned width, unsigned height)
{
    for (unsigned v = y; v < y + height; v++) {
        for (unsigned u = x; u < x + width; u++) {
            const uint16_t was = earlier[v * WIDTH + u];
            map[v * STRIDE + u] = (uint16_t)(was == TSR_DISPARITY_INVALID ? 16
                                             : (u + v) % 5 == 0           ? TSR_DISPARITY_INVALID
                                                                          : was ^ 8u);
        }
    }
}

static uint32_t hold(void)
{
    uint32_t changed = 77;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_hold(&info, &reference, map, STRIDE, scratch, WIDTH, &changed));
    TEST_ASSERT_EQUAL_HEX16(OUTSIDE, scratch[WIDTH]);
    uint32_t differs = 0;
    for (unsigned y = 0; y < HEIGHT; y++) {
        for (unsigned x = 0; x < STRIDE; x++) {
            if (x >= WIDTH) {
                TEST_ASSERT_EQUAL_HEX16(OUTSIDE, map[y * STRIDE + x]);
            } else {
                differs += map[y * STRIDE + x] != earlier[y * WIDTH + x];
            }
        }
    }
    TEST_ASSERT_EQUAL(differs, changed);
    return changed;
}

static void test_the_same_map_stays(void)
{
    TEST_ASSERT_EQUAL(0, hold());
}

static void test_lines_are_held(void)
{
    change(0, 4, WIDTH, 3);
    TEST_ASSERT_EQUAL(0, hold());
    change(9, 0, 3, HEIGHT);
    TEST_ASSERT_EQUAL(0, hold());
}

static void test_strips_and_blocks_come_through(void)
{
    change(0, 4, WIDTH, 4);
    TEST_ASSERT_EQUAL(4 * WIDTH, hold());
    setUp();
    change(8, 7, 5, 5);
    TEST_ASSERT_EQUAL(25, hold());
}

/* Of 25 pixels one less is held, wherever it lies. */
static void test_one_pixel_less(void)
{
    for (unsigned i = 0; i < 25; i++) {
        setUp();
        change(8, 7, 5, 5);
        map[(7 + i / 5) * STRIDE + 8 + i % 5] = earlier[(7 + i / 5) * WIDTH + 8 + i % 5];
        TEST_ASSERT_EQUAL(0, hold());
    }
}

static void test_blocks_in_corners_come_through(void)
{
    const unsigned xs[2] = {0, WIDTH - 5}, ys[2] = {0, HEIGHT - 5};
    for (unsigned i = 0; i < 4; i++) {
        setUp();
        change(xs[i % 2], ys[i / 2], 5, 5);
        TEST_ASSERT_EQUAL(25, hold());
    }
}

/* A pixel alone keeps its value where a window holds it and a block. */
static void test_reach(void)
{
    change(8, 7, 5, 5);
    change(14, 9, 1, 1); /* a window a column right of the middle still holds the whole block */
    TEST_ASSERT_EQUAL(26, hold());
    setUp();
    change(8, 7, 5, 5);
    change(15, 9, 1, 1);
    TEST_ASSERT_EQUAL(25, hold());
}

static void test_nobody_asks_how_many(void)
{
    change(0, 0, WIDTH, HEIGHT);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_hold(&info, &reference, map, STRIDE, scratch, WIDTH, NULL));
    TEST_ASSERT_NOT_EQUAL(earlier[0], map[0]);
}

static void check_refused(enum tsr_status expected, struct tsr_map_info shape, struct tsr_map_reference against,
                          size_t stride, size_t scratch_cap)
{
    uint32_t changed = 77;
    TEST_ASSERT_EQUAL(expected, tsr_map_hold(&shape, &against, map, stride, scratch, scratch_cap, &changed));
    TEST_ASSERT_EQUAL(77, changed);
}

static void test_bad_arguments(void)
{
    const struct tsr_map_reference none = {NULL, WIDTH, 7}, narrow = {earlier, WIDTH - 1, 7};
    const struct tsr_map_info no_width = {.height = 1}, no_height = {.width = 1}, wide = {.width = 641, .height = 1},
                              high = {.width = 1, .height = 481};
    check_refused(TSR_ERR_ARG, info, none, STRIDE, WIDTH);
    check_refused(TSR_ERR_ARG, no_width, reference, STRIDE, WIDTH);
    check_refused(TSR_ERR_ARG, no_height, reference, STRIDE, WIDTH);
    check_refused(TSR_ERR_ARG, wide, reference, STRIDE, WIDTH);
    check_refused(TSR_ERR_ARG, high, reference, STRIDE, WIDTH);
    check_refused(TSR_ERR_SIZE, info, narrow, STRIDE, WIDTH);
    check_refused(TSR_ERR_SIZE, info, reference, WIDTH - 1, WIDTH);
    check_refused(TSR_ERR_NOBUF, info, reference, STRIDE, WIDTH - 1);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_hold(NULL, &reference, map, STRIDE, scratch, WIDTH, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_hold(&info, NULL, map, STRIDE, scratch, WIDTH, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_hold(&info, &reference, NULL, STRIDE, scratch, WIDTH, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_hold(&info, &reference, map, STRIDE, NULL, WIDTH, NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_same_map_stays);
    RUN_TEST(test_lines_are_held);
    RUN_TEST(test_strips_and_blocks_come_through);
    RUN_TEST(test_one_pixel_less);
    RUN_TEST(test_blocks_in_corners_come_through);
    RUN_TEST(test_reach);
    RUN_TEST(test_nobody_asks_how_many);
    RUN_TEST(test_bad_arguments);
    return UNITY_END();
}
