/*
 * Restoring a decoded map: known results, every status, capacities, what stays untouched.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/map_restore.h"
#include "unity.h"

#define WIDTH 40
#define HEIGHT 12
#define COUNT (WIDTH * HEIGHT)
#define SCRATCH_COUNT TSR_MAP_RESTORE_SCRATCH_COUNT(WIDTH, HEIGHT)
#define NONE TSR_DISPARITY_INVALID

static const struct tsr_map_info info = {.width = WIDTH, .height = HEIGHT, .disparities = 32, .step_log2 = 3};
static uint16_t map[COUNT + 1];
static uint16_t before[COUNT + 1];
static uint16_t scratch[SCRATCH_COUNT + 1];

/* Every row the same: width / count values of each label. */
static void set_columns(const uint16_t *values, unsigned count)
{
    for (unsigned i = 0; i < COUNT; i++) {
        map[i] = values[i % WIDTH * count / WIDTH];
    }
    memcpy(before, map, sizeof map);
}

void setUp(void)
{
    static const uint16_t kStairs[] = {64, 72, 80, 88};
    set_columns(kStairs, 4);
    map[COUNT] = before[COUNT] = scratch[SCRATCH_COUNT] = 0x5a5a;
    memset(scratch, 0xa5, SCRATCH_COUNT * sizeof *scratch);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_HEX16(0x5a5a, map[COUNT]);
    TEST_ASSERT_EQUAL_HEX16(0x5a5a, scratch[SCRATCH_COUNT]);
}

static enum tsr_status restore(const struct tsr_map_info *of)
{
    return tsr_map_restore(of, map, COUNT, scratch, SCRATCH_COUNT);
}

static void check_within_steps(unsigned below, unsigned above)
{
    for (unsigned i = 0; i < COUNT; i++) {
        if (before[i] == NONE) {
            TEST_ASSERT_EQUAL_HEX16(NONE, map[i]);
        } else {
            TEST_ASSERT_TRUE(map[i] + below >= before[i] && map[i] <= before[i] + above);
        }
    }
}

static void test_stairs_become_a_slope(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, restore(&info));
    check_within_steps(4, 3);
    for (unsigned x = 1; x < WIDTH; x++) {
        const int rise = map[x] - map[x - 1];
        TEST_ASSERT_TRUE(rise >= 0 && rise <= 3); /* 8 before */
    }
    TEST_ASSERT_EQUAL_UINT16(83, map[29]); /* both sides of a stair meet at the border between their steps */
    TEST_ASSERT_EQUAL_UINT16(84, map[30]);
    for (unsigned y = 1; y < HEIGHT; y++) {
        TEST_ASSERT_EQUAL_UINT16_ARRAY(map, map + (size_t)y * WIDTH, WIDTH);
    }
}

static void test_what_is_flat_stays(void)
{
    for (unsigned label = 0; label < 64; label++) {
        const uint16_t value = (uint16_t)(8 * label);
        set_columns(&value, 1);
        TEST_ASSERT_EQUAL(TSR_OK, restore(&info));
        TEST_ASSERT_EQUAL_UINT16_ARRAY(before, map, COUNT);
    }
}

static void test_edges_and_invalid_pixels_stay(void)
{
    static const uint16_t kEdge[] = {64, 80, NONE, 0, 504}; /* two steps apart and more */
    set_columns(kEdge, 5);
    TEST_ASSERT_EQUAL(TSR_OK, restore(&info));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(before, map, COUNT);
}

static void test_sixteenths_stay(void)
{
    struct tsr_map_info fine = info;
    fine.step_log2 = 0;
    for (unsigned i = 0; i < COUNT; i++) {
        map[i] = before[i] = (uint16_t)(i % 7 == 0 ? NONE : i * 37 % 512);
    }
    TEST_ASSERT_EQUAL(TSR_OK, restore(&fine));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(before, map, COUNT);
}

/* What near allows beside is not taken, and no value leaves 0 .. 16 * disparities - 1. */
static void test_near_changes_nothing(void)
{
    static uint16_t alone[COUNT];
    static const uint16_t kEnds[] = {0, 8, 0, 504, 496, 504};
    struct tsr_map_info near = info;
    near.near = 1;
    set_columns(kEnds, 6);
    TEST_ASSERT_EQUAL(TSR_OK, restore(&info));
    check_within_steps(4, 3);
    memcpy(alone, map, sizeof alone);
    memcpy(map, before, sizeof map);
    TEST_ASSERT_EQUAL(TSR_OK, restore(&near));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(alone, map, COUNT);
}

static void test_one_pixel(void)
{
    const struct tsr_map_info one = {.width = 1, .height = 1, .disparities = 128, .step_log2 = 4};
    uint16_t pixel = 127 * 16;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_restore(&one, &pixel, 1, scratch, TSR_MAP_RESTORE_SCRATCH_COUNT(1, 1)));
    TEST_ASSERT_EQUAL_UINT16(127 * 16, pixel);
    pixel = NONE;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_restore(&one, &pixel, 1, scratch, TSR_MAP_RESTORE_SCRATCH_COUNT(1, 1)));
    TEST_ASSERT_EQUAL_HEX16(NONE, pixel);
}

static void check_refused(enum tsr_status expected, enum tsr_status status)
{
    TEST_ASSERT_EQUAL(expected, status);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(before, map, COUNT);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xa5a5, scratch, SCRATCH_COUNT);
}

static void test_bad_arguments(void)
{
    check_refused(TSR_ERR_ARG, restore(NULL));
    check_refused(TSR_ERR_ARG, tsr_map_restore(&info, NULL, COUNT, scratch, SCRATCH_COUNT));
    check_refused(TSR_ERR_ARG, tsr_map_restore(&info, map, COUNT, NULL, SCRATCH_COUNT));
    check_refused(TSR_ERR_NOBUF, tsr_map_restore(&info, map, COUNT - 1, scratch, SCRATCH_COUNT));
    check_refused(TSR_ERR_NOBUF, tsr_map_restore(&info, map, COUNT, scratch, SCRATCH_COUNT - 1));
}

static void test_bad_info(void)
{
    struct tsr_map_info bad[9];
    for (unsigned i = 0; i < 9; i++) {
        bad[i] = info;
    }
    bad[0].width = 0;
    bad[1].width = TSR_IMAGE_WIDTH_MAX + 1;
    bad[2].height = 0;
    bad[3].height = TSR_IMAGE_HEIGHT_MAX + 1;
    bad[4].disparities = 0;
    bad[5].disparities = TSR_DISPARITY_COUNT_MAX + 1;
    bad[6].step_log2 = TSR_MAP_STEP_LOG2_MAX + 1;
    bad[7].near = TSR_MAP_NEAR_MAX + 1;
    bad[8].disparities = 5; /* 88 sixteenths are not below it */
    for (unsigned i = 0; i < 9; i++) {
        check_refused(TSR_ERR_ARG, restore(&bad[i]));
    }
}

static void test_values_that_no_decoder_gives(void)
{
    static const uint16_t kBad[] = {1, 4, 512, 0x7ff8, 0xfff8, 0xfffe};
    for (unsigned i = 0; i < sizeof kBad / sizeof *kBad; i++) {
        map[COUNT - 1] = before[COUNT - 1] = kBad[i];
        check_refused(TSR_ERR_ARG, restore(&info));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_stairs_become_a_slope);
    RUN_TEST(test_what_is_flat_stays);
    RUN_TEST(test_edges_and_invalid_pixels_stay);
    RUN_TEST(test_sixteenths_stay);
    RUN_TEST(test_near_changes_nothing);
    RUN_TEST(test_one_pixel);
    RUN_TEST(test_bad_arguments);
    RUN_TEST(test_bad_info);
    RUN_TEST(test_values_that_no_decoder_gives);
    return UNITY_END();
}
