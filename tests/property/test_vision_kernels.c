/*
 * Every kernel of the matcher that runs here gives the portable one's map, bit
 * for bit: all windows, disparity counts, search starts, modes and caps, odd sizes,
 * strides and alignments, any content, tests on and off, and with a right view that
 * is prefiltered already. Runs on the host and on the board.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/vision/match.h"
#include "tsr/vision/prefilter.h"
#include "unity.h"

#define WIDTH_MAX 176
#define HEIGHT_MAX 40
#define STRIDE_MAX (WIDTH_MAX + 9)
/* Contents for each window and disparity count: an emulated board takes minutes for what the host does in seconds. */
#if defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'
#define SWEEP_CONTENTS 1
#else
#define SWEEP_CONTENTS 3
#endif
#define GUARD 64
#define GUARD_BYTE 0xa5
#define FRAME_LEN (STRIDE_MAX * HEIGHT_MAX)
#define SCRATCH_MAX (6u * TSR_MATCH_SCRATCH_LEN(WIDTH_MAX, TSR_DISPARITY_COUNT_MAX)) /* of smooth */

static uint64_t state;
static uint8_t scene[2][WIDTH_MAX * HEIGHT_MAX];
static uint8_t frames[2][GUARD + FRAME_LEN + GUARD];
static _Alignas(4) uint8_t scratch[GUARD + SCRATCH_MAX + GUARD];
static uint16_t pair_room[TSR_MATCH_PAIR_LEN(WIDTH_MAX, HEIGHT_MAX, TSR_MATCH_WINDOW_MAX) / 2];
static uint16_t wanted[WIDTH_MAX * HEIGHT_MAX];
static uint16_t got[GUARD + WIDTH_MAX * HEIGHT_MAX + GUARD];

void setUp(void) {}
void tearDown(void) {}

static uint32_t draw(void)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33);
}

static unsigned below(unsigned limit)
{
    return draw() % limit;
}

/* A scene seen twice with noise, or contents that strain the sums. */
static void draw_scene(unsigned width, unsigned height, unsigned kind, int shift)
{
    uint32_t salt = draw();
    for (unsigned y = 0; y < height; y++) {
        for (unsigned x = 0; x < width; x++) {
            uint8_t *left = &scene[0][y * width + x];
            uint8_t *right = &scene[1][y * width + x];
            uint32_t place = (x + 512u) / 3u * 2654435761u ^ y / 2u * 2246822519u ^ salt;
            uint32_t seen = (x + 512u + (unsigned)shift) / 3u * 2654435761u ^ y / 2u * 2246822519u ^ salt;
            switch (kind) {
            case 0:
                *left = (uint8_t)((place >> 13 & 0xf8u) + below(4));
                *right = (uint8_t)((seen >> 13 & 0xf8u) + below(4));
                break;
            case 1:
                *left = (uint8_t)draw();
                *right = (uint8_t)draw();
                break;
            case 2: *left = *right = 77; break;
            case 3: /* checker of one pixel, saturated */
                *left = (x + y) % 2u != 0 ? 255 : 0;
                *right = (x / 2u + y) % 2u != 0 ? 255 : 0;
                break;
            default: /* steep stripes of opposite sign: the largest differences */
                *left = x / 2u % 2u != 0 ? 255 : 0;
                *right = x / 2u % 2u != 0 ? 0 : 255;
                break;
            }
        }
    }
}

static struct tsr_gray place(unsigned which, unsigned width, unsigned height, unsigned stride, unsigned offset)
{
    memset(frames[which], GUARD_BYTE, sizeof frames[which]);
    /* What ends the buffer ends the frame: a guard follows the last pixel. */
    uint8_t *first = frames[which] + GUARD + offset;
    for (unsigned y = 0; y < height; y++) {
        memcpy(first + (size_t)y * stride, &scene[which][y * width], width);
    }
    return (struct tsr_gray){first, (uint16_t)width, (uint16_t)height, (uint16_t)stride};
}

static void expect_guards(const struct tsr_match_config *config, unsigned stride, unsigned offset)
{
    size_t scratch_len = tsr_match_scratch_len(config);
    size_t pixels = (size_t)config->width * config->height;
    for (unsigned i = 0; i < GUARD; i++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD_BYTE, scratch[i], "before scratch");
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD_BYTE, scratch[GUARD + scratch_len + i], "behind scratch");
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0xa5a5, got[i], "before map");
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0xa5a5, got[GUARD + pixels + i], "behind map");
    }
    size_t span = (size_t)stride * (config->height - 1u) + config->width;
    for (unsigned which = 0; which < 2; which++) {
        const uint8_t *first = frames[which] + GUARD + offset;
        for (unsigned i = 1; i <= GUARD / 2; i++) {
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD_BYTE, *(first - i), "before frame");
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD_BYTE, first[span - 1u + i], "behind frame");
        }
        for (unsigned y = 0; y + 1u < config->height; y++) {
            for (unsigned x = config->width; x < stride; x++) {
                TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD_BYTE, first[(size_t)y * stride + x], "between rows");
            }
        }
    }
}

/* Frames and map in one buffer: the map takes the place of rows while they are used for the last time. */
static void run_in_pair(const struct tsr_match_config *config)
{
    struct tsr_match match;
    memset(scratch, GUARD_BYTE, sizeof scratch);
    memset(got, GUARD_BYTE, sizeof got);
    uint8_t *pair = (uint8_t *)pair_room;
    struct tsr_gray views[2] = {tsr_match_pair_left(pair, config), tsr_match_pair_right(pair, config)};
    for (unsigned y = 0; y < config->height; y++) {
        for (unsigned which = 0; which < 2; which++) {
            memcpy(views[which].pixels + (size_t)y * views[which].stride, &scene[which][y * config->width],
                   config->width);
        }
    }
    size_t pixels = (size_t)config->width * config->height;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_match_start(&match, config, views[0], views[1], tsr_match_pair_map(pair), pixels,
                                              scratch + GUARD, tsr_match_scratch_len(config)));
    while (tsr_match_run(&match, (uint16_t)(1u + below(9))) == TSR_AGAIN) {
    }
    memcpy(got + GUARD, tsr_match_pair_map(pair), pixels * sizeof *got);
}

static void run(const struct tsr_match_config *config, unsigned stride, unsigned offset)
{
    struct tsr_match match;
    struct tsr_gray left = place(0, config->width, config->height, stride, offset);
    struct tsr_gray right = place(1, config->width, config->height, stride, offset);
    memset(scratch, GUARD_BYTE, sizeof scratch);
    memset(got, GUARD_BYTE, sizeof got);
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_match_start(&match, config, left, right, got + GUARD, (size_t)config->width * config->height,
                                      scratch + GUARD, tsr_match_scratch_len(config)));
    while (tsr_match_run(&match, (uint16_t)(1u + below(9))) == TSR_AGAIN) {
    }
}

static void print_number(const char *name, int value)
{
    UnityPrint(name);
    UnityPrintNumber(value);
}

static void print_case(const struct tsr_match_config *config, unsigned x, unsigned y, unsigned found, unsigned right)
{
    UnityPrint(tsr_match_kernel_name(config->kernel));
    print_number(" mode ", config->mode);
    print_number(" width ", config->width);
    print_number(" height ", config->height);
    print_number(" disparities ", config->disparities);
    print_number(" window ", config->window);
    print_number(" cap ", config->prefilter_cap);
    print_number(" start ", config->search_start_px);
    print_number(" x ", (int)x);
    print_number(" y ", (int)y);
    print_number(": ", (int)found);
    print_number(", not ", (int)right);
    UNITY_PRINT_EOL();
}

static void expect_wanted(const struct tsr_match_config *config, const char *where)
{
    for (size_t at = 0; at < (size_t)config->width * config->height; at++) {
        if (wanted[at] != got[GUARD + at]) {
            print_case(config, (unsigned)(at % config->width), (unsigned)(at / config->width), got[GUARD + at],
                       wanted[at]);
            TEST_FAIL_MESSAGE(where);
        }
    }
}

/* The right view filtered as another board does it, to the same map. */
static void compare_prefiltered(struct tsr_match_config config, unsigned stride, unsigned offset)
{
    static uint8_t gray[WIDTH_MAX * HEIGHT_MAX];
    static uint16_t filter_scratch[TSR_PREFILTER_SCRATCH_LEN(WIDTH_MAX) / 2];
    struct tsr_gray right = {scene[1], config.width, config.height, config.width};
    struct tsr_prefilter filter;
    memcpy(gray, scene[1], sizeof gray);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_prefilter_start(&filter, right, tsr_match_prefilter_cap(&config),
                                                  (uint8_t *)filter_scratch, sizeof filter_scratch));
    while (tsr_prefilter_run(&filter, (uint16_t)(1u + below(9))) == TSR_AGAIN) {
    }
    config.right_is_prefiltered = true;
    for (unsigned i = 0; tsr_match_kernel_at(i) != NULL; i++) {
        config.kernel = tsr_match_kernel_at(i);
        run(&config, stride, offset);
        expect_guards(&config, stride, offset);
        expect_wanted(&config, "differs with a prefiltered right view");
    }
    memcpy(scene[1], gray, sizeof gray);
}

static void compare(struct tsr_match_config config)
{
    unsigned stride = config.width + (below(3) == 0 ? 0 : below(10));
    unsigned offset = below(4);
    unsigned count = 0;
    while (tsr_match_kernel_at(count) != NULL) {
        count++;
    }
    for (unsigned i = count; i-- > 0;) {
        config.kernel = tsr_match_kernel_at(i);
        run(&config, stride, offset);
        expect_guards(&config, stride, offset);
        if (i == count - 1u) {
            memcpy(wanted, got + GUARD, sizeof *wanted * config.width * config.height);
        }
        expect_wanted(&config, "differs from the portable kernel");
        run_in_pair(&config);
        expect_wanted(&config, "differs in the pair layout");
    }
    if (config.mode <= TSR_MATCH_SAD8 && below(2) == 0) {
        compare_prefiltered(config, stride, offset);
    }
}

static void compare_contents(struct tsr_match_config config, unsigned turns)
{
    for (unsigned turn = 0; turn < turns; turn++) {
        int shift = config.search_start_px + (int)below(config.disparities);
        draw_scene(config.width, config.height, turns > 2u && turn < 2 ? 0 : below(5), shift);
        config.uniqueness_percent = (uint8_t)(below(4) == 0 ? TSR_MATCH_TEST_OFF : below(3) == 0 ? 1 + below(100) : 0);
        config.texture_min = (uint8_t)(below(3) == 0 ? TSR_MATCH_TEST_OFF : below(20));
        config.lr_tolerance_px = (uint8_t)(below(4) == 0 ? TSR_MATCH_TEST_OFF : below(4));
        compare(config);
    }
}

static void sweep(unsigned mode, unsigned window_max)
{
    for (unsigned window = 5; window <= window_max; window += 2) {
        for (unsigned disparities = 16; disparities <= 128; disparities += 8) {
            unsigned width = disparities + below(WIDTH_MAX - disparities + 1u);
            if (below(6) == 0) {
                width = disparities; /* all border */
            }
            unsigned height_min = mode == TSR_MATCH_SMOOTH && window < 7u ? 7u : window;
            struct tsr_match_config config = {.width = (uint16_t)width,
                                              .height = (uint16_t)(height_min + below(HEIGHT_MAX - height_min + 1u)),
                                              .disparities = (uint16_t)disparities,
                                              .window = (uint8_t)window,
                                              .mode = (uint8_t)mode};
            config.prefilter_cap = (uint8_t)(below(4) == 0 ? 1 : 0);
            if (width > disparities && below(3) == 0) {
                int start = (int)below(width - disparities + 1u);
                config.search_start_px = (int16_t)(below(2) == 0 ? -start : start);
            }
            compare_contents(config, SWEEP_CONTENTS);
        }
    }
}

static void test_sad_is_the_portable_one(void)
{
    sweep(TSR_MATCH_SAD, 15);
}

static void test_sad8_is_the_portable_one(void)
{
    sweep(TSR_MATCH_SAD8, 11);
}

static void test_census_is_the_portable_one(void)
{
    sweep(TSR_MATCH_CENSUS, 15);
}

static void test_smooth_is_the_portable_one(void)
{
    sweep(TSR_MATCH_SMOOTH, 15);
}

static void test_common_sizes(void)
{
    static const struct tsr_match_config configs[] = {
        {.width = 160, .height = 24, .disparities = 32},
        {.width = 160, .height = 24, .disparities = 48},
        {.width = 176, .height = 24, .disparities = 64},
        {.width = 170, .height = 20, .disparities = 128},
    };
    for (unsigned i = 0; i < sizeof configs / sizeof configs[0]; i++) {
        compare_contents(configs[i], 8);
    }
}

/* The left border with every distance between the first pixel that has a candidate and the image's border. */
static void test_search_starts(void)
{
    for (unsigned mode = TSR_MATCH_SAD; mode <= TSR_MATCH_SAD8; mode++) {
        for (unsigned window = 5; window <= (mode == TSR_MATCH_SAD ? 15u : 11u); window += 2) {
            for (int start = 0; start <= 18; start++) {
                struct tsr_match_config config = {.width = (uint16_t)(40u + below(5)),
                                                  .height = (uint16_t)(window + below(4)),
                                                  .disparities = (uint16_t)(start > 12 ? 16 : 24),
                                                  .window = (uint8_t)window,
                                                  .mode = (uint8_t)mode,
                                                  .search_start_px = (int16_t)start};
                compare_contents(config, 2);
            }
        }
    }
}

int main(void)
{
    const char *text = getenv("SEED");
    uint64_t seed = text != NULL ? strtoull(text, NULL, 10) : 1;
    state = seed;
    UNITY_BEGIN();
    print_number("replay: SEED=", (int)seed);
    for (unsigned i = 0; tsr_match_kernel_at(i) != NULL; i++) {
        UnityPrint(", ");
        UnityPrint(tsr_match_kernel_name(tsr_match_kernel_at(i)));
    }
    UNITY_PRINT_EOL();
    RUN_TEST(test_common_sizes);
    RUN_TEST(test_sad_is_the_portable_one);
    RUN_TEST(test_sad8_is_the_portable_one);
    RUN_TEST(test_census_is_the_portable_one);
    RUN_TEST(test_smooth_is_the_portable_one);
    RUN_TEST(test_search_starts);
    return UNITY_END();
}
