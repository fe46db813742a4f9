/*
 * Gray images against held ones: every sequence comes back, whatever its shape, near, content, tiles and chunks of
 * rows; both sides hold the same; no image outgrows tsr_gray_history_encoded_len_max; damaged bytes decode to some
 * image.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "codec_content.h"
#include "codec_random.h"
#include "codec_seed.h"
#include "tsr/codec/gray_history.h"
#include "unity.h"

#define WIDTH_MAX 160
#define HEIGHT_MAX 120
#define IMAGES 3 /* of a sequence */

static uint8_t image[WIDTH_MAX * HEIGHT_MAX];
static uint8_t decoded[WIDTH_MAX * HEIGHT_MAX];
static uint8_t pixels[2][WIDTH_MAX * HEIGHT_MAX], before[WIDTH_MAX * HEIGHT_MAX];
static struct tsr_gray_held held[2]; /* of the encoder and the decoder */
static uint8_t scratch[TSR_GRAY_HISTORY_SCRATCH_LEN(WIDTH_MAX)];
static uint8_t tiles[TSR_VIEW_TILE_COUNT(WIDTH_MAX, HEIGHT_MAX)];
static uint8_t out[TSR_GRAY_HISTORY_ENCODED_LEN_MAX(WIDTH_MAX, HEIGHT_MAX)];
static struct tsr_gray_history_encoder encoder;
static struct tsr_gray_history_decoder decoder;

void setUp(void)
{
    for (unsigned i = 0; i < 2; i++) {
        held[i] = (struct tsr_gray_held){.pixels = pixels[i], .pixels_cap = sizeof pixels[i]};
    }
}

static size_t encode(struct codec_random *random, const struct tsr_gray_history_info *info)
{
    const size_t cap = tsr_gray_history_encoded_len_max(info);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_encode_start(&encoder, info, &held[0], tiles, out, cap, scratch,
                                                            TSR_GRAY_HISTORY_SCRATCH_LEN(info->width)));
    for (unsigned y = 0; y < info->height;) {
        const unsigned count = codec_random_below(random, info->height - y + 1u);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_gray_history_encode_rows(&encoder, image + (size_t)y * info->width, info->width,
                                                                 (uint16_t)count));
        y += count;
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_OR_EQUAL(cap, len);
    return len;
}

static void decode(struct codec_random *random, const struct tsr_gray_history_info *info, size_t len)
{
    struct tsr_gray_history_info read;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_decode_start(&decoder, out, len, &held[1], scratch,
                                                            TSR_GRAY_HISTORY_SCRATCH_LEN(info->width), &read));
    TEST_ASSERT_TRUE(read.width == info->width && read.height == info->height && read.near == info->near &&
                     read.against_held == info->against_held);
    for (unsigned y = 0; y < info->height;) {
        const unsigned count = codec_random_below(random, info->height - y + 1u);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_gray_history_decode_rows(&decoder, decoded + (size_t)y * info->width,
                                                                 info->width, (uint16_t)count));
        y += count;
    }
}

static void check_image(const struct tsr_gray_history_info *info)
{
    const unsigned error_max = info->near == TSR_GRAY_NEAR_BY_ACTIVITY ? TSR_GRAY_NEAR_BY_ACTIVITY_MAX : info->near;
    const size_t count = (size_t)info->width * info->height;
    for (size_t i = 0; i < count; i++) {
        const size_t tile = i / info->width / 8 * TSR_VIEW_TILES_ACROSS(info->width) + i % info->width / 8;
        const bool kept = info->against_held && tiles[tile] == 0;
        TEST_ASSERT_INT_WITHIN(kept ? 0 : error_max, kept ? before[i] : image[i], decoded[i]);
    }
    TEST_ASSERT_TRUE(held[0].full && held[1].full);
    TEST_ASSERT_EQUAL_HEX16(held[0].check, held[1].check);
    TEST_ASSERT_EQUAL_MEMORY(pixels[0], pixels[1], count);
    TEST_ASSERT_EQUAL_MEMORY(pixels[0], decoded, count);
    memcpy(before, decoded, count);
}

static void check_seed(void)
{
    struct codec_random random = codec_random_of_seed(seed);
    const bool large = codec_random_below(&random, 16) == 0;
    struct tsr_gray_history_info info = {
        .width = (uint16_t)(1 + codec_random_below(&random, large ? WIDTH_MAX : 40)),
        .height = (uint16_t)(1 + codec_random_below(&random, large ? HEIGHT_MAX : 30)),
        .near = (uint8_t)codec_random_below(&random, TSR_GRAY_NEAR_BY_ACTIVITY + 1),
    };
    for (unsigned turn = 0; turn < IMAGES; turn++) {
        const enum content content = (enum content)codec_random_below(&random, CONTENT_COUNT);
        const unsigned share = codec_random_below(&random, 5);
        for (size_t i = 0; i < sizeof tiles; i++) {
            tiles[i] = codec_random_below(&random, 4) < share ? 1 : 0;
        }
        for (unsigned i = 0; i < (unsigned)info.width * info.height; i++) {
            image[i] = pick(&random, content, i % info.width, i / info.width);
        }
        info.against_held = turn > 0;
        const size_t len = encode(&random, &info);
        decode(&random, &info, len);
        check_image(&info);
    }
}

static void test_sequences_of_random_images(void)
{
    check_seeds(800, check_seed);
}

/* Noise in every tile of a held image: the dearest there is. */
static void test_noise_stays_below_the_bound(void)
{
    struct codec_random random = codec_random_of_seed(3);
    struct tsr_gray_history_info info = {.width = WIDTH_MAX, .height = HEIGHT_MAX};
    for (unsigned turn = 0; turn < 3; turn++) {
        for (size_t i = 0; i < sizeof tiles; i++) {
            tiles[i] = turn == 1 || codec_random_below(&random, 2) != 0;
        }
        for (size_t i = 0; i < sizeof image; i++) {
            image[i] = (uint8_t)codec_random_next(&random);
        }
        info.against_held = turn > 0;
        decode(&random, &info, encode(&random, &info));
        check_image(&info);
    }
}

static void test_damaged_bytes(void)
{
    struct codec_random random = codec_random_of_seed(4);
    struct tsr_gray_history_info info = {.width = 45, .height = 37, .near = 2}, read;
    static uint8_t bytes[sizeof out];
    memset(tiles, 1, sizeof tiles);
    for (size_t i = 0; i < 45 * 37; i++) {
        image[i] = pick(&random, CONTENT_SLOPE, (unsigned)(i % 45), (unsigned)(i / 45));
    }
    decode(&random, &info, encode(&random, &info));
    info.against_held = true;
    const size_t len = encode(&random, &info);
    for (unsigned run = 0; run < 2000; run++) {
        memcpy(bytes, out, len);
        for (unsigned change = 0; change < 3; change++) {
            bytes[TSR_GRAY_HISTORY_HEADER_LEN_MAX + codec_random_below(&random, (uint32_t)len - 8u)] ^=
                (uint8_t)codec_random_next(&random);
        }
        held[1].full = true;
        held[1].check = (uint16_t)(out[6] | out[7] << 8);
        TEST_ASSERT_EQUAL(TSR_OK,
                          tsr_gray_history_decode_start(&decoder, bytes, 8 + codec_random_below(&random, len - 7),
                                                        &held[1], scratch, sizeof scratch, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_decode_rows(&decoder, decoded, 45, 37));
    }
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_sequences_of_random_images);
    RUN_TEST(test_noise_stays_below_the_bound);
    RUN_TEST(test_damaged_bytes);
    return UNITY_END();
}
