/*
 * What the change detector is for: sensor noise of 2 gray levels wakes nobody
 * (at most 1 of 1000 frames), nor does light on the whole picture; an object of
 * 2 % of the picture always does. Neither stride nor alignment matter, and a
 * region is what a flood fill finds.
 *
 * Replay: SEED=n.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/vision/change.h"
#include "unity.h"

#define WIDTH 160
#define HEIGHT 120
#define NOISE_FRAMES 1000
#define OBJECTS 100
#define OBJECT_SIDE 20 /* 400 of 19200 px: 2.1 % */
#define SIGMA 2.0

static uint64_t random_state;
static uint8_t scene[WIDTH * HEIGHT];
static uint8_t pixels[WIDTH * HEIGHT];
static uint8_t state[TSR_CHANGE_STATE_LEN(WIDTH, HEIGHT, 4)];
static struct tsr_change change;
static struct tsr_change_result result;

void setUp(void) {}
void tearDown(void) {}

static unsigned random_below(unsigned bound)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(random_state >> 33) % bound;
}

/* The sum of 12 uniform values, less its mean: sigma 1. */
static double draw_normal(void)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        sum += random_below(1u << 20) / (double)(1u << 20);
    }
    return sum;
}

/* Gray areas of 6 x 6 px, from dark to saturated. */
static void draw_scene(void)
{
    uint8_t areas[HEIGHT / 6][WIDTH / 6 + 1];
    for (size_t i = 0; i < sizeof areas; i++) {
        (&areas[0][0])[i] = (uint8_t)random_below(256);
    }
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        scene[i] = areas[i / WIDTH / 6][i % WIDTH / 6];
    }
}

static void watch(void)
{
    static const struct tsr_gray_view frame = {pixels, WIDTH, HEIGHT, WIDTH};
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        double value = scene[i] + SIGMA * draw_normal() + 0.5;
        pixels[i] = (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&change, &frame, &result));
}

static void start(unsigned frames)
{
    static const struct tsr_change_config config = {.width = WIDTH, .height = HEIGHT};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, sizeof state));
    draw_scene();
    for (unsigned i = 0; i < frames; i++) {
        watch();
    }
}

static void test_noise_wakes_nobody(void)
{
    unsigned wakes = 0;
    start(4);
    for (unsigned i = 0; i < NOISE_FRAMES; i++) {
        watch();
        wakes += result.changed ? 1u : 0u;
    }
    TEST_ASSERT_LESS_OR_EQUAL(1, wakes);
}

static void test_an_object_always_wakes(void)
{
    for (unsigned i = 0; i < OBJECTS; i++) {
        start(5);
        unsigned left = random_below(WIDTH - OBJECT_SIDE + 1);
        unsigned top = random_below(HEIGHT - OBJECT_SIDE + 1);
        for (unsigned k = 0; k < OBJECT_SIDE * OBJECT_SIDE; k++) {
            scene[(top + k / OBJECT_SIDE) * WIDTH + left + k % OBJECT_SIDE] = (uint8_t)random_below(256);
        }
        watch();
        TEST_ASSERT_TRUE(result.changed);
    }
}

/* Any light between 70 and 100 %, in one frame: what clips in part of a cell is no light, and may wake. */
static void test_light_wakes_nobody(void)
{
    static uint8_t full[WIDTH * HEIGHT];
    start(5);
    memcpy(full, scene, sizeof full);
    for (unsigned i = 0; i < NOISE_FRAMES / 4; i++) {
        unsigned percent = 70 + random_below(31);
        for (unsigned k = 0; k < WIDTH * HEIGHT; k++) {
            scene[k] = (uint8_t)(full[k] * percent / 100u);
        }
        watch();
        TEST_ASSERT_FALSE(result.changed);
    }
}

static void test_stride_and_alignment_do_not_matter(void)
{
    static uint8_t room[(WIDTH + 7) * HEIGHT + 4];
    static uint8_t other_state[sizeof state + 3];
    for (unsigned i = 0; i < OBJECTS; i++) {
        struct tsr_change other;
        struct tsr_change_result other_result;
        unsigned pad = random_below(8);
        struct tsr_change_config config = {.width = (uint16_t)(8 + random_below(WIDTH - 7)),
                                           .height = (uint16_t)(8 + random_below(HEIGHT - 7)),
                                           .reduction = (uint8_t)(4u << random_below(2))};
        const struct tsr_gray_view frame = {pixels, config.width, config.height, config.width};
        uint8_t *first = room + random_below(4);
        const struct tsr_gray_view padded = {first, config.width, config.height, (uint16_t)(config.width + pad)};
        uint8_t *other_cells = other_state + random_below(4);
        memset(state, 0, sizeof state);
        memset(other_state, 0, sizeof other_state);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, sizeof state));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&other, &config, other_cells, sizeof state));
        for (unsigned k = 0; k < 8; k++) {
            for (unsigned p = 0; p < (unsigned)config.width * config.height; p++) {
                pixels[p] = (uint8_t)random_below(k < 4 ? 30 : 256);
                first[p / config.width * padded.stride + p % config.width] = pixels[p];
            }
            TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&change, &frame, &result));
            TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&other, &padded, &other_result));
            TEST_ASSERT_EQUAL(result.changed, other_result.changed);
            TEST_ASSERT_EQUAL(result.changed_cells, other_result.changed_cells);
            TEST_ASSERT_EQUAL(result.light_q8, other_result.light_q8);
            TEST_ASSERT_EQUAL_MEMORY(state, other_cells, tsr_change_state_len(&config));
        }
    }
}

#define CELLS_X (WIDTH / 4)
#define CELLS_Y (HEIGHT / 4)

/* The cells of the largest region, by spreading over the whole picture until nothing is added. */
static unsigned flood(uint8_t cells[CELLS_Y][CELLS_X])
{
    unsigned largest = 0;
    for (unsigned start_at = 0; start_at < CELLS_X * CELLS_Y; start_at++) {
        if (cells[start_at / CELLS_X][start_at % CELLS_X] != 1) {
            continue;
        }
        unsigned count = 1;
        cells[start_at / CELLS_X][start_at % CELLS_X] = 2;
        for (bool added = true; added;) {
            added = false;
            for (int y = 0; y < CELLS_Y; y++) {
                for (int x = 0; x < CELLS_X; x++) {
                    bool joined = false;
                    for (int k = 0; k < 9 && cells[y][x] == 1; k++) {
                        int u = x + k % 3 - 1;
                        int v = y + k / 3 - 1;
                        joined = joined || (u >= 0 && u < CELLS_X && v >= 0 && v < CELLS_Y && cells[v][u] == 2);
                    }
                    if (joined) {
                        cells[y][x] = 2;
                        count++;
                        added = true;
                    }
                }
            }
        }
        for (unsigned i = 0; i < CELLS_X * CELLS_Y; i++) {
            uint8_t *cell = &cells[i / CELLS_X][i % CELLS_X];
            *cell = *cell == 2 ? 3 : *cell;
        }
        largest = count > largest ? count : largest;
    }
    return largest;
}

static void test_a_region_is_what_a_flood_fill_finds(void)
{
    for (unsigned i = 0; i < OBJECTS; i++) {
        static uint8_t cells[CELLS_Y][CELLS_X];
        unsigned percent = 5 + random_below(31); /* most voters must see no light */
        for (unsigned k = 0; k < CELLS_X * CELLS_Y; k++) {
            cells[k / CELLS_X][k % CELLS_X] = random_below(100) < percent ? 1 : 0;
        }
        const struct tsr_gray_view frame = {pixels, WIDTH, HEIGHT, WIDTH};
        for (unsigned more = 0; more < 2; more++) { /* as many cells as there are, and one more */
            static unsigned largest;
            memset(pixels, 60, sizeof pixels);
            struct tsr_change_config config = {.width = WIDTH, .height = HEIGHT};
            if (more == 0) {
                static uint8_t copy[CELLS_Y][CELLS_X];
                memcpy(copy, cells, sizeof copy);
                largest = flood(copy);
            }
            config.min_cells = (uint16_t)(largest + more);
            TEST_ASSERT_EQUAL(TSR_OK, tsr_change_init(&change, &config, state, sizeof state));
            for (unsigned k = 0; k < 5; k++) {
                TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&change, &frame, &result));
            }
            for (unsigned p = 0; p < WIDTH * HEIGHT; p++) {
                pixels[p] = cells[p / WIDTH / 4][p % WIDTH / 4] == 1 ? 255 : 60;
            }
            TEST_ASSERT_EQUAL(TSR_OK, tsr_change_update(&change, &frame, &result));
            TEST_ASSERT_EQUAL(more == 0, result.changed);
        }
    }
}

int main(void)
{
    const char *seed = getenv("SEED");
    random_state = seed != NULL ? strtoull(seed, NULL, 10) : 1;
    printf("replay: SEED=%llu property_test_vision_change\n", (unsigned long long)random_state);
    UNITY_BEGIN();
    RUN_TEST(test_noise_wakes_nobody);
    RUN_TEST(test_an_object_always_wakes);
    RUN_TEST(test_light_wakes_nobody);
    RUN_TEST(test_stride_and_alignment_do_not_matter);
    RUN_TEST(test_a_region_is_what_a_flood_fill_finds);
    return UNITY_END();
}
