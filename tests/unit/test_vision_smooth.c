/*
 * The matcher's census and smooth modes: buffers, sizes, borders, chosen maps.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <string.h>

#include "tsr/vision/match.h"
#include "unity.h"

#define WIDTH_MAX 49
#define HEIGHT_MAX 20
#define PIXELS_MAX (WIDTH_MAX * HEIGHT_MAX)
#define SCRATCH_MAX 10240
#define GUARD_LEN 16
#define GUARD 0xa5

static const uint8_t modes[] = {TSR_MATCH_CENSUS, TSR_MATCH_SMOOTH};
static uint8_t left_pixels[PIXELS_MAX];
static uint8_t right_pixels[PIXELS_MAX];
static uint16_t map[PIXELS_MAX];
static _Alignas(4) uint8_t scratch[SCRATCH_MAX + GUARD_LEN];
static struct tsr_match match;

void setUp(void)
{
    memset(&match, GUARD, sizeof match);
    memset(map, GUARD, sizeof map);
    memset(scratch, GUARD, sizeof scratch);
}
void tearDown(void) {}

static struct tsr_match_config config_of(uint8_t mode, uint16_t width, uint16_t height)
{
    struct tsr_match_config config = {.width = width, .height = height, .disparities = 16, .window = 5, .mode = mode};
    return config;
}

static uint8_t texture(int x, int y)
{
    uint32_t value = (uint32_t)(x + 1000) * 2654435761u ^ (uint32_t)y * 2246822519u;
    value ^= value >> 15;
    value *= 2246822519u;
    return (uint8_t)(value >> 25); /* 0 .. 127 */
}

/* The right view sees at x, in another light, what the left sees at x + shift. */
static void draw_shifted(const struct tsr_match_config *config, int shift, unsigned gain, unsigned bias)
{
    for (int y = 0; y < config->height; y++) {
        for (int x = 0; x < config->width; x++) {
            left_pixels[y * config->width + x] = texture(x, y);
            right_pixels[y * config->width + x] = (uint8_t)(gain * texture(x + shift, y) + bias);
        }
    }
}

static enum tsr_status start(const struct tsr_match_config *config, size_t scratch_cap)
{
    struct tsr_gray left = {left_pixels, config->width, config->height, config->width};
    struct tsr_gray right = {right_pixels, config->width, config->height, config->width};
    return tsr_match_start(&match, config, left, right, map, PIXELS_MAX, scratch, scratch_cap);
}

static void run_by(const struct tsr_match_config *config, uint16_t rows)
{
    TEST_ASSERT_EQUAL(TSR_OK, start(config, tsr_match_scratch_len(config)));
    enum tsr_status status = TSR_AGAIN;
    for (unsigned calls = 0; status == TSR_AGAIN; calls++) {
        TEST_ASSERT_LESS_OR_EQUAL(tsr_match_rows_total(&match), calls * rows);
        status = tsr_match_run(&match, rows);
    }
    TEST_ASSERT_EQUAL(TSR_OK, status);
    TEST_ASSERT_EQUAL(tsr_match_rows_total(&match), tsr_match_rows_done(&match));
}

static void test_finds_a_shift_in_another_light(void)
{
    for (unsigned i = 0; i < sizeof modes; i++) {
        struct tsr_match_config config = config_of(modes[i], WIDTH_MAX, HEIGHT_MAX);
        draw_shifted(&config, 6, 2, 1);
        run_by(&config, UINT16_MAX);
        for (unsigned y = 4; y < HEIGHT_MAX - 4u; y++) {
            for (unsigned x = 12; x < WIDTH_MAX - 6u; x++) {
                TEST_ASSERT_UINT16_WITHIN(8, 6 * 16, map[y * WIDTH_MAX + x]);
            }
        }
    }
}

static void test_a_view_without_texture_is_not_unique(void)
{
    for (unsigned i = 0; i < sizeof modes; i++) {
        struct tsr_match_config config = config_of(modes[i], WIDTH_MAX, HEIGHT_MAX);
        memset(left_pixels, 90, sizeof left_pixels);
        memset(right_pixels, 90, sizeof right_pixels);
        run_by(&config, UINT16_MAX);
        for (unsigned y = 0; y < HEIGHT_MAX; y++) {
            /* Columns 0 and 1 search only d = 0 and 0, 1: nothing is left to confuse them with. */
            for (unsigned x = 2; x < WIDTH_MAX; x++) {
                TEST_ASSERT_EQUAL_HEX16(TSR_DISPARITY_INVALID, map[y * WIDTH_MAX + x]);
            }
        }
        config.uniqueness_percent = TSR_MATCH_TEST_OFF;
        run_by(&config, UINT16_MAX);
        TEST_ASSERT_EQUAL_UINT16(0, map[0]);
        TEST_ASSERT_EQUAL_UINT16(0, map[PIXELS_MAX - 1]);
    }
}

static void test_only_existing_disparities_are_chosen(void)
{
    for (unsigned i = 0; i < sizeof modes; i++) {
        struct tsr_match_config config = config_of(modes[i], WIDTH_MAX, HEIGHT_MAX);
        config.uniqueness_percent = config.lr_tolerance_px = TSR_MATCH_TEST_OFF;
        int room = config.width - config.disparities;
        for (int search_start = -room; search_start <= room; search_start += room) {
            config.search_start_px = (int16_t)search_start;
            draw_shifted(&config, 3, 1, 0);
            run_by(&config, UINT16_MAX);
            for (int x = 0; x < config.width; x++) {
                int lowest = x - search_start - (config.width - 1);
                int highest = x - search_start;
                bool offered = lowest < config.disparities && highest >= 0;
                int value = map[x];
                TEST_ASSERT_EQUAL(offered, value != TSR_DISPARITY_INVALID);
                TEST_ASSERT_TRUE(!offered || (value >= 16 * lowest && value <= 16 * highest));
            }
        }
    }
}

static void test_scratch_is_used_to_the_last_byte_and_no_further(void)
{
    for (unsigned i = 0; i < sizeof modes; i++) {
        for (uint16_t width = 16; width <= WIDTH_MAX; width = (uint16_t)(width + 11)) {
            struct tsr_match_config config = config_of(modes[i], width, 7);
            size_t len = tsr_match_scratch_len(&config);
            TEST_ASSERT_LESS_OR_EQUAL(SCRATCH_MAX, len);
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(&config, len - 1u));
            draw_shifted(&config, 2, 1, 0);
            memset(scratch, GUARD, sizeof scratch);
            run_by(&config, 1);
            for (size_t k = len; k < len + GUARD_LEN; k++) {
                TEST_ASSERT_EQUAL_HEX8(GUARD, scratch[k]);
            }
        }
    }
    struct tsr_match_config smooth = {.width = 160, .height = 120, .disparities = 32, .mode = TSR_MATCH_SMOOTH};
    TEST_ASSERT_EQUAL(27624, tsr_match_scratch_len(&smooth));
    TEST_ASSERT_EQUAL(27624, TSR_MATCH_SMOOTH_SCRATCH_LEN(160, 32));
    struct tsr_match_config census = {.width = 161, .height = 120, .disparities = 24, .mode = TSR_MATCH_CENSUS};
    TEST_ASSERT_EQUAL(TSR_MATCH_CENSUS_SCRATCH_LEN(161, 24, 9), tsr_match_scratch_len(&census));
    TEST_ASSERT_EQUAL(39680, tsr_match_pair_len(&smooth));
}

static void test_the_division_into_calls_changes_nothing(void)
{
    static uint16_t at_once[PIXELS_MAX];
    for (unsigned i = 0; i < sizeof modes; i++) {
        struct tsr_match_config config = config_of(modes[i], 41, 13);
        draw_shifted(&config, 4, 1, 5);
        run_by(&config, UINT16_MAX);
        memcpy(at_once, map, sizeof map);
        for (uint16_t rows = 1; rows < 15; rows++) {
            memset(map, GUARD, sizeof map);
            run_by(&config, rows);
            TEST_ASSERT_EQUAL_HEX16_ARRAY(at_once, map, 41 * 13);
        }
    }
}

static void test_least_sizes(void)
{
    struct tsr_match_config census = config_of(TSR_MATCH_CENSUS, 16, 5);
    struct tsr_match_config smooth = config_of(TSR_MATCH_SMOOTH, 16, 7);
    draw_shifted(&smooth, 1, 1, 0);
    run_by(&census, 1);
    run_by(&smooth, 1);
    smooth.height = 6;
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_match_check(&smooth, &field));
    TEST_ASSERT_EQUAL_STRING("height", field);
    census.window = 15;
    census.height = 16;
    census.prefilter_cap = 7; /* not one for SAD with that window, and not looked at */
    census.texture_min = 200;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_check(&census, &field));
}

static void test_refuses_modes_without_code(void)
{
    for (unsigned mode = 0; mode <= UINT8_MAX; mode++) {
        struct tsr_match_config config = config_of((uint8_t)mode, 32, 16);
        bool known = mode <= TSR_MATCH_SSD;
        const char *field = NULL;
        TEST_ASSERT_EQUAL(known ? TSR_OK : TSR_ERR_ARG, tsr_match_check(&config, &field));
        TEST_ASSERT_EQUAL_STRING(known ? NULL : "mode", field);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_finds_a_shift_in_another_light);
    RUN_TEST(test_a_view_without_texture_is_not_unique);
    RUN_TEST(test_only_existing_disparities_are_chosen);
    RUN_TEST(test_scratch_is_used_to_the_last_byte_and_no_further);
    RUN_TEST(test_the_division_into_calls_changes_nothing);
    RUN_TEST(test_least_sizes);
    RUN_TEST(test_refuses_modes_without_code);
    return UNITY_END();
}
