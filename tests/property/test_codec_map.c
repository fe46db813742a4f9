/*
 * Disparity-map codec: every map comes back, whatever its shape, content and
 * chunks of rows; the bytes do not depend on the chunks; no map, not even one
 * chosen against the model, outgrows tsr_map_encoded_len_max.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "codec_random.h"
#include "tsr/codec/map.h"
#include "unity.h"

#define WIDTH_MAX 320
#define HEIGHT_MAX 240
#define STRIDE_MAX (WIDTH_MAX + 7)

static uint16_t map[STRIDE_MAX * HEIGHT_MAX];
static uint16_t decoded[STRIDE_MAX * HEIGHT_MAX];
static uint16_t scratch[TSR_MAP_SCRATCH_COUNT(WIDTH_MAX)];
static uint8_t out[TSR_MAP_ENCODED_LEN_MAX(WIDTH_MAX, HEIGHT_MAX, 128, 0)];
static uint8_t out_of_chunks[sizeof out];
static struct tsr_map_encoder encoder;
static struct tsr_map_decoder decoder;
static const char *program;
static uint64_t seed;

void setUp(void)
{
    seed = 0;
}

void tearDown(void)
{
    if (Unity.CurrentTestFailed && seed != 0) {
        printf("failed; replay: SEED=%llu RUNS=1 %s\n", (unsigned long long)seed, program);
    }
}

enum content {
    CONTENT_INVALID,
    CONTENT_FLAT,
    CONTENT_CHECKER,
    CONTENT_NOISE,
    CONTENT_SLOPE,
    CONTENT_BLOCKS,
    CONTENT_EXTREMES,
    CONTENT_COUNT
};

static uint16_t pick(struct codec_random *random, const struct tsr_map_info *info, enum content content, unsigned x,
                     unsigned y)
{
    const unsigned steps = info->disparities * 16u >> info->step_log2;
    unsigned step = 0;
    switch (content) {
    case CONTENT_INVALID: return TSR_DISPARITY_INVALID;
    case CONTENT_FLAT: step = steps / 2; break;
    case CONTENT_CHECKER: step = (x + y) % 2 == 0 ? 0 : steps - 1; break;
    case CONTENT_NOISE: step = codec_random_below(random, steps); break;
    case CONTENT_SLOPE: step = (x * 3 + y + codec_random_below(random, 3)) / 4 % steps; break;
    case CONTENT_BLOCKS: step = ((x / 9) * 7 + (y / 5) * 11 + (codec_random_below(random, 9) == 0)) % steps; break;
    default: step = codec_random_below(random, 2) == 0 ? 0 : steps - 1; break;
    }
    if (content >= CONTENT_NOISE && codec_random_below(random, 8) == 0) {
        return TSR_DISPARITY_INVALID;
    }
    return (uint16_t)(step << info->step_log2);
}

static void draw(struct codec_random *random, const struct tsr_map_info *info, enum content content, size_t stride)
{
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            map[y * stride + x] = pick(random, info, content, x, y);
        }
    }
}

static size_t encode(struct codec_random *random, const struct tsr_map_info *info, size_t stride, uint8_t *bytes)
{
    const size_t cap = tsr_map_encoded_len_max(info);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_map_encode_start(&encoder, info, bytes, cap, scratch, TSR_MAP_SCRATCH_COUNT(info->width)));
    unsigned y = 0;
    while (y < info->height) {
        const unsigned left = info->height - y;
        const unsigned count = random == NULL ? left : codec_random_below(random, left + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_map_encode_rows(&encoder, map + y * stride, stride, (uint16_t)count));
        y += count;
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_OR_EQUAL(cap, len);
    return len;
}

static void check_decodes(struct codec_random *random, const struct tsr_map_info *info, size_t stride, size_t len)
{
    struct tsr_map_info read;
    memset(decoded, 0x5a, sizeof decoded);
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_map_decode_start(&decoder, out, len, NULL, scratch, TSR_MAP_SCRATCH_COUNT(info->width), &read));
    TEST_ASSERT_TRUE(read.width == info->width && read.height == info->height && read.d0_q4 == info->d0_q4 &&
                     read.disparities == info->disparities && read.step_log2 == info->step_log2);
    unsigned y = 0;
    while (y < info->height) {
        const unsigned count = codec_random_below(random, info->height - y + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_map_decode_rows(&decoder, decoded + y * stride, stride, (uint16_t)count));
        y += count;
    }
    for (y = 0; y < info->height; y++) {
        TEST_ASSERT_EQUAL_MEMORY(map + y * stride, decoded + y * stride, info->width * sizeof *map);
        for (size_t x = info->width; x < stride; x++) {
            TEST_ASSERT_EQUAL_HEX16(0x5a5a, decoded[y * stride + x]);
        }
    }
}

static void check_seed(void)
{
    struct codec_random random = codec_random_of_seed(seed);
    const bool large = codec_random_below(&random, 16) == 0;
    const struct tsr_map_info info = {
        .width = (uint16_t)(1 + codec_random_below(&random, large ? WIDTH_MAX : 40)),
        .height = (uint16_t)(1 + codec_random_below(&random, large ? HEIGHT_MAX : 30)),
        .disparities = (uint16_t)(1 + codec_random_below(&random, 128)),
        .step_log2 = (uint8_t)codec_random_below(&random, TSR_MAP_STEP_LOG2_MAX + 1),
        .d0_q4 = (int16_t)(codec_random_below(&random, 65536) - 32768),
    };
    const enum content content = (enum content)codec_random_below(&random, CONTENT_COUNT);
    const size_t stride = info.width + codec_random_below(&random, 8);
    draw(&random, &info, content, stride);
    const size_t len = encode(NULL, &info, stride, out);
    TEST_ASSERT_EQUAL(len, encode(&random, &info, stride, out_of_chunks));
    TEST_ASSERT_EQUAL_MEMORY(out, out_of_chunks, len);
    check_decodes(&random, &info, stride, len);
}

static void test_round_trip_of_random_maps(void)
{
    const uint64_t first = codec_setting("SEED", 1);
    const uint64_t end = first + codec_setting("RUNS", 1500);
    printf("replay all: SEED=%llu %s\n", (unsigned long long)first, program);
    for (seed = first; seed < end; seed++) {
        check_seed();
    }
}

/* Every small shape with every content. */
static void test_round_trip_of_small_shapes(void)
{
    struct codec_random random = codec_random_of_seed(1);
    for (unsigned shape = 0; shape < 9 * 5; shape++) {
        for (unsigned content = 0; content < CONTENT_COUNT; content++) {
            for (uint8_t step_log2 = 0; step_log2 <= TSR_MAP_STEP_LOG2_MAX; step_log2++) {
                const struct tsr_map_info info = {.width = (uint16_t)(1 + shape % 9),
                                                  .height = (uint16_t)(1 + shape / 9),
                                                  .disparities = 16,
                                                  .step_log2 = step_log2};
                draw(&random, &info, (enum content)content, info.width);
                check_decodes(&random, &info, info.width, encode(NULL, &info, info.width, out));
            }
        }
    }
}

/* Bytes that one more row would have cost. */
static size_t cost_of_row(const uint16_t *row, unsigned width)
{
    static struct tsr_map_encoder tried;
    static uint16_t tried_scratch[sizeof scratch / sizeof *scratch];
    tried = encoder;
    memcpy(tried_scratch, scratch, sizeof scratch);
    tried.model.scratch = tried_scratch;
    (void)tsr_map_encode_rows(&tried, row, width, 1);
    return tried.range.at;
}

/* Each row is the most expensive of many tried, and the result still fits. 63 px
 * give just under a power of two of labels, so literals are hardly longer than
 * noise must be, and the model's cost is above theirs. */
static void test_greedy_adversary_stays_below_the_bound(void)
{
    static uint16_t row[WIDTH_MAX], dearest[WIDTH_MAX];
    const uint8_t steps_log2[] = {0, 2, 4};
    for (unsigned i = 0; i < 3; i++) {
        struct codec_random random = codec_random_of_seed(i + 1);
        const struct tsr_map_info info = {.width = 160, .height = 120, .disparities = 63, .step_log2 = steps_log2[i]};
        const size_t cap = tsr_map_encoded_len_max(&info);
        size_t len = 0;
        TEST_ASSERT_EQUAL(TSR_OK,
                          tsr_map_encode_start(&encoder, &info, out, cap, scratch, TSR_MAP_SCRATCH_COUNT(info.width)));
        for (unsigned y = 0; y < info.height; y++) {
            size_t most = 0;
            for (unsigned attempt = 0; attempt < 24; attempt++) {
                for (unsigned x = 0; x < info.width; x++) {
                    const enum content content = (enum content)(attempt % CONTENT_COUNT);
                    row[x] = pick(&random, &info, content, x, y);
                    if (attempt % 2 == 0) {
                        row[x] = (uint16_t)(codec_random_below(&random, 63u * 16u >> info.step_log2) << info.step_log2);
                    }
                }
                const size_t cost = cost_of_row(row, info.width);
                if (cost > most) {
                    most = cost;
                    memcpy(dearest, row, sizeof row);
                }
            }
            TEST_ASSERT_GREATER_OR_EQUAL(0, tsr_map_encode_rows(&encoder, dearest, info.width, 1));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
        TEST_ASSERT_LESS_OR_EQUAL(cap, len);
        TEST_ASSERT_GREATER_THAN(cap - TSR_MAP_EXCESS_LEN, len);
        printf("step 2^%u/16: %zu of at most %zu bytes\n", steps_log2[i], len, cap);
    }
}

/* The largest map of the dearest labels: the rounding of literals adds up. */
static void test_largest_noise_stays_below_the_bound(void)
{
    static uint16_t row[TSR_IMAGE_WIDTH_MAX];
    static uint16_t wide_scratch[TSR_MAP_SCRATCH_COUNT(TSR_IMAGE_WIDTH_MAX)];
    static uint8_t large[TSR_MAP_ENCODED_LEN_MAX(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX, 127, 0)];
    const struct tsr_map_info info = {
        .width = TSR_IMAGE_WIDTH_MAX, .height = TSR_IMAGE_HEIGHT_MAX, .disparities = 127, .step_log2 = 0};
    struct codec_random random = codec_random_of_seed(5);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_start(&encoder, &info, large, sizeof large, wide_scratch,
                                                   TSR_MAP_SCRATCH_COUNT(info.width)));
    for (unsigned y = 0; y < info.height; y++) {
        for (unsigned x = 0; x < info.width; x++) {
            row[x] = (uint16_t)codec_random_below(&random, 127 * 16);
        }
        TEST_ASSERT_GREATER_OR_EQUAL(0, tsr_map_encode_rows(&encoder, row, info.width, 1));
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_OR_EQUAL(sizeof large, len);
    TEST_ASSERT_GREATER_THAN(sizeof large - TSR_MAP_EXCESS_LEN, len);
    printf("largest: %zu of at most %zu bytes\n", len, sizeof large);
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_round_trip_of_random_maps);
    RUN_TEST(test_round_trip_of_small_shapes);
    RUN_TEST(test_greedy_adversary_stays_below_the_bound);
    RUN_TEST(test_largest_noise_stays_below_the_bound);
    return UNITY_END();
}
