/*
 * Gray-image codec: every image comes back within near, whatever its shape,
 * content and chunks of rows; the bytes do not depend on the chunks; no image
 * outgrows tsr_gray_encoded_len_max.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "codec_content.h"
#include "codec_random.h"
#include "codec_seed.h"
#include "tsr/codec/gray.h"
#include "unity.h"

#define WIDTH_MAX 320
#define HEIGHT_MAX 240
#define STRIDE_MAX (WIDTH_MAX + 7)

static uint8_t image[STRIDE_MAX * HEIGHT_MAX];
static uint8_t decoded[STRIDE_MAX * HEIGHT_MAX];
static uint8_t scratch[TSR_GRAY_SCRATCH_LEN(WIDTH_MAX)];
static uint8_t out[TSR_GRAY_ENCODED_LEN_MAX(WIDTH_MAX, HEIGHT_MAX)];
static uint8_t out_of_chunks[sizeof out];
static struct tsr_gray_encoder encoder;
static struct tsr_gray_decoder decoder;

void setUp(void) {}

static void draw(struct codec_random *random, const struct tsr_gray_info *info, enum content content, size_t stride)
{
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            image[y * stride + x] = pick(random, content, x, y);
        }
    }
}

static size_t encode(struct codec_random *random, const struct tsr_gray_info *info, const uint8_t *pixels,
                     size_t stride, uint8_t *bytes)
{
    const size_t cap = tsr_gray_encoded_len_max(info);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_gray_encode_start(&encoder, info, bytes, cap, scratch, TSR_GRAY_SCRATCH_LEN(info->width)));
    unsigned y = 0;
    while (y < info->height) {
        const unsigned left = info->height - y;
        const unsigned count = random == NULL ? left : codec_random_below(random, left + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_gray_encode_rows(&encoder, pixels + y * stride, stride, (uint16_t)count));
        y += count;
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_OR_EQUAL(cap, len);
    return len;
}

static void check_decodes(struct codec_random *random, const struct tsr_gray_info *info, size_t stride, size_t len)
{
    const unsigned error_max = info->near == TSR_GRAY_NEAR_BY_ACTIVITY ? TSR_GRAY_NEAR_BY_ACTIVITY_MAX : info->near;
    struct tsr_gray_info read;
    memset(decoded, 0x5a, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_gray_decode_start(&decoder, out, len, scratch, TSR_GRAY_SCRATCH_LEN(info->width), &read));
    TEST_ASSERT_TRUE(read.width == info->width && read.height == info->height && read.near == info->near);
    unsigned y = 0;
    while (y < info->height) {
        const unsigned count = codec_random_below(random, info->height - y + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_gray_decode_rows(&decoder, decoded + y * stride, stride, (uint16_t)count));
        y += count;
    }
    for (y = 0; y < info->height; y++) {
        for (size_t x = 0; x < info->width; x++) {
            TEST_ASSERT_INT_WITHIN(error_max, image[y * stride + x], decoded[y * stride + x]);
        }
        for (size_t x = info->width; x < stride; x++) {
            TEST_ASSERT_EQUAL_HEX8(0x5a, decoded[y * stride + x]);
        }
    }
}

static void check_seed(void)
{
    struct codec_random random = codec_random_of_seed(seed);
    const bool large = codec_random_below(&random, 16) == 0;
    const struct tsr_gray_info info = {
        .width = (uint16_t)(1 + codec_random_below(&random, large ? WIDTH_MAX : 40)),
        .height = (uint16_t)(1 + codec_random_below(&random, large ? HEIGHT_MAX : 30)),
        .near = (uint8_t)codec_random_below(&random, TSR_GRAY_NEAR_BY_ACTIVITY + 1),
    };
    const size_t stride = info.width + codec_random_below(&random, 8);
    draw(&random, &info, (enum content)codec_random_below(&random, CONTENT_COUNT), stride);
    const size_t len = encode(NULL, &info, image, stride, out);
    TEST_ASSERT_EQUAL(len, encode(&random, &info, image, stride, out_of_chunks));
    TEST_ASSERT_EQUAL_MEMORY(out, out_of_chunks, len);
    check_decodes(&random, &info, stride, len);
}

static void test_round_trip_of_random_images(void)
{
    check_seeds(1500, check_seed);
}

static void test_round_trip_of_small_shapes(void)
{
    struct codec_random random = codec_random_of_seed(1);
    for (unsigned shape = 0; shape < 9 * 5; shape++) {
        for (unsigned content = 0; content < CONTENT_COUNT; content++) {
            for (uint8_t near = 0; near <= TSR_GRAY_NEAR_BY_ACTIVITY; near++) {
                const struct tsr_gray_info info = {
                    .width = (uint16_t)(1 + shape % 9), .height = (uint16_t)(1 + shape / 9), .near = near};
                draw(&random, &info, (enum content)content, info.width);
                check_decodes(&random, &info, info.width, encode(NULL, &info, image, info.width, out));
            }
        }
    }
}

/* Bytes that one more row would have cost. */
static size_t cost_of_row(const uint8_t *row, unsigned width)
{
    static struct tsr_gray_encoder tried;
    static uint8_t tried_scratch[sizeof scratch];
    tried = encoder;
    memcpy(tried_scratch, scratch, sizeof scratch);
    tried.model.scratch = tried_scratch;
    (void)tsr_gray_encode_rows(&tried, row, width, 1);
    return tried.range.at;
}

/* Each row is the most expensive of many tried, and the result still fits. */
static void test_greedy_adversary_stays_below_the_bound(void)
{
    static uint8_t row[WIDTH_MAX], dearest[WIDTH_MAX];
    for (uint8_t near = 0; near <= TSR_GRAY_NEAR_MAX; near = (uint8_t)(near + 7)) {
        struct codec_random random = codec_random_of_seed(near + 1u);
        const struct tsr_gray_info info = {.width = 160, .height = 120, .near = near};
        const size_t cap = tsr_gray_encoded_len_max(&info);
        size_t len = 0;
        TEST_ASSERT_EQUAL(TSR_OK,
                          tsr_gray_encode_start(&encoder, &info, out, cap, scratch, TSR_GRAY_SCRATCH_LEN(info.width)));
        for (unsigned y = 0; y < info.height; y++) {
            size_t most = 0;
            for (unsigned attempt = 0; attempt < 24; attempt++) {
                for (unsigned x = 0; x < info.width; x++) {
                    const enum content content = (enum content)(attempt % CONTENT_COUNT);
                    row[x] = pick(&random, attempt % 2 == 0 ? CONTENT_NOISE : content, x, y);
                }
                const size_t cost = cost_of_row(row, info.width);
                if (cost > most) {
                    most = cost;
                    memcpy(dearest, row, sizeof row);
                }
            }
            TEST_ASSERT_GREATER_OR_EQUAL(0, tsr_gray_encode_rows(&encoder, dearest, info.width, 1));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_finish(&encoder, &len));
        TEST_ASSERT_LESS_OR_EQUAL(cap, len);
        printf("near %u: %zu of at most %zu bytes\n", near, len, cap);
    }
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_round_trip_of_random_images);
    RUN_TEST(test_round_trip_of_small_shapes);
    RUN_TEST(test_greedy_adversary_stays_below_the_bound);
    return UNITY_END();
}
