/*
 * Properties of the matcher and the median on random sizes, strides and content:
 * the map does not depend on how rows are divided among calls; matching in place
 * in the pair layout gives the map of separate buffers; no byte outside a
 * buffer is touched (each ends at a page that faults, and begins after one).
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

#include "tsr/vision/match.h"
#include "tsr/vision/median.h"
#include "unity.h"

#define CASES 120
#define WIDTH_MAX 96
#define HEIGHT_MAX 40

static uint64_t state;
static uint64_t seed;

void setUp(void) {}
void tearDown(void) {}

static unsigned random_below(unsigned bound)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(state >> 33) % bound;
}

/* len bytes between two pages that fault, at the end of the room (the default)
 * or, if at_begin, at its begin. */
struct guarded {
    uint8_t *bytes;
    uint8_t *room;
    size_t room_len;
};

static struct guarded guard(size_t len, size_t align, bool at_begin)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    struct guarded buffer;
    buffer.room_len = (len / page + 3) * page;
    buffer.room = mmap(NULL, buffer.room_len, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(buffer.room != MAP_FAILED);
    size_t last_page = buffer.room_len - page;
    TEST_ASSERT_EQUAL(0, mprotect(buffer.room, page, PROT_NONE));
    TEST_ASSERT_EQUAL(0, mprotect(buffer.room + last_page, page, PROT_NONE));
    buffer.bytes = at_begin ? buffer.room + page : buffer.room + (last_page - len) / align * align;
    for (size_t i = 0; i < len; i++) {
        buffer.bytes[i] = (uint8_t)random_below(256);
    }
    return buffer;
}

static void release(struct guarded *buffer)
{
    munmap(buffer->room, buffer->room_len);
}

enum content {
    RANDOM,
    CONSTANT,
    SATURATED,
    NOISE,
    CHECKER,
    SHIFTED,
    CONTENT_COUNT
};

static uint8_t draw_pixel(enum content content, unsigned x, unsigned y)
{
    switch (content) {
    case CONSTANT: return 128;
    case SATURATED: return random_below(8) == 0 ? 0 : 255;
    case NOISE: return (uint8_t)(126 + random_below(5));
    case CHECKER: return ((x ^ y) & 1u) != 0 ? 255 : 0;
    default: return (uint8_t)random_below(256);
    }
}

struct example {
    struct tsr_match_config config;
    enum content content;
    uint8_t left[WIDTH_MAX * HEIGHT_MAX];
    uint8_t right[WIDTH_MAX * HEIGHT_MAX];
};

static struct example example;
static uint16_t wanted[WIDTH_MAX * HEIGHT_MAX];

static uint8_t random_setting(unsigned max)
{
    return random_below(4) == 0 ? TSR_MATCH_TEST_OFF : (uint8_t)random_below(max + 1);
}

static void draw_example(void)
{
    struct tsr_match_config *config = &example.config;
    config->window = (uint8_t)(5 + 2 * random_below(6));
    config->disparities = (uint16_t)(16 + 8 * random_below(5));
    config->width = (uint16_t)(config->disparities + random_below(WIDTH_MAX - config->disparities + 1u));
    config->height = (uint16_t)(config->window + random_below(HEIGHT_MAX - config->window + 1u));
    config->prefilter_cap = (uint8_t)random_below((config->window < 9 ? 7u : 63u / config->window) + 1u);
    config->uniqueness_percent = random_setting(100);
    config->texture_min = random_setting(20);
    config->lr_tolerance_px = random_setting(5);
    int room = config->width - config->disparities;
    config->search_start_px = (int16_t)((int)random_below(2u * (unsigned)room + 1u) - room);
    example.content = (enum content)random_below(CONTENT_COUNT);
    unsigned shift = random_below(config->disparities);
    for (unsigned y = 0; y < config->height; y++) {
        for (unsigned x = 0; x < config->width; x++) {
            size_t i = (size_t)y * config->width + x;
            example.left[i] = draw_pixel(example.content, x, y);
            example.right[i] = draw_pixel(example.content, x, y);
        }
        for (unsigned x = 0; example.content == SHIFTED && x + shift < config->width; x++) {
            size_t i = (size_t)y * config->width + x;
            example.right[i] = example.left[i + shift];
        }
    }
}

static void copy_frame(struct tsr_gray to, const uint8_t *from)
{
    for (unsigned y = 0; y < to.height; y++) {
        memcpy(to.pixels + (size_t)y * to.stride, from + (size_t)y * to.width, to.width);
    }
}

/* rows = 0: a random number of rows in each call */
static void run(struct tsr_match *match, uint16_t rows)
{
    enum tsr_status status = TSR_AGAIN;
    unsigned calls = 0;
    while (status == TSR_AGAIN) {
        status = tsr_match_run(match, rows != 0 ? rows : (uint16_t)(1u + random_below(7)));
        TEST_ASSERT_LESS_OR_EQUAL(tsr_match_rows_total(match), ++calls);
    }
    TEST_ASSERT_EQUAL(TSR_OK, status);
    TEST_ASSERT_EQUAL(tsr_match_rows_total(match), tsr_match_rows_done(match));
}

/* A frame of just the bytes its view spans. */
static struct guarded guard_frame(struct tsr_gray *frame, bool at_begin)
{
    frame->width = example.config.width;
    frame->height = example.config.height;
    frame->stride = (uint16_t)(frame->width + random_below(9));
    struct guarded buffer = guard((size_t)frame->stride * (frame->height - 1u) + frame->width, 1, at_begin);
    frame->pixels = buffer.bytes;
    return buffer;
}

static void match_apart(uint16_t *map, uint16_t rows, bool at_begin)
{
    size_t pixels = (size_t)example.config.width * example.config.height;
    size_t scratch_len = tsr_match_scratch_len(&example.config);
    struct tsr_gray left;
    struct tsr_gray right;
    struct guarded left_buffer = guard_frame(&left, at_begin);
    struct guarded right_buffer = guard_frame(&right, at_begin);
    struct guarded map_buffer = guard(2 * pixels, 2, at_begin);
    struct guarded scratch = guard(scratch_len, TSR_MATCH_SCRATCH_ALIGN, at_begin);
    struct tsr_match match;
    copy_frame(left, example.left);
    copy_frame(right, example.right);
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_match_start(&match, &example.config, left, right, (uint16_t *)(void *)map_buffer.bytes,
                                      pixels, scratch.bytes, scratch_len));
    run(&match, rows);
    memcpy(map, map_buffer.bytes, 2 * pixels);
    release(&left_buffer);
    release(&right_buffer);
    release(&map_buffer);
    release(&scratch);
}

static void match_in_place(uint16_t *map, uint16_t rows, bool at_begin)
{
    size_t pixels = (size_t)example.config.width * example.config.height;
    size_t scratch_len = tsr_match_scratch_len(&example.config);
    struct guarded pair = guard(tsr_match_pair_len(&example.config), 2, at_begin);
    struct guarded scratch = guard(scratch_len, TSR_MATCH_SCRATCH_ALIGN, at_begin);
    struct tsr_gray left = tsr_match_pair_left(pair.bytes, &example.config);
    struct tsr_gray right = tsr_match_pair_right(pair.bytes, &example.config);
    struct tsr_match match;
    copy_frame(left, example.left);
    copy_frame(right, example.right);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_start(&match, &example.config, left, right, tsr_match_pair_map(pair.bytes),
                                              pixels, scratch.bytes, scratch_len));
    run(&match, rows);
    memcpy(map, pair.bytes, 2 * pixels);
    release(&pair);
    release(&scratch);
}

static void name_case(char *text, size_t cap, unsigned number)
{
    const struct tsr_match_config *c = &example.config;
    (void)snprintf(text, cap, "SEED=%llu case %u: %ux%u D %u window %u start %d content %d", (unsigned long long)seed,
                   number, c->width, c->height, c->disparities, c->window, c->search_start_px, (int)example.content);
}

static void test_the_map_depends_on_nothing_but_the_views(void)
{
    static uint16_t map[WIDTH_MAX * HEIGHT_MAX];
    for (unsigned i = 0; i < CASES; i++) {
        char text[160];
        draw_example();
        name_case(text, sizeof text, i);
        size_t len = sizeof(uint16_t) * example.config.width * example.config.height;
        match_apart(wanted, UINT16_MAX, false);
        match_apart(map, 1, true);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(wanted, map, len, text);
        match_apart(map, 0, false);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(wanted, map, len, text);
        match_in_place(map, UINT16_MAX, false);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(wanted, map, len, text);
        match_in_place(map, 0, true);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(wanted, map, len, text);
    }
}

static void test_every_chunk_size_gives_the_same_map(void)
{
    static uint16_t map[WIDTH_MAX * HEIGHT_MAX];
    draw_example();
    example.content = RANDOM;
    size_t len = sizeof(uint16_t) * example.config.width * example.config.height;
    match_in_place(wanted, UINT16_MAX, false);
    for (uint16_t rows = 1; rows <= 2u * example.config.height + example.config.window; rows++) {
        match_in_place(map, rows, false);
        TEST_ASSERT_EQUAL_MEMORY(wanted, map, len);
    }
}

static void test_valid_values_lie_in_the_coded_range(void)
{
    for (unsigned i = 0; i < CASES; i++) {
        char text[160];
        draw_example();
        name_case(text, sizeof text, i);
        match_apart(wanted, UINT16_MAX, false);
        for (size_t k = 0; k < (size_t)example.config.width * example.config.height; k++) {
            bool valid = wanted[k] <= 16u * (example.config.disparities - 1u);
            TEST_ASSERT_TRUE_MESSAGE(valid || wanted[k] == TSR_DISPARITY_INVALID, text);
        }
    }
}

static void test_the_median_depends_on_nothing_but_the_map(void)
{
    for (unsigned i = 0; i < CASES; i++) {
        uint16_t width = (uint16_t)(1u + random_below(WIDTH_MAX));
        uint16_t height = (uint16_t)(1u + random_below(HEIGHT_MAX));
        size_t pixels = (size_t)width * height;
        struct guarded map = guard(2 * pixels, 2, i % 2 != 0);
        struct guarded scratch = guard(TSR_MEDIAN_SCRATCH_LEN(width), TSR_MEDIAN_SCRATCH_ALIGN, i % 2 == 0);
        uint16_t *values = (uint16_t *)(void *)map.bytes;
        static uint16_t before[WIDTH_MAX * HEIGHT_MAX];
        for (size_t k = 0; k < pixels; k++) {
            before[k] = random_below(3) == 0 ? TSR_DISPARITY_INVALID : (uint16_t)random_below(500);
        }
        for (unsigned pass = 0; pass < 2; pass++) {
            struct tsr_median median;
            memcpy(values, before, 2 * pixels);
            TEST_ASSERT_EQUAL(TSR_OK, tsr_median_start(&median, width, height, values, pixels, scratch.bytes,
                                                       TSR_MEDIAN_SCRATCH_LEN(width)));
            while (tsr_median_run(&median, pass == 0 ? UINT16_MAX : (uint16_t)(1u + random_below(5))) == TSR_AGAIN) {
            }
            if (pass == 0) {
                memcpy(wanted, values, 2 * pixels);
            }
        }
        TEST_ASSERT_EQUAL_MEMORY(wanted, values, 2 * pixels);
        release(&map);
        release(&scratch);
    }
}

int main(void)
{
    const char *text = getenv("SEED");
    seed = text != NULL ? strtoull(text, NULL, 10) : 1;
    state = seed;
    printf("replay: SEED=%llu property_test_vision_match\n", (unsigned long long)seed);
    UNITY_BEGIN();
    RUN_TEST(test_the_map_depends_on_nothing_but_the_views);
    RUN_TEST(test_every_chunk_size_gives_the_same_map);
    RUN_TEST(test_valid_values_lie_in_the_coded_range);
    RUN_TEST(test_the_median_depends_on_nothing_but_the_map);
    return UNITY_END();
}
