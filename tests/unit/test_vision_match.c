/*
 * The matcher's contract: configurations, buffers, overlays, chosen maps.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/match.h"
#include "unity.h"

#define WIDTH 48
#define HEIGHT 20
#define PIXELS (WIDTH * HEIGHT)
#define SCRATCH_LEN TSR_MATCH_SCRATCH_LEN(WIDTH, 16)
#define PAIR_LEN TSR_MATCH_PAIR_LEN(WIDTH, HEIGHT, 5)

static const struct tsr_match_config config = {.width = WIDTH, .height = HEIGHT, .disparities = 16, .window = 5};
static uint8_t left_pixels[PIXELS];
static uint8_t right_pixels[PIXELS];
static uint16_t map[PIXELS];
static _Alignas(4) uint8_t scratch[SCRATCH_LEN + 4];
static _Alignas(4) uint8_t pair[PAIR_LEN];
static struct tsr_gray left;
static struct tsr_gray right;
static struct tsr_match match;

void setUp(void)
{
    left = (struct tsr_gray){left_pixels, WIDTH, HEIGHT, WIDTH};
    right = (struct tsr_gray){right_pixels, WIDTH, HEIGHT, WIDTH};
    memset(&match, 0xa5, sizeof match);
    memset(map, 0xa5, sizeof map);
    memset(scratch, 0xa5, sizeof scratch);
}
void tearDown(void) {}

static uint8_t texture(int x, int y)
{
    uint32_t value = (uint32_t)(x + 1000) * 2654435761u ^ (uint32_t)y * 2246822519u;
    value ^= value >> 15;
    value *= 2246822519u;
    return (uint8_t)(value >> 24);
}

/* The right view sees at x what the left sees at x + shift. */
static void draw_shifted(int shift)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            left_pixels[y * WIDTH + x] = texture(x, y);
            right_pixels[y * WIDTH + x] = texture(x + shift, y);
        }
    }
}

static enum tsr_status start(const struct tsr_match_config *chosen)
{
    return tsr_match_start(&match, chosen, left, right, map, PIXELS, scratch, SCRATCH_LEN);
}

static void expect_untouched(void)
{
    for (size_t i = 0; i < sizeof match; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xa5, ((const uint8_t *)&match)[i]);
    }
    TEST_ASSERT_EQUAL_HEX16(0xa5a5, map[0]);
    TEST_ASSERT_EQUAL_HEX8(0xa5, scratch[0]);
}

static void expect_bad(struct tsr_match_config bad, const char *name)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_check(&bad, &field));
    TEST_ASSERT_EQUAL_STRING(name, field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_check(&bad, NULL));
    TEST_ASSERT_EQUAL(0, tsr_match_scratch_len(&bad));
    TEST_ASSERT_EQUAL(0, tsr_match_pair_len(&bad));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(&bad));
    expect_untouched();
}

#define EXPECT_BAD(member, value)                                                                                      \
    do {                                                                                                               \
        struct tsr_match_config bad = config;                                                                          \
        bad.member = (value);                                                                                          \
        expect_bad(bad, #member);                                                                                      \
    } while (0)

static void test_check_names_the_bad_field(void)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
    EXPECT_BAD(width, 15);
    EXPECT_BAD(width, TSR_IMAGE_WIDTH_MAX + 1);
    EXPECT_BAD(height, 4);
    EXPECT_BAD(height, TSR_IMAGE_HEIGHT_MAX + 1);
    EXPECT_BAD(disparities, 8);
    EXPECT_BAD(disparities, 20);
    EXPECT_BAD(disparities, 136);
    EXPECT_BAD(disparities, 56); /* wider than the frame */
    EXPECT_BAD(window, 3);
    EXPECT_BAD(window, 6);
    EXPECT_BAD(window, 17);
    EXPECT_BAD(mode, TSR_MATCH_SSD + 1);
    EXPECT_BAD(prefilter_cap, 8);
    EXPECT_BAD(uniqueness_percent, 101);
    EXPECT_BAD(texture_min, 128);
    EXPECT_BAD(lr_tolerance_px, 128);
    EXPECT_BAD(search_start_px, WIDTH - 16 + 1);
    EXPECT_BAD(search_start_px, -(WIDTH - 16) - 1);
    const struct tsr_match_config low = {.width = 32, .height = 8};
    expect_bad(low, "window");
    struct tsr_match_config narrow = config;
    narrow.mode = TSR_MATCH_SAD8;
    narrow.prefilter_cap = 6; /* 5 * 5 * 2 * 6 = 300 */
    expect_bad(narrow, "prefilter_cap");
    narrow.prefilter_cap = 0;
    narrow.window = 13; /* 13 * 13 * 2 = 338 */
    expect_bad(narrow, "window");
}

static void test_check_accepts_the_ends_of_every_range(void)
{
    const struct tsr_match_config least = {.width = 16,
                                           .height = 5,
                                           .disparities = 16,
                                           .window = 5,
                                           .prefilter_cap = 1,
                                           .uniqueness_percent = 1,
                                           .texture_min = 1,
                                           .lr_tolerance_px = 1};
    const struct tsr_match_config most = {.width = 640,
                                          .height = 480,
                                          .disparities = 128,
                                          .window = 15,
                                          .prefilter_cap = 4,
                                          .uniqueness_percent = 100,
                                          .texture_min = 127,
                                          .lr_tolerance_px = 127,
                                          .search_start_px = -512};
    const struct tsr_match_config off = {.width = 160,
                                         .height = 120,
                                         .uniqueness_percent = TSR_MATCH_TEST_OFF,
                                         .texture_min = TSR_MATCH_TEST_OFF,
                                         .lr_tolerance_px = TSR_MATCH_TEST_OFF};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_check(&least, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_check(&most, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_check(&off, NULL));
}

static void test_defaults_are_the_documented_ones(void)
{
    const struct tsr_match_config zero = {.width = WIDTH, .height = HEIGHT};
    static _Alignas(4) uint8_t room[TSR_MATCH_SCRATCH_LEN(WIDTH, 32)];
    TEST_ASSERT_EQUAL(sizeof room, tsr_match_scratch_len(&zero));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_start(&match, &zero, left, right, map, PIXELS, room, sizeof room));
    TEST_ASSERT_EQUAL(32, match.config.disparities);
    TEST_ASSERT_EQUAL(9, match.config.window);
    TEST_ASSERT_EQUAL(7, match.config.prefilter_cap);
    TEST_ASSERT_EQUAL(15, match.config.uniqueness_percent);
    TEST_ASSERT_EQUAL(1, match.config.texture_min);
    TEST_ASSERT_EQUAL(1, match.config.lr_tolerance_px);
    TEST_ASSERT_EQUAL(0, match.config.search_start_px);
}

static void test_start_refuses_null_pointers_and_misalignment(void)
{
    struct tsr_gray none = {NULL, WIDTH, HEIGHT, WIDTH};
    uint16_t *odd = (uint16_t *)(void *)((uint8_t *)map + 1);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_start(NULL, &config, left, right, map, PIXELS, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_start(&match, &config, none, right, map, PIXELS, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_start(&match, &config, left, none, map, PIXELS, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_start(&match, &config, left, right, NULL, PIXELS, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_start(&match, &config, left, right, map, PIXELS, NULL, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_match_start(&match, &config, left, right, odd, PIXELS - 1, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_match_start(&match, &config, left, right, map, PIXELS, scratch + 2, SCRATCH_LEN));
    expect_untouched();
}

static void test_start_refuses_wrong_shapes(void)
{
    struct tsr_gray *frames[] = {&left, &right};
    for (int i = 0; i < 2; i++) {
        struct tsr_gray good = *frames[i];
        frames[i]->width = WIDTH - 1;
        TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(&config));
        *frames[i] = good;
        frames[i]->height = HEIGHT - 1;
        TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(&config));
        *frames[i] = good;
        frames[i]->stride = WIDTH - 1;
        TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(&config));
        *frames[i] = good;
    }
    expect_untouched();
}

static void test_start_refuses_small_buffers(void)
{
    TEST_ASSERT_EQUAL(SCRATCH_LEN, tsr_match_scratch_len(&config));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF,
                      tsr_match_start(&match, &config, left, right, map, PIXELS - 1, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF,
                      tsr_match_start(&match, &config, left, right, map, PIXELS, scratch, SCRATCH_LEN - 1));
    expect_untouched();
    TEST_ASSERT_EQUAL(TSR_OK, start(&config));
    TEST_ASSERT_EQUAL_HEX16(0xa5a5, map[0]);
    TEST_ASSERT_EQUAL_HEX8(0xa5, scratch[0]);
}

static void test_start_accepts_the_pair_layout_and_no_tighter_one(void)
{
    TEST_ASSERT_EQUAL(PAIR_LEN, tsr_match_pair_len(&config));
    struct tsr_gray pair_left = tsr_match_pair_left(pair, &config);
    struct tsr_gray pair_right = tsr_match_pair_right(pair, &config);
    uint16_t *pair_map = tsr_match_pair_map(pair);
    TEST_ASSERT_EQUAL_PTR(pair + 2 * WIDTH * 3, pair_left.pixels);
    TEST_ASSERT_EQUAL_PTR(pair_left.pixels + WIDTH, pair_right.pixels);
    TEST_ASSERT_EQUAL(2 * WIDTH, pair_left.stride);
    TEST_ASSERT_EQUAL_PTR(pair + PAIR_LEN, pair_right.pixels + 2 * WIDTH * (HEIGHT - 1) + WIDTH);
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_match_start(&match, &config, pair_left, pair_right, pair_map, PIXELS, scratch, SCRATCH_LEN));
    memset(&match, 0xa5, sizeof match);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_start(&match, &config, pair_left, pair_right, pair_map + 1, PIXELS,
                                                   scratch, SCRATCH_LEN));
    pair_left.stride = pair_right.stride = 2 * WIDTH - 1; /* the map overtakes */
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_match_start(&match, &config, pair_left, pair_right, pair_map, PIXELS, scratch, SCRATCH_LEN));
    expect_untouched();
}

static void test_run_counts_rows(void)
{
    draw_shifted(3);
    TEST_ASSERT_EQUAL(TSR_OK, start(&config));
    TEST_ASSERT_EQUAL(2 * HEIGHT + 2, tsr_match_rows_total(&match));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_run(&match, 0));
    TEST_ASSERT_EQUAL(0, tsr_match_rows_done(&match));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_match_run(&match, 2 * HEIGHT + 1));
    TEST_ASSERT_EQUAL(2 * HEIGHT + 1, tsr_match_rows_done(&match));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, UINT16_MAX));
    TEST_ASSERT_EQUAL(2 * HEIGHT + 2, tsr_match_rows_done(&match));
    map[0] = 0x1234;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, 1));
    TEST_ASSERT_EQUAL_HEX16(0x1234, map[0]);
}

/* Columns from first on see their match; with noise-free views the sum there is
 * 0, so the map holds the shift to within half a pixel. */
static void expect_shift(const struct tsr_match_config *chosen, int shift, int first, int last)
{
    draw_shifted(shift);
    TEST_ASSERT_EQUAL(TSR_OK, start(chosen));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, UINT16_MAX));
    int wanted = 16 * (shift - chosen->search_start_px);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = first; x <= last; x++) {
            TEST_ASSERT_INT_WITHIN_MESSAGE(8, wanted, map[y * WIDTH + x], "disparity");
        }
    }
}

static void test_a_shift_is_found_at_every_start(void)
{
    struct tsr_match_config chosen = config;
    chosen.texture_min = TSR_MATCH_TEST_OFF;
    expect_shift(&chosen, 0, 4, WIDTH - 5);
    expect_shift(&chosen, 7, 11, WIDTH - 5);
    expect_shift(&chosen, 15, 19, WIDTH - 5);
    chosen.search_start_px = 20;
    expect_shift(&chosen, 27, 31, WIDTH - 5);
    chosen.search_start_px = -20;
    expect_shift(&chosen, -12, 4, WIDTH - 17);
}

static void test_flat_views_have_no_match(void)
{
    struct tsr_match_config chosen = config;
    memset(left_pixels, 90, PIXELS);
    memset(right_pixels, 90, PIXELS);
    TEST_ASSERT_EQUAL(TSR_OK, start(&chosen));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, UINT16_MAX));
    for (int i = 0; i < PIXELS; i++) {
        TEST_ASSERT_EQUAL_HEX16(TSR_DISPARITY_INVALID, map[i]);
    }
    memset(left_pixels, 90, PIXELS); /* all sums tie: without tests the lowest disparity wins */
    memset(right_pixels, 90, PIXELS);
    chosen.uniqueness_percent = chosen.texture_min = chosen.lr_tolerance_px = TSR_MATCH_TEST_OFF;
    TEST_ASSERT_EQUAL(TSR_OK, start(&chosen));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, UINT16_MAX));
    for (int i = 0; i < PIXELS; i++) {
        TEST_ASSERT_EQUAL_HEX16(0, map[i]);
    }
}

static void test_pixels_without_candidates_are_invalid(void)
{
    struct tsr_match_config chosen = config;
    chosen.uniqueness_percent = chosen.texture_min = chosen.lr_tolerance_px = TSR_MATCH_TEST_OFF;
    chosen.search_start_px = 30;
    draw_shifted(33);
    TEST_ASSERT_EQUAL(TSR_OK, start(&chosen));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_run(&match, UINT16_MAX));
    for (int x = 0; x < WIDTH; x++) {
        TEST_ASSERT_EQUAL(x < 30, map[x] == TSR_DISPARITY_INVALID);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_names_the_bad_field);
    RUN_TEST(test_check_accepts_the_ends_of_every_range);
    RUN_TEST(test_defaults_are_the_documented_ones);
    RUN_TEST(test_start_refuses_null_pointers_and_misalignment);
    RUN_TEST(test_start_refuses_wrong_shapes);
    RUN_TEST(test_start_refuses_small_buffers);
    RUN_TEST(test_start_accepts_the_pair_layout_and_no_tighter_one);
    RUN_TEST(test_run_counts_rows);
    RUN_TEST(test_a_shift_is_found_at_every_start);
    RUN_TEST(test_flat_views_have_no_match);
    RUN_TEST(test_pixels_without_candidates_are_invalid);
    return UNITY_END();
}
