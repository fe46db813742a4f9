/*
 * Change detection: contract, settling, rebase, background; docs/math.md, chapter 2, by hand.
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
static uint8_t *const means = state + CELLS;
static uint8_t *const deviations = state + 2 * CELLS;

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
    EXPECT_BAD(deviation_max, 4);
    EXPECT_BAD(deviation_max, 128);
    EXPECT_BAD(min_cells, CELLS + 1);
    EXPECT_BAD(watched_count, TSR_CHANGE_WATCHED_MAX + 1);
}

static void expect_rectangle(uint16_t x, uint16_t y, uint16_t width, uint16_t height, bool good)
{
    struct tsr_change_config watching = config;
    watching.watched_count = 2;
    watching.watched[0] = (struct tsr_rectangle){0, 0, WIDTH, HEIGHT};
    watching.watched[1] = (struct tsr_rectangle){x, y, width, height};
    if (good) {
        TEST_ASSERT_EQUAL(TSR_OK, tsr_change_check(&watching, NULL));
    } else {
        expect_bad(watching, "watched");
    }
}

static void test_check_refuses_rectangles_outside(void)
{
    expect_rectangle(WIDTH - 1, HEIGHT - 1, 1, 1, true);
    expect_rectangle(0, 0, 0, 1, false);
    expect_rectangle(0, 0, 1, 0, false);
    expect_rectangle(1, 0, WIDTH, 1, false);
    expect_rectangle(0, 1, 1, HEIGHT, false);
    expect_rectangle(UINT16_MAX, 0, UINT16_MAX, 1, false);
    expect_rectangle(0, UINT16_MAX, 1, UINT16_MAX, false);
}

static void test_defaults_are_the_documented_ones(void)
{
    TEST_ASSERT_EQUAL(STATE_LEN, tsr_change_state_len(&config));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    TEST_ASSERT_EQUAL(4, change.config.reduction);
    TEST_ASSERT_EQUAL(4, change.config.amplification);
    TEST_ASSERT_EQUAL(5, change.config.deviation_min);
    TEST_ASSERT_EQUAL(64, change.config.deviation_max);
    TEST_ASSERT_EQUAL(2, change.config.min_cells);
    TEST_ASSERT_EQUAL(4, change.config.settle_frames);
    const struct tsr_change_config large = {.width = 160, .height = 120};
    static uint8_t room[TSR_CHANGE_STATE_LEN(160, 120, 4)];
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &large, room, sizeof room));
    TEST_ASSERT_EQUAL(3, change.config.min_cells);
    const struct tsr_change_config part = {
        .width = 160, .height = 120, .reduction = 8, .watched_count = 1, .watched = {{0, 0, 160, 100}}};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &part, room, sizeof room));
    TEST_ASSERT_EQUAL(2, change.config.min_cells);
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
    settle(); /* updates 0 to 2 have a background */
    memset(pixels, 110, sizeof pixels);
    for (int i = 0; i < 3; i++) {
        update();
        /* E = M = 100, M' = 101, D = 9, V = 5 + i + sgn(4 * 9 - 5 - i): M waits, seven of eight times */
        TEST_ASSERT_EQUAL(100, means[0]);
        TEST_ASSERT_EQUAL(6 + i, deviations[0] & 127);
        TEST_ASSERT_EQUAL(CELLS, result.changed_cells);
        TEST_ASSERT_TRUE(result.changed);
        TEST_ASSERT_EQUAL(256, result.light_q8); /* 8 cells: 2 voters, too few */
    }
    update(); /* V = 9: D is not above, so M moves */
    TEST_ASSERT_EQUAL(0, result.changed_cells);
    TEST_ASSERT_EQUAL(101, means[0]);
    TEST_ASSERT_EQUAL(9, deviations[0]);
}

static void test_a_changed_cell_is_followed_every_eighth_time(void)
{
    settle();
    memset(pixels, 200, sizeof pixels);
    for (int i = 3; i <= 16; i++) {
        update();
        TEST_ASSERT_TRUE(result.changed);
        TEST_ASSERT_EQUAL(i < 8 ? 100 : i < 16 ? 101 : 102, means[0]);
    }
}

static void test_deviation_rises_fast_while_settling_and_stays_in_range(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    update();
    memset(pixels, 255, sizeof pixels);
    for (int i = 0; i < 3; i++) {
        update();
        TEST_ASSERT_EQUAL(5 + 4 * (i + 1), deviations[0] & 127);
    }
    for (int i = 0; i < 100; i++) {
        update();
    }
    TEST_ASSERT_EQUAL(64, deviations[0] & 127);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_rebase(&change, &frame));
    for (int i = 0; i < 100; i++) {
        update();
    }
    TEST_ASSERT_EQUAL(5, deviations[0]);
}

static void fill_cell(unsigned x, unsigned y, uint8_t gray)
{
    for (unsigned row = 0; row < 4; row++) {
        memset(pixels + (4 * y + row) * WIDTH + 4 * x, gray, 4);
    }
}

static void test_an_edge_must_change_by_more(void)
{
    for (unsigned i = 0; i < HEIGHT / 4; i++) { /* two rows of cells: 100, 100, 100, 228 */
        fill_cell(3, i, 228);
    }
    settle();
    fill_cell(0, 0, 107); /* D = 6, V = 6: not above */
    fill_cell(2, 0, 120); /* D = 19, V = 6, C = 108: 19 is not above 6 + 13 */
    update();
    TEST_ASSERT_EQUAL(0, result.changed_cells);
    fill_cell(0, 0, 109); /* D = 8, V = 7, C = 9: 8 is not above 7 + 1 */
    fill_cell(2, 0, 122); /* M = 100 still: D = 21, V = 7, C = 106: 21 is above 7 + 13 */
    update();
    TEST_ASSERT_EQUAL(1, result.changed_cells);
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
    TEST_ASSERT_EQUAL(1, means[0]);
    TEST_ASSERT_EQUAL(0, means[1]);
}

static void test_rebase_makes_the_frame_the_background(void)
{
    settle();
    memset(pixels, 200, sizeof pixels);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_rebase(&change, &frame));
    TEST_ASSERT_EQUAL(200, means[0]);
    TEST_ASSERT_EQUAL(5, deviations[0]);
    update();
    TEST_ASSERT_FALSE(result.changed);
    TEST_ASSERT_EQUAL(0, result.changed_cells);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, STATE_LEN));
    memset(state, 0xa5, sizeof state);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(TSR_OK, tsr_change_rebase(&change, &frame));
    }
    TEST_ASSERT_EQUAL(5, deviations[0]);
    update();
    TEST_ASSERT_FALSE(result.settling);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_names_the_bad_field);
    RUN_TEST(test_check_refuses_rectangles_outside);
    RUN_TEST(test_defaults_are_the_documented_ones);
    RUN_TEST(test_init_refuses_what_it_must);
    RUN_TEST(test_update_refuses_what_it_must);
    RUN_TEST(test_an_object_is_a_change_and_a_still_picture_is_none);
    RUN_TEST(test_fewer_cells_than_asked_are_no_change);
    RUN_TEST(test_the_equations_by_hand);
    RUN_TEST(test_a_changed_cell_is_followed_every_eighth_time);
    RUN_TEST(test_deviation_rises_fast_while_settling_and_stays_in_range);
    RUN_TEST(test_an_edge_must_change_by_more);
    RUN_TEST(test_cell_means_are_rounded_to_nearest);
    RUN_TEST(test_rebase_makes_the_frame_the_background);
    return UNITY_END();
}
