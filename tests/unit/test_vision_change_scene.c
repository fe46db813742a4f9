/*
 * Change detection on a larger picture: light, regions, watched rectangles; docs/math.md, chapter 2, by hand.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/change.h"
#include "unity.h"

#define SIDE 64
#define CELLS (SIDE / 4 * SIDE / 4)

static uint8_t pixels[SIDE * SIDE];
static uint8_t state[TSR_CHANGE_STATE_LEN(SIDE, SIDE, 4)];
static struct tsr_change change;
static struct tsr_change_result result;
static const struct tsr_gray_view frame = {pixels, SIDE, SIDE, SIDE};

void setUp(void) {}
void tearDown(void) {}

static void update(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&change, &frame, &result));
}

static void fill_cell(unsigned x, unsigned y, uint8_t gray)
{
    for (unsigned row = 0; row < 4; row++) {
        memset(pixels + (4 * y + row) * SIDE + 4 * x, gray, 4);
    }
}

/* A ramp of gray from left to right, even within a cell. */
static void draw_ramp(unsigned first, unsigned step, unsigned light_percent)
{
    for (unsigned y = 0; y < SIDE / 4; y++) {
        for (unsigned x = 0; x < SIDE / 4; x++) {
            unsigned gray = (first + x * step) * light_percent / 100u;
            fill_cell(x, y, (uint8_t)(gray < 255u ? gray : 255u));
        }
    }
}

static void settle(const struct tsr_change_config *watching)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, watching, state, sizeof state));
    for (int i = 0; i < 4; i++) {
        update();
    }
}

static const struct tsr_change_config config = {.width = SIDE, .height = SIDE};

static void test_light_on_the_whole_picture_is_no_change(void)
{
    draw_ramp(40, 6, 100);
    settle(&config);
    draw_ramp(40, 6, 125);
    update();
    TEST_ASSERT_UINT_WITHIN(3, 320, result.light_q8);
    TEST_ASSERT_EQUAL(0, result.changed_cells);
    TEST_ASSERT_EQUAL(50, state[CELLS]); /* M is there at once */
    update();
    TEST_ASSERT_EQUAL(256, result.light_q8);
    TEST_ASSERT_EQUAL(0, result.changed_cells);
}

static void test_light_that_clips_is_no_change(void)
{
    draw_ramp(100, 10, 100);
    settle(&config);
    for (int i = 0; i < 3; i++) {
        draw_ramp(100, 10, 140);
        update();
        TEST_ASSERT_EQUAL(0, result.changed_cells);
        draw_ramp(100, 10, 100);
        update();
        TEST_ASSERT_EQUAL(0, result.changed_cells);
    }
}

static void test_a_lamp_and_a_large_object_are_changes(void)
{
    draw_ramp(40, 6, 100);
    settle(&config);
    for (unsigned i = 0; i < 4; i++) {
        fill_cell(2 + i % 2, 2 + i / 2, 70); /* were 52 and 58 */
    }
    update();
    TEST_ASSERT_TRUE(result.changed);
    TEST_ASSERT_EQUAL(4, result.changed_cells);
    TEST_ASSERT_EQUAL(256, result.light_q8);
    draw_ramp(40, 6, 100);
    memset(pixels, 20, SIDE * SIDE * 3 / 8);
    update();
    TEST_ASSERT_EQUAL(256, result.light_q8);
    TEST_ASSERT_EQUAL(CELLS * 3 / 8, result.changed_cells);
}

static void test_light_is_bounded_and_needs_voters(void)
{
    draw_ramp(40, 0, 100);
    settle(&config);
    draw_ramp(10, 0, 100);
    update();
    TEST_ASSERT_EQUAL(128, result.light_q8);
    draw_ramp(200, 0, 100);
    settle(&config);
    draw_ramp(20, 0, 100);
    settle(&config);
    draw_ramp(80, 0, 100);
    update();
    TEST_ASSERT_EQUAL(512, result.light_q8);
    for (unsigned dark = 15; dark < 256; dark += 225) { /* 15 and 240 have no vote */
        draw_ramp(dark, 0, 100);
        settle(&config);
        draw_ramp(60, 0, 100);
        update();
        TEST_ASSERT_EQUAL(256, result.light_q8);
        TEST_ASSERT_TRUE(result.changed);
    }
}

static void expect_region(const uint8_t (*cells)[2], unsigned count, unsigned min_cells, bool changed)
{
    struct tsr_change_config watching = config;
    watching.min_cells = (uint16_t)min_cells;
    draw_ramp(100, 0, 100);
    settle(&watching);
    for (unsigned i = 0; i < count; i++) {
        fill_cell(cells[i][0], cells[i][1], 200);
    }
    update();
    TEST_ASSERT_EQUAL(count, result.changed_cells);
    TEST_ASSERT_EQUAL(changed, result.changed);
}

static void test_only_cells_that_touch_make_a_change(void)
{
    const uint8_t apart[][2] = {{0, 0}, {2, 0}, {4, 0}, {0, 2}, {15, 15}, {15, 0}, {0, 15}};
    expect_region(apart, 7, 2, false);
    expect_region(apart, 7, 1, true);
    const uint8_t wrapped[][2] = {{15, 0}, {0, 1}, {15, 2}, {0, 3}}; /* ends of rows do not touch */
    expect_region(wrapped, 4, 2, false);
    const uint8_t corners[][2] = {{0, 0}, {1, 1}, {2, 0}, {3, 1}, {2, 2}};
    expect_region(corners, 5, 5, true);
    expect_region(corners, 5, 6, false);
    const uint8_t fork[][2] = {{7, 7}, {7, 8}, {6, 9}, {5, 10}, {8, 9}, {9, 10}, {10, 10}, {4, 11}, {13, 3}};
    expect_region(fork, 9, 8, true); /* back from one arm into the other */
    expect_region(fork, 9, 9, false);
}

static void test_only_watched_cells_count(void)
{
    struct tsr_change_config watching = config;
    watching.watched_count = 2;
    watching.watched[0] = (struct tsr_rectangle){11, 11, 2, 2}; /* one pixel each of cells 2 and 3 */
    watching.watched[1] = (struct tsr_rectangle){60, 60, 4, 4};
    draw_ramp(100, 0, 100);
    settle(&watching);
    for (unsigned i = 0; i < 36; i++) {
        fill_cell(i % 6, i / 6, 200);
    }
    fill_cell(15, 15, 200);
    update();
    TEST_ASSERT_EQUAL(5, result.changed_cells);
    TEST_ASSERT_TRUE(result.changed);
    draw_ramp(100, 0, 100);
    settle(&watching);
    fill_cell(4, 2, 200);
    fill_cell(4, 3, 200);
    update();
    TEST_ASSERT_EQUAL(0, result.changed_cells);
    TEST_ASSERT_FALSE(result.changed);
}

static void test_a_cell_of_eight_and_of_two(void)
{
    for (unsigned side = 2; side <= 8; side *= 4) {
        struct tsr_change_config watching = config;
        static uint8_t room[TSR_CHANGE_STATE_LEN(SIDE, SIDE, 2)];
        watching.reduction = (uint8_t)side;
        memset(pixels, 0, sizeof pixels);
        for (unsigned y = 0; y < side; y++) {
            memset(pixels + y * SIDE, 255, side);
        }
        pixels[side] = 7; /* of the next cell: 7 / 4 rounds to 2, 7 / 64 to 0 */
        TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &watching, room, sizeof room));
        update();
        const uint8_t *mean = room + tsr_change_state_len(&watching) / 3;
        TEST_ASSERT_EQUAL(255, mean[0]);
        TEST_ASSERT_EQUAL(side == 2 ? 2 : 0, mean[1]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_light_on_the_whole_picture_is_no_change);
    RUN_TEST(test_light_that_clips_is_no_change);
    RUN_TEST(test_a_lamp_and_a_large_object_are_changes);
    RUN_TEST(test_light_is_bounded_and_needs_voters);
    RUN_TEST(test_only_cells_that_touch_make_a_change);
    RUN_TEST(test_only_watched_cells_count);
    RUN_TEST(test_a_cell_of_eight_and_of_two);
    return UNITY_END();
}
