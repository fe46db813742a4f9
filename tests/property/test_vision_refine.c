/*
 * Properties of the filters of a map on random sizes and content: the result
 * does not depend on how rows are divided among calls nor on what the scratch
 * held; no byte outside a buffer is touched (each ends at a page that faults, or
 * begins after one); a buffer that is one too small is refused; smoothing keeps
 * the valid pixels and their range; what is invalid all over stays so.
 *
 * Replay: SEED=n; the case number is printed with a failure.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "tsr/vision/refine.h"
#include "unity.h"

#define CASES 1500
#define WIDTH_MAX 70
#define HEIGHT_MAX 40
#define PIXELS_MAX (WIDTH_MAX * HEIGHT_MAX)

static uint64_t state;
static uint64_t seed;
static uint16_t before[PIXELS_MAX];
static uint16_t wanted[PIXELS_MAX];

void setUp(void) {}
void tearDown(void) {}

static unsigned random_below(unsigned bound)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(state >> 33) % bound;
}

/* len bytes between two pages that fault, at the end of the room or at its begin. */
struct guarded {
    uint8_t *bytes;
    uint8_t *room;
    size_t room_len;
};

static struct guarded guard(size_t len, bool at_begin)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    struct guarded buffer;
    buffer.room_len = (len / page + 3) * page;
    buffer.room = mmap(NULL, buffer.room_len, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(buffer.room != MAP_FAILED);
    size_t last_page = buffer.room_len - page;
    TEST_ASSERT_EQUAL(0, mprotect(buffer.room, page, PROT_NONE));
    TEST_ASSERT_EQUAL(0, mprotect(buffer.room + last_page, page, PROT_NONE));
    buffer.bytes = at_begin ? buffer.room + page : buffer.room + last_page - len;
    for (size_t i = 0; i < len; i++) {
        buffer.bytes[i] = (uint8_t)random_below(256);
    }
    return buffer;
}

static void release(struct guarded *buffer)
{
    munmap(buffer->room, buffer->room_len);
}

/* Random values, smooth ones with edges, snakes that join late, or nothing valid. */
static void draw_map(uint16_t width, uint16_t height)
{
    unsigned kind = random_below(5);
    unsigned spread = random_below(3) == 0 ? 65535u : 1u + random_below(200);
    unsigned holes = random_below(11);
    for (unsigned y = 0; y < height; y++) {
        for (unsigned x = 0; x < width; x++) {
            bool comb = x % 2u == 0 || y + 1u == height; /* arms that meet in the last row */
            unsigned value = kind == 0 ? random_below(spread) : 100u + 3u * x + (x * y > 300u ? 250u : 0u);
            bool hole = kind == 3 ? !comb : kind == 4 || random_below(10) < holes;
            before[y * width + x] = hole ? TSR_DISPARITY_INVALID : (uint16_t)value;
        }
    }
}

static struct tsr_refine_config draw_config(unsigned steps)
{
    struct tsr_refine_config config = {0};
    config.width = (uint16_t)(random_below(8) == 0 ? 1u : 1u + random_below(WIDTH_MAX));
    config.height = (uint16_t)(random_below(8) == 0 ? 1u : 1u + random_below(HEIGHT_MAX));
    for (unsigned i = 0; i < steps; i++) {
        config.steps[i] = (uint8_t)(1u + random_below(TSR_REFINE_STEP_COUNT - 1u));
    }
    config.speckle.min_size = (uint16_t)(2u + random_below(random_below(4) == 0 ? 4000 : 60));
    config.speckle.max_difference_q4 = (uint16_t)random_below(40);
    config.diffusion.iterations = (uint8_t)random_below(5);
    config.diffusion.edge_q4 = (uint8_t)random_below(256);
    config.diffusion.rate_q8 = (uint8_t)random_below(65);
    return config;
}

static void refine_map(const struct tsr_refine_config *config, uint16_t *map, uint8_t *scratch, bool in_chunks)
{
    size_t pixels = (size_t)config->width * config->height;
    size_t len = tsr_refine_scratch_len(config);
    struct tsr_refine refine;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_refine_start(&refine, config, map, pixels - 1, scratch, len));
    if (len > 0) {
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_refine_start(&refine, config, map, pixels, scratch, len - 1));
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_refine_start(&refine, config, map, pixels, scratch, len));
    while (tsr_refine_run(&refine, in_chunks ? (uint16_t)(1u + random_below(5)) : UINT16_MAX) == TSR_AGAIN) {
    }
    TEST_ASSERT_EQUAL(tsr_refine_rows_total(&refine), tsr_refine_rows_done(&refine));
}

static void name_case(char *text, size_t cap, unsigned i, const struct tsr_refine_config *config)
{
    snprintf(text, cap, "case %u of SEED=%llu: %ux%u, steps %u %u", i, (unsigned long long)seed, config->width,
             config->height, config->steps[0], config->steps[1]);
}

static void test_the_result_depends_on_nothing_but_the_map(void)
{
    for (unsigned i = 0; i < CASES; i++) {
        struct tsr_refine_config config = draw_config(random_below(TSR_REFINE_STEPS_MAX + 1u));
        size_t len = sizeof(uint16_t) * config.width * config.height;
        char text[120];
        name_case(text, sizeof text, i, &config);
        draw_map(config.width, config.height);
        struct guarded map = guard(len, i % 2 != 0);
        struct guarded scratch = guard(tsr_refine_scratch_len(&config), i % 2 == 0);
        memcpy(map.bytes, before, len);
        refine_map(&config, (uint16_t *)(void *)map.bytes, scratch.bytes, false);
        memcpy(wanted, map.bytes, len);
        memcpy(map.bytes, before, len);
        refine_map(&config, (uint16_t *)(void *)map.bytes, scratch.bytes, true);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(wanted, map.bytes, len, text);
        release(&map);
        release(&scratch);
    }
}

/* Of the valid values of before: least and greatest. */
static void find_range(size_t pixels, unsigned *least, unsigned *greatest)
{
    *least = TSR_DISPARITY_INVALID;
    *greatest = 0;
    for (size_t k = 0; k < pixels; k++) {
        if (before[k] != TSR_DISPARITY_INVALID) {
            *least = before[k] < *least ? before[k] : *least;
            *greatest = before[k] > *greatest ? before[k] : *greatest;
        }
    }
}

static void test_no_filter_invents_values(void)
{
    static uint8_t scratch[TSR_SPECKLE_SCRATCH_LEN(WIDTH_MAX, TSR_SPECKLE_SIZE_MAX)];
    for (unsigned i = 0; i < CASES; i++) {
        struct tsr_refine_config config = draw_config(1);
        size_t pixels = (size_t)config.width * config.height;
        unsigned step = config.steps[0];
        unsigned least = 0;
        unsigned greatest = 0;
        char text[120];
        name_case(text, sizeof text, i, &config);
        draw_map(config.width, config.height);
        find_range(pixels, &least, &greatest);
        memcpy(wanted, before, sizeof wanted);
        refine_map(&config, wanted, scratch, true);
        bool dense = step == TSR_REFINE_FILL && least <= greatest;
        bool same_pixels = step >= TSR_REFINE_GAUSSIAN3;
        for (size_t k = 0; k < pixels; k++) {
            bool is_valid = wanted[k] != TSR_DISPARITY_INVALID;
            bool was_valid = before[k] != TSR_DISPARITY_INVALID;
            TEST_ASSERT_TRUE_MESSAGE(!is_valid || (wanted[k] >= least && wanted[k] <= greatest), text);
            TEST_ASSERT_TRUE_MESSAGE(!dense || is_valid, text);
            TEST_ASSERT_TRUE_MESSAGE(!same_pixels || is_valid == was_valid, text);
            if (step == TSR_REFINE_SPECKLE || (step == TSR_REFINE_FILL && was_valid)) {
                TEST_ASSERT_TRUE_MESSAGE(wanted[k] == before[k] || (step == TSR_REFINE_SPECKLE && !is_valid), text);
            }
        }
    }
}

int main(void)
{
    const char *text = getenv("SEED");
    seed = text != NULL ? strtoull(text, NULL, 10) : 1;
    state = seed;
    printf("replay: SEED=%llu property_test_vision_refine\n", (unsigned long long)seed);
    UNITY_BEGIN();
    RUN_TEST(test_the_result_depends_on_nothing_but_the_map);
    RUN_TEST(test_no_filter_invents_values);
    return UNITY_END();
}
