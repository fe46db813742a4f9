/*
 * Picture codec: bytes and pixels do not depend on the chunks of rows, no byte
 * outside the picture is written, damaged bytes decode to some picture, and no
 * picture outgrows tsr_picture_encoded_len_max.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "codec_content.h"
#include "codec_random.h"
#include "codec_seed.h"
#include "tsr/codec/picture.h"
#include "unity.h"

#define WIDTH_MAX 200
#define HEIGHT_MAX 150
#define STRIDE_MAX (WIDTH_MAX + 7)

static uint8_t image[STRIDE_MAX * HEIGHT_MAX];
static uint8_t decoded[STRIDE_MAX * HEIGHT_MAX];
static uint8_t decoded_at_once[WIDTH_MAX * HEIGHT_MAX];
static uint32_t target_len;
static uint8_t scratch[TSR_PICTURE_SCRATCH_LEN(WIDTH_MAX)];
static uint8_t out[TSR_PICTURE_ENCODED_LEN_MAX(WIDTH_MAX, HEIGHT_MAX)];
static uint8_t out_of_chunks[sizeof out];
static struct tsr_picture_encoder encoder;
static struct tsr_picture_decoder decoder;

void setUp(void) {}

static void draw(struct codec_random *random, const struct tsr_picture_info *info, enum content content, size_t stride)
{
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            image[y * stride + x] = pick(random, content, x, y);
        }
    }
}

static size_t encode(struct codec_random *random, const struct tsr_picture_info *info, const uint8_t *pixels,
                     size_t stride, uint8_t *bytes)
{
    const size_t cap = tsr_picture_encoded_len_max(info);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_start(&encoder, info, target_len, bytes, cap, scratch,
                                                       TSR_PICTURE_SCRATCH_LEN(info->width)));
    unsigned y = 0;
    while (y < info->height) {
        const unsigned left = info->height - y;
        const unsigned count = random == NULL ? left : codec_random_below(random, left + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_picture_encode_rows(&encoder, pixels + y * stride, stride, (uint16_t)count));
        y += count;
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_OR_EQUAL(cap, len);
    return len;
}

static void start_decoder(const struct tsr_picture_info *info, size_t len)
{
    struct tsr_picture_info read;
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_picture_decode_start(&decoder, out, len, scratch, TSR_PICTURE_SCRATCH_LEN(info->width), &read));
    TEST_ASSERT_TRUE(read.width == info->width && read.height == info->height && read.step == info->step &&
                     read.prior == info->prior);
}

/* Any len bytes after a valid header: the same pixels at once and in chunks, and nothing beside them. */
static void check_decodes(struct codec_random *random, const struct tsr_picture_info *info, size_t stride, size_t len)
{
    start_decoder(info, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_rows(&decoder, decoded_at_once, info->width, info->height));
    memset(decoded, 0x5a, sizeof decoded);
    memset(scratch, 0xa5, sizeof scratch);
    start_decoder(info, len);
    unsigned y = 0;
    while (y < info->height) {
        const unsigned count = codec_random_below(random, info->height - y + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_picture_decode_rows(&decoder, decoded + y * stride, stride, (uint16_t)count));
        y += count;
    }
    for (y = 0; y < info->height; y++) {
        TEST_ASSERT_EQUAL_MEMORY(decoded_at_once + y * info->width, decoded + y * stride, info->width);
        for (size_t x = info->width; x < stride; x++) {
            TEST_ASSERT_EQUAL_HEX8(0x5a, decoded[y * stride + x]);
        }
    }
}

/* Change, cut and lengthen the coded bytes. */
static void check_damaged(struct codec_random *random, const struct tsr_picture_info *info, size_t stride, size_t len)
{
    const size_t payload_len = len - TSR_PICTURE_HEADER_LEN;
    for (unsigned change = 0; change < 3 && payload_len > 0; change++) {
        const size_t at = TSR_PICTURE_HEADER_LEN + codec_random_below(random, (uint32_t)payload_len);
        out[at] = (uint8_t)codec_random_next(random);
        check_decodes(random, info, stride, len);
    }
    check_decodes(random, info, stride, TSR_PICTURE_HEADER_LEN + codec_random_below(random, (uint32_t)payload_len + 1));
    for (size_t at = len; at < sizeof out && at < len + 600; at++) {
        out[at] = (uint8_t)codec_random_next(random);
    }
    check_decodes(random, info, stride, len + 600 < sizeof out ? len + 600 : sizeof out);
}

static void check_seed(void)
{
    struct codec_random random = codec_random_of_seed(seed);
    const bool large = codec_random_below(&random, 16) == 0;
    const struct tsr_picture_info info = {
        .width = (uint16_t)(1 + codec_random_below(&random, large ? WIDTH_MAX : 40)),
        .height = (uint16_t)(1 + codec_random_below(&random, large ? HEIGHT_MAX : 30)),
        .step = (uint8_t)codec_random_below(&random, TSR_PICTURE_STEP_MAX + 1),
        .prior = (uint8_t)codec_random_below(&random, 2),
    };
    const size_t stride = info.width + codec_random_below(&random, 8);
    draw(&random, &info, (enum content)codec_random_below(&random, CONTENT_COUNT), stride);
    target_len = codec_random_below(&random, 2) * codec_random_below(&random, 1u + info.width * info.height / 2u);
    const size_t len = encode(NULL, &info, image, stride, out);
    TEST_ASSERT_EQUAL(len, encode(&random, &info, image, stride, out_of_chunks));
    TEST_ASSERT_EQUAL_MEMORY(out, out_of_chunks, len);
    check_decodes(&random, &info, stride, len);
    check_damaged(&random, &info, stride, len);
}

static void test_random_pictures(void)
{
    check_seeds(1500, check_seed);
}

static void test_small_shapes(void)
{
    struct codec_random random = codec_random_of_seed(1);
    target_len = 0;
    for (unsigned shape = 0; shape < 18 * 18; shape++) {
        for (unsigned content = 0; content < CONTENT_COUNT; content++) {
            const struct tsr_picture_info info = {.width = (uint16_t)(1 + shape % 18),
                                                  .height = (uint16_t)(1 + shape / 18),
                                                  .step = (uint8_t)((shape + 7 * content) % (TSR_PICTURE_STEP_MAX + 1)),
                                                  .prior = TSR_PICTURE_PRIOR_TRAINED};
            draw(&random, &info, (enum content)content, info.width);
            check_decodes(&random, &info, info.width, encode(NULL, &info, image, info.width, out));
        }
    }
}

/* The dearest pictures at the finest step: blocks beyond a byte a pixel are only predicted. */
static void test_noise_stays_below_the_bound(void)
{
    target_len = 0;
    for (unsigned prior = 0; prior <= 1; prior++) {
        for (unsigned content = 0; content < CONTENT_COUNT; content++) {
            struct codec_random random = codec_random_of_seed(content + 1u);
            const struct tsr_picture_info info = {.width = 160, .height = 120, .step = 0, .prior = (uint8_t)prior};
            draw(&random, &info, (enum content)content, info.width);
            const size_t len = encode(NULL, &info, image, info.width, out);
            printf("content %u: %zu of at most %zu bytes\n", content, len, tsr_picture_encoded_len_max(&info));
            check_decodes(&random, &info, info.width, len);
        }
    }
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_random_pictures);
    RUN_TEST(test_small_shapes);
    RUN_TEST(test_noise_stays_below_the_bound);
    return UNITY_END();
}
