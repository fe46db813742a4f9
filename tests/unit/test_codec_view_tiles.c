/*
 * What of a fresh view is coded against the held one: excess of tiles, their
 * contrast, the choice.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/view.h"
#include "unity.h"

#define WIDTH 21
#define HEIGHT 13
#define TILES TSR_VIEW_TILE_COUNT(WIDTH, HEIGHT)

static uint8_t view[WIDTH * HEIGHT];
static uint8_t wing_packed[TSR_VIEW_HELD_LEN(WIDTH, HEIGHT)];
static struct tsr_view_held wing;
static struct tsr_view_held empty;

void setUp(void)
{
    wing = (struct tsr_view_held){.packed = wing_packed, .packed_cap = sizeof wing_packed};
    empty = wing;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        view[i] = (uint8_t)(i % WIDTH < 8 ? (i % WIDTH * 5 + i / WIDTH * 2) % 15 : 7 + i % 3);
    }
}
void tearDown(void) {}

static void hold(bool coarse)
{
    static struct tsr_view_encoder encoder;
    uint8_t out[TSR_VIEW_ENCODED_LEN_MAX(WIDTH, HEIGHT)], scratch[TSR_VIEW_SCRATCH_LEN(WIDTH)];
    const struct tsr_view_info info = {.width = WIDTH, .height = HEIGHT, .cap = 7, .coarse = coarse};
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_view_encode_start(&encoder, &info, &wing, NULL, out, sizeof out, scratch, sizeof scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, view, WIDTH, HEIGHT));
}

/* Whole tiles, those cut by the right border (5 columns) and below (5 rows). */
static void test_excess(void)
{
    uint8_t excess[TILES];
    struct tsr_view_change change = {.tiles = excess, .tiles_cap = TILES};
    hold(false);
    memset(excess, 0x5a, sizeof excess);
    view[3 * WIDTH + 2] = (uint8_t)((view[3 * WIDTH + 2] + 7) % 15); /* tile 0 */
    view[8 * WIDTH + 8] += 1;                                        /* tile 4: noise */
    view[12 * WIDTH + 20] -= 3;                                      /* tile 5, of 25 pixels */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&wing, view, WIDTH, 0, 8, &change));
    TEST_ASSERT_EQUAL_HEX8(0x5a, excess[3]);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&wing, view + 8 * WIDTH, WIDTH, 8, 5, &change));
    TEST_ASSERT_TRUE(excess[0] == 6 || excess[0] == 7);
    const uint8_t rest[TILES - 1] = {0, 0, 0, 0, 2 * 64 / 25};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(rest, excess + 1, TILES - 1);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        view[i] = (uint8_t)(view[i] < 7 ? 14 : 0);
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&wing, view, WIDTH, 0, HEIGHT, &change));
    TEST_ASSERT_EACH_EQUAL_HEX8(255, excess, TILES);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_compare(NULL, view, WIDTH, 0, HEIGHT, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_compare(&empty, view, WIDTH, 0, HEIGHT, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_compare(&wing, NULL, WIDTH, 0, HEIGHT, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_compare(&wing, view, WIDTH, 0, HEIGHT, NULL));
    change.tiles_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_view_compare(&wing, view, WIDTH, 0, HEIGHT, &change));
    change.tiles_cap++;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_compare(&wing, view, WIDTH - 1, 0, HEIGHT, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_compare(&wing, view, WIDTH, 0, HEIGHT + 1, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_compare(&wing, view, WIDTH, 0, 9, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_compare(&wing, view, WIDTH, 4, 4, &change));
}

static void check_choice(const uint8_t excess[5], uint8_t threshold, const uint8_t expected[5])
{
    uint8_t chosen[5];
    struct tsr_view_change change = {.tiles = chosen, .tiles_cap = 5};
    size_t count = 0;
    memcpy(chosen, excess, sizeof chosen);
    for (unsigned i = 0; i < sizeof chosen; i++) {
        count += expected[i];
    }
    TEST_ASSERT_EQUAL(count, tsr_view_choose(&change, sizeof chosen, threshold));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, chosen, sizeof chosen);
}

static void test_choice(void)
{
    check_choice((const uint8_t[]){0, 5, 6, 7, 255}, 5, (const uint8_t[]){0, 0, 1, 1, 1});
    check_choice((const uint8_t[]){20, 0, 0, 21, 1}, 0, (const uint8_t[]){0, 0, 0, 1, 0});        /* 20 at least */
    check_choice((const uint8_t[]){31, 30, 10, 9, 10}, 0, (const uint8_t[]){1, 0, 0, 0, 0});      /* 3 medians */
    check_choice((const uint8_t[]){200, 120, 121, 90, 255}, 0, (const uint8_t[]){1, 0, 1, 0, 1}); /* 120 at most */
    uint8_t excess[1] = {0};
    struct tsr_view_change none = {.tiles = NULL};
    TEST_ASSERT_EQUAL(0, tsr_view_choose(NULL, 5, 1));
    TEST_ASSERT_EQUAL(0, tsr_view_choose(&none, 5, 1));
    none.tiles = excess;
    TEST_ASSERT_EQUAL(0, tsr_view_choose(&none, 0, 0));
}

/* Contrast that grows or shrinks nearly everywhere is the light's, and all is coded. */
static void test_another_light(void)
{
    const uint16_t leaning[][3] = {{24, 12, 0}, {25, 12, 1}, {12, 25, 1}, {31, 0, 0}, {0, 32, 1}, {16, 16, 0}};
    for (unsigned i = 0; i < sizeof leaning / sizeof leaning[0]; i++) {
        uint8_t excess[3] = {0, 1, 2};
        struct tsr_view_change change = {
            .tiles = excess, .tiles_cap = 3, .stronger = leaning[i][0], .weaker = leaning[i][1]};
        TEST_ASSERT_EQUAL(3 * leaning[i][2], tsr_view_choose(&change, 3, 0));
    }
}

static void test_contrast_of_tiles(void)
{
    uint8_t excess[TILES];
    struct tsr_view_change change = {.tiles = excess, .tiles_cap = TILES, .stronger = 9, .weaker = 9};
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        view[i] = i % WIDTH < 16 ? 9 : 4; /* v = 2 and -3, decoded -2 */
    }
    hold(true);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&wing, view, WIDTH, 0, HEIGHT, &change));
    TEST_ASSERT_EQUAL(0, change.stronger + change.weaker);
    view[0] = 6;
    view[WIDTH - 1] = 0;
    view[8] = 8;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&wing, view, WIDTH, 0, 8, &change));
    TEST_ASSERT_EQUAL(1, change.stronger);
    TEST_ASSERT_EQUAL(2, change.weaker);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&wing, view + 8 * WIDTH, WIDTH, 8, 5, &change));
    TEST_ASSERT_EQUAL(1, change.stronger);
    TEST_ASSERT_EQUAL(2, change.weaker);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_excess);
    RUN_TEST(test_choice);
    RUN_TEST(test_another_light);
    RUN_TEST(test_contrast_of_tiles);
    return UNITY_END();
}
