/*
 * Zones of a map by hand: what counts, surfaces, ends of the range.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/zone.h"
#include "unity.h"

#define WIDTH 12u
#define HEIGHT 10u
#define NONE TSR_DISPARITY_INVALID

static uint16_t map[WIDTH * HEIGHT];
static struct tsr_zone zone;
static struct tsr_zone_config config;

void setUp(void)
{
    memset(map, 0xff, sizeof map);
    config = (struct tsr_zone_config){.part = {2, 1, 8, 6}, .kind = TSR_ZONE_NEARER, .limit_q4 = 160};
}
void tearDown(void) {}

static void fill(unsigned x, unsigned y, unsigned width, unsigned height, uint16_t value)
{
    for (unsigned row = y; row < y + height; row++) {
        for (unsigned column = x; column < x + width; column++) {
            map[row * WIDTH + column] = value;
        }
    }
}

static struct tsr_zone_result measure(uint16_t rows)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_zone_start(&zone, &config, map, WIDTH, HEIGHT));
    enum tsr_status status = TSR_AGAIN;
    for (unsigned i = 0; i < 3u * HEIGHT && status == TSR_AGAIN; i++) {
        status = tsr_zone_run(&zone, rows);
    }
    TEST_ASSERT_EQUAL(TSR_OK, status);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_zone_run(&zone, rows)); /* and stays so */
    return tsr_zone_get_result(&zone);
}

static void expect(uint32_t valid, uint32_t counted, uint16_t disparity_q8)
{
    for (uint16_t rows = 1; rows < 8; rows++) {
        const struct tsr_zone_result result = measure(rows);
        TEST_ASSERT_EQUAL(valid, result.valid);
        TEST_ASSERT_EQUAL(counted, result.counted);
        TEST_ASSERT_EQUAL(disparity_q8, result.disparity_q8);
    }
}

static void refuse(void)
{
    memset(&zone, 0xab, sizeof zone);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_zone_start(&zone, &config, map, WIDTH, HEIGHT));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xab, &zone, sizeof zone);
}

static void test_refuses_what_it_must(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_zone_start(NULL, &config, map, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_zone_start(&zone, NULL, map, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_zone_start(&zone, &config, NULL, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_zone_run(NULL, 1));
    config.kind = 0;
    refuse();
    config.kind = TSR_ZONE_SURFACE + 1;
    refuse();
    config.kind = TSR_ZONE_SURFACE;
    const struct tsr_rectangle outside[] = {{0, 0, 0, 1},        {0, 0, 1, 0},          {WIDTH, 0, 1, 1},
                                            {0, HEIGHT, 1, 1},   {1, 0, WIDTH, HEIGHT}, {0, 1, WIDTH, HEIGHT},
                                            {65535, 0, 65535, 1}};
    for (unsigned i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        config.part = outside[i];
        refuse();
    }
    config.part = (struct tsr_rectangle){0, 0, WIDTH, HEIGHT};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_zone_start(&zone, &config, map, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_zone_run(&zone, 0));
}

static void test_an_empty_map(void)
{
    for (uint8_t kind = TSR_ZONE_NEARER; kind <= TSR_ZONE_SURFACE; kind++) {
        config.kind = kind;
        expect(0, 0, TSR_ZONE_NO_DISPARITY);
    }
}

static void test_nearer_and_farther_part_at_the_limit(void)
{
    fill(0, 0, WIDTH, HEIGHT, 159);
    fill(2, 1, 8, 2, 160); /* two of six rows */
    fill(2, 3, 1, 1, NONE);
    fill(0, 0, 2, HEIGHT, 2000); /* beside the part: does not matter */
    expect(47, 16, 160 * 16);
    config.kind = TSR_ZONE_FARTHER;
    expect(47, 31, 159 * 16);
}

static void test_ends_of_the_range(void)
{
    fill(0, 0, WIDTH, HEIGHT, 0);
    config.limit_q4 = 0;
    expect(48, 48, 0);
    config.kind = TSR_ZONE_FARTHER;
    expect(48, 0, TSR_ZONE_NO_DISPARITY);
    config.kind = TSR_ZONE_SURFACE;
    expect(48, 48, 0);
    fill(0, 0, WIDTH, HEIGHT, 2047);
    expect(48, 48, 2047 * 16);
    config.kind = TSR_ZONE_NEARER;
    config.limit_q4 = 65535;
    expect(48, 0, TSR_ZONE_NO_DISPARITY);
}

static void test_mean_is_rounded_to_nearest(void)
{
    fill(2, 1, 8, 6, 160);
    map[1 * WIDTH + 2] = 162; /* 160 + 2 / 48 sixteenths: 2560.67 */
    expect(48, 48, 2561);
}

/* Mismatches on one side, a hand in front: the surface is where most of it is. */
static void test_surface_is_not_moved_by_what_stands_out(void)
{
    config.kind = TSR_ZONE_SURFACE;
    fill(2, 1, 8, 6, 320);
    fill(2, 1, 8, 2, 800);
    map[3 * WIDTH + 2] = 304; /* 1 px off still counts */
    map[3 * WIDTH + 3] = 303; /* this does not */
    expect(48, 31, 5112 /* (30 * 320 + 304) / 31 sixteenths are 5111.7 */);
}

/* d = 100 + 9 x + 4 y sixteenths: the mean is the value in the middle, though the part spans 5 px. */
static void test_tilted_surface_gives_its_middle(void)
{
    config.kind = TSR_ZONE_SURFACE;
    config.part = (struct tsr_rectangle){1, 1, 9, 7};
    for (unsigned y = 0; y < HEIGHT; y++) {
        for (unsigned x = 0; x < WIDTH; x++) {
            map[y * WIDTH + x] = (uint16_t)(100u + 9u * x + 4u * y);
        }
    }
    const struct tsr_zone_result result = measure(1);
    TEST_ASSERT_EQUAL(63, result.valid);
    TEST_ASSERT_EQUAL((100 + 9 * 5 + 4 * 4) * 16, result.disparity_q8);
}

static void test_visits_are_counted(void)
{
    fill(0, 0, WIDTH, HEIGHT, 5);
    (void)measure(4);
    TEST_ASSERT_EQUAL(6, tsr_zone_rows_done(&zone));
    config.kind = TSR_ZONE_SURFACE;
    (void)measure(4);
    TEST_ASSERT_EQUAL(18, tsr_zone_rows_done(&zone));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_refuses_what_it_must);
    RUN_TEST(test_an_empty_map);
    RUN_TEST(test_nearer_and_farther_part_at_the_limit);
    RUN_TEST(test_ends_of_the_range);
    RUN_TEST(test_mean_is_rounded_to_nearest);
    RUN_TEST(test_surface_is_not_moved_by_what_stands_out);
    RUN_TEST(test_tilted_surface_gives_its_middle);
    RUN_TEST(test_visits_are_counted);
    return UNITY_END();
}
