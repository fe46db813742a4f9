/*
 * What the change detector is for: sensor noise of 2 gray levels wakes nobody
 * (at most 1 of 1000 frames), an object of 2 % of the picture always does.
 *
 * Replay: SEED=n.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>
#include <stdlib.h>

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

int main(void)
{
    const char *seed = getenv("SEED");
    random_state = seed != NULL ? strtoull(seed, NULL, 10) : 1;
    printf("replay: SEED=%llu property_test_vision_change\n", (unsigned long long)random_state);
    UNITY_BEGIN();
    RUN_TEST(test_noise_wakes_nobody);
    RUN_TEST(test_an_object_always_wakes);
    return UNITY_END();
}
