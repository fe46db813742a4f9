/*
 * Prefiltered-view codec: every sequence of views comes back, whatever its
 * shape, cap, content, tiles and chunks of rows; both sides hold the same; the
 * bytes do not depend on the chunks; no view outgrows tsr_view_encoded_len_max.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "codec_random.h"
#include "codec_seed.h"
#include "tsr/codec/view.h"
#include "unity.h"

#define WIDTH_MAX 320
#define HEIGHT_MAX 240
#define STRIDE_MAX (WIDTH_MAX + 7)
#define VIEWS 3 /* of a sequence */

static uint8_t view[STRIDE_MAX * HEIGHT_MAX];
static uint8_t decoded[STRIDE_MAX * HEIGHT_MAX];
static uint8_t before[WIDTH_MAX * HEIGHT_MAX];
static uint8_t scratch[TSR_VIEW_SCRATCH_LEN(WIDTH_MAX)];
static uint8_t tiles[TSR_VIEW_TILE_COUNT(WIDTH_MAX, HEIGHT_MAX)];
static uint8_t out[TSR_VIEW_ENCODED_LEN_MAX(WIDTH_MAX, HEIGHT_MAX)];
static uint8_t out_of_chunks[sizeof out];
static uint8_t packed[3][TSR_VIEW_HELD_LEN(WIDTH_MAX, HEIGHT_MAX)];
static struct tsr_view_held held[3]; /* of two encoders and the decoder */
static struct tsr_view_encoder encoder;
static struct tsr_view_decoder decoder;

void setUp(void)
{
    for (unsigned i = 0; i < 3; i++) {
        held[i] = (struct tsr_view_held){.packed = packed[i], .packed_cap = sizeof packed[i]};
    }
}

enum content {
    CONTENT_FLAT,
    CONTENT_CHECKER,
    CONTENT_NOISE,
    CONTENT_WAVE,
    CONTENT_EXTREMES,
    CONTENT_COUNT
};

static uint8_t pick(struct codec_random *random, enum content content, unsigned x, unsigned y)
{
    switch (content) {
    case CONTENT_FLAT: return 7;
    case CONTENT_CHECKER: return (x + y) % 2 == 0 ? 0 : 14;
    case CONTENT_NOISE: return (uint8_t)codec_random_below(random, 16);
    case CONTENT_WAVE: return (uint8_t)((x * x / 16 + y / 4) % 13 + codec_random_below(random, 3));
    default: return codec_random_below(random, 2) == 0 ? 0 : 255;
    }
}

static void draw(struct codec_random *random, const struct tsr_view_info *info, enum content content, size_t stride)
{
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            view[y * stride + x] = pick(random, content, x, y);
        }
    }
}

static size_t encode(struct codec_random *random, const struct tsr_view_info *info, struct tsr_view_held *mine,
                     size_t stride, uint8_t *bytes)
{
    const size_t cap = tsr_view_encoded_len_max(info);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_start(&encoder, info, mine, tiles, bytes, cap, scratch,
                                                    TSR_VIEW_SCRATCH_LEN(info->width)));
    unsigned y = 0;
    while (y < info->height) {
        const unsigned left = info->height - y;
        const unsigned count = random == NULL ? left : codec_random_below(random, left + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_view_encode_rows(&encoder, view + y * stride, stride, (uint16_t)count));
        y += count;
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_OR_EQUAL(cap, len);
    return len;
}

static uint8_t wanted(const struct tsr_view_info *info, size_t stride, unsigned x, unsigned y)
{
    static const uint8_t coarse[15] = {0, 0, 3, 3, 5, 5, 6, 7, 8, 9, 9, 11, 11, 14, 14};
    if (info->against_held && tiles[y / 8 * TSR_VIEW_TILES_ACROSS(info->width) + x / 8] == 0) {
        return before[(size_t)y * info->width + x];
    }
    const uint8_t pixel = view[y * stride + x];
    const uint8_t cut = pixel < 2 * info->cap ? pixel : (uint8_t)(2 * info->cap);
    return info->coarse ? coarse[cut] : cut;
}

static void check_decodes(struct codec_random *random, const struct tsr_view_info *info, size_t stride, size_t len)
{
    struct tsr_view_info read;
    memset(decoded, 0x5a, sizeof decoded);
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_view_decode_start(&decoder, out, len, &held[2], scratch, TSR_VIEW_SCRATCH_LEN(info->width), &read));
    TEST_ASSERT_TRUE(read.width == info->width && read.height == info->height && read.cap == info->cap &&
                     read.coarse == info->coarse && read.against_held == info->against_held);
    unsigned y = 0;
    while (y < info->height) {
        const unsigned count = codec_random_below(random, info->height - y + 1);
        const enum tsr_status expected = y + count < info->height ? TSR_AGAIN : TSR_OK;
        TEST_ASSERT_EQUAL(expected, tsr_view_decode_rows(&decoder, decoded + y * stride, stride, (uint16_t)count));
        y += count;
    }
    for (y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            TEST_ASSERT_EQUAL(wanted(info, stride, x, y), decoded[y * stride + x]);
        }
        for (size_t x = info->width; x < stride; x++) {
            TEST_ASSERT_EQUAL_HEX8(0x5a, decoded[y * stride + x]);
        }
    }
    for (y = 0; y < info->height; y++) {
        memcpy(before + (size_t)y * info->width, decoded + y * stride, info->width);
    }
}

static void check_held(const struct tsr_view_info *info)
{
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(held[i].full);
        TEST_ASSERT_EQUAL_HEX16(held[2].check, held[i].check);
        TEST_ASSERT_EQUAL_MEMORY(packed[2], packed[i], TSR_VIEW_HELD_LEN(info->width, info->height));
    }
}

static void check_seed(void)
{
    struct codec_random random = codec_random_of_seed(seed);
    const bool large = codec_random_below(&random, 16) == 0;
    struct tsr_view_info info = {
        .width = (uint16_t)(1 + codec_random_below(&random, large ? WIDTH_MAX : 40)),
        .height = (uint16_t)(1 + codec_random_below(&random, large ? HEIGHT_MAX : 30)),
        .cap = (uint8_t)(codec_random_below(&random, 2) == 0 ? 7 : 1 + codec_random_below(&random, 7)),
    };
    info.coarse = info.cap == 7 && codec_random_below(&random, 3) != 0;
    const size_t stride = info.width + codec_random_below(&random, 8);
    for (unsigned turn = 0; turn < VIEWS; turn++) {
        const unsigned share = codec_random_below(&random, 5);
        for (size_t i = 0; i < sizeof tiles; i++) {
            tiles[i] = codec_random_below(&random, 4) < share ? 1 : 0;
        }
        info.against_held = turn > 0;
        draw(&random, &info, (enum content)codec_random_below(&random, CONTENT_COUNT), stride);
        const size_t len = encode(NULL, &info, &held[0], stride, out);
        TEST_ASSERT_EQUAL(len, encode(&random, &info, &held[1], stride, out_of_chunks));
        TEST_ASSERT_EQUAL_MEMORY(out, out_of_chunks, len);
        check_decodes(&random, &info, stride, len);
        check_held(&info);
    }
}

static void test_sequences_of_random_views(void)
{
    check_seeds(1000, check_seed);
}

static void test_small_shapes(void)
{
    struct codec_random random = codec_random_of_seed(1);
    for (unsigned shape = 0; shape < 18 * 9; shape++) {
        for (unsigned content = 0; content < CONTENT_COUNT; content++) {
            struct tsr_view_info info = {.width = (uint16_t)(1 + shape % 18),
                                         .height = (uint16_t)(1 + shape / 18),
                                         .cap = (uint8_t)(1 + (shape + content) % 7)};
            info.coarse = info.cap == 7;
            draw(&random, &info, (enum content)content, info.width);
            check_decodes(&random, &info, info.width, encode(NULL, &info, &held[0], info.width, out));
        }
    }
}

/* Bytes that one more row would have cost. */
static size_t cost_of_row(const uint8_t *row, unsigned width)
{
    static struct tsr_view_encoder tried;
    static uint8_t tried_scratch[sizeof scratch];
    static uint8_t tried_packed[sizeof packed[0]];
    static struct tsr_view_held tried_held;
    tried = encoder;
    tried_held = held[0];
    tried_held.packed = tried_packed;
    memcpy(tried_scratch, scratch, sizeof scratch);
    tried.model.scratch = tried_scratch;
    tried.model.held = &tried_held;
    (void)tsr_view_encode_rows(&tried, row, width, 1);
    return tried.range.at;
}

/* Each row is the most expensive of many tried, tiles are noise, and the result still fits. */
static void test_greedy_adversary_stays_below_the_bound(void)
{
    static uint8_t row[WIDTH_MAX], dearest[WIDTH_MAX];
    for (unsigned turn = 0; turn < 4; turn++) {
        struct codec_random random = codec_random_of_seed(turn + 1u);
        const struct tsr_view_info info = {
            .width = 160, .height = 120, .cap = 7, .coarse = turn % 2 != 0, .against_held = turn >= 2};
        const size_t cap = tsr_view_encoded_len_max(&info);
        size_t len = 0;
        for (size_t i = 0; i < sizeof tiles; i++) {
            tiles[i] = codec_random_below(&random, 8) > 0 ? 1 : 0;
        }
        held[0].info = info;
        held[0].full = true;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_start(&encoder, &info, &held[0], tiles, out, cap, scratch,
                                                        TSR_VIEW_SCRATCH_LEN(info.width)));
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
            TEST_ASSERT_GREATER_OR_EQUAL(0, tsr_view_encode_rows(&encoder, dearest, info.width, 1));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
        TEST_ASSERT_LESS_OR_EQUAL(cap, len);
        printf("%s, %s: %zu of at most %zu bytes\n", info.coarse ? "coarse" : "exact",
               info.against_held ? "against held" : "on its own", len, cap);
    }
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_sequences_of_random_views);
    RUN_TEST(test_small_shapes);
    RUN_TEST(test_greedy_adversary_stays_below_the_bound);
    return UNITY_END();
}
