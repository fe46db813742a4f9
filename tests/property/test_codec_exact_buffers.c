/*
 * Every codec with buffers of exactly the promised sizes, each a block of its own, so that a sanitizer sees the first
 * byte too far: scratch, the longest output, streams, packets, rows without what follows the last pixel. Shapes and
 * contents are the extremes; random ones are in each codec's own tests.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <string.h>

#include "codec_random.h"
#include "tsr/codec/gray_history.h"
#include "tsr/codec/gray_packet.h"
#include "tsr/codec/map_packet.h"
#include "tsr/codec/map_restore.h"
#include "tsr/codec/picture_packet.h"
#include "tsr/codec/view_packet.h"
#include "unity.h"

#define GAP 3u /* between rows: stride - width */
#define SHORTEST TSR_PACKET_LEN_MIN
#define BLOCKS_MAX 16u

struct shape {
    uint16_t width, height;
};

static const struct shape shapes[] = {{1, 1},  {1, 480}, {640, 1},  {2, 3},  {17, 9},
                                      {40, 8}, {41, 33}, {640, 17}, {7, 480}};

enum content {
    ZERO,
    LARGEST,
    CHECKERS,
    NOISE,
    EXTREMES,
    CONTENT_COUNT
};

static void *blocks[BLOCKS_MAX];
static unsigned block_count;
static struct codec_random random_source;

void setUp(void)
{
    random_source = codec_random_of_seed(1);
}
void tearDown(void) {}

static void *block(size_t len)
{
    TEST_ASSERT_LESS_THAN(BLOCKS_MAX, block_count);
    blocks[block_count] = malloc(len);
    TEST_ASSERT_NOT_NULL(blocks[block_count]);
    return blocks[block_count++];
}

static void free_blocks(void)
{
    while (block_count > 0) {
        free(blocks[--block_count]);
    }
}

/* The stream alone, without the rest of its buffer. */
static uint8_t *cut(const uint8_t *bytes, size_t len)
{
    return memcpy(block(len), bytes, len);
}

static size_t span_of(struct shape shape)
{
    return (size_t)(shape.height - 1u) * (shape.width + GAP) + shape.width;
}

static unsigned value_of(enum content content, size_t i, unsigned largest)
{
    switch (content) {
    case ZERO: return 0;
    case LARGEST: return largest;
    case CHECKERS: return i % 2u * largest;
    case NOISE: return codec_random_below(&random_source, largest + 1u);
    default: return codec_random_below(&random_source, 2) * largest;
    }
}

static uint8_t *pixels_of(struct shape shape, enum content content, unsigned largest)
{
    uint8_t *pixels = block(span_of(shape));
    for (size_t i = 0; i < span_of(shape); i++) {
        pixels[i] = (uint8_t)value_of(content, i, largest);
    }
    return pixels;
}

static void for_all(void (*check)(struct shape shape, enum content content))
{
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        for (unsigned content = 0; content < CONTENT_COUNT; content++) {
            check(shapes[i], (enum content)content);
            free_blocks();
        }
    }
}

/* The largest value stands for no match. */
static uint16_t *map_of(const struct tsr_map_info *info, enum content content)
{
    const struct shape shape = {info->width, info->height};
    const unsigned labels = info->disparities * 16u >> info->step_log2;
    uint16_t *map = block(span_of(shape) * sizeof *map);
    for (size_t i = 0; i < span_of(shape); i++) {
        const unsigned label = value_of(content, i, labels);
        map[i] = (uint16_t)(label == labels ? TSR_DISPARITY_INVALID : label << info->step_log2);
    }
    return map;
}

static void check_map(struct shape shape, enum content content)
{
    static struct tsr_map_encoder encoder;
    static struct tsr_map_decoder decoder;
    const size_t stride = shape.width + GAP, scratch_count = TSR_MAP_SCRATCH_COUNT(shape.width);
    struct tsr_map_info info = {.width = shape.width, .height = shape.height, .disparities = 128}, read;
    size_t len = 0;
    const size_t cap = tsr_map_encoded_len_max(&info);
    const uint16_t *map = map_of(&info, content);
    const struct tsr_map_reference reference = {map_of(&info, NOISE), stride, 7};
    uint16_t *scratch = block(scratch_count * sizeof *scratch), *out = block(span_of(shape) * sizeof *out);
    uint8_t *bytes = block(cap);
    for (unsigned against = 0; against < 2; against++) {
        TEST_ASSERT_EQUAL(TSR_OK, against ? tsr_map_encode_start_against(&encoder, &info, &reference, bytes, cap,
                                                                         scratch, scratch_count)
                                          : tsr_map_encode_start(&encoder, &info, bytes, cap, scratch, scratch_count));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_rows(&encoder, map, stride, shape.height));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
        TEST_ASSERT_EQUAL(
            TSR_OK, tsr_map_decode_start(&decoder, cut(bytes, len), len, &reference, scratch, scratch_count, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_rows(&decoder, out, stride, shape.height));
        TEST_ASSERT_EQUAL(map[span_of(shape) - 1u], out[span_of(shape) - 1u]);
    }
}

static void check_map_packets(struct shape shape, enum content content)
{
    static struct tsr_map_packet_encoder encoder;
    static struct tsr_map_model model;
    const size_t stride = shape.width + GAP, pixels = (size_t)shape.width * shape.height;
    const struct tsr_map_info info = {.width = shape.width, .height = shape.height, .disparities = 128};
    const size_t restore_count = TSR_MAP_RESTORE_SCRATCH_COUNT(shape.width, shape.height);
    struct tsr_map_packet packet;
    enum tsr_status status = TSR_AGAIN;
    uint16_t *scratch = block(TSR_MAP_PACKET_SCRATCH_COUNT * sizeof *scratch);
    uint16_t *out = block(span_of(shape) * sizeof *out);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packets_start(&encoder, &info, map_of(&info, content), stride, 0, scratch,
                                                    TSR_MAP_PACKET_SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packets_clear(&info, out, stride));
    uint8_t *bytes = block(SHORTEST);
    for (const unsigned kept = block_count; status == TSR_AGAIN; free(blocks[--block_count])) {
        size_t len = 0;
        TEST_ASSERT_EQUAL(kept, block_count);
        status = tsr_map_packets_next(&encoder, bytes, SHORTEST, &len);
        TEST_ASSERT_GREATER_OR_EQUAL(TSR_OK, status);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packet_decode(&model, &info, 0, cut(bytes, len), len, scratch,
                                                        TSR_MAP_PACKET_SCRATCH_COUNT, &packet, out, stride));
    }
    TEST_ASSERT_EQUAL(0, tsr_map_packets_missing(&info, out, stride));
    uint16_t *whole = block(pixels * sizeof *whole);
    for (unsigned y = 0; y < shape.height; y++) {
        memcpy(whole + (size_t)y * shape.width, out + y * stride, shape.width * sizeof *out);
    }
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_map_restore(&info, whole, pixels, block(restore_count * sizeof *whole), restore_count));
}

/* Twice: on its own, and against itself with every tile coded. */
static void check_gray_history(struct shape shape, enum content content)
{
    static struct tsr_gray_history_encoder encoder;
    static struct tsr_gray_history_decoder decoder;
    const size_t stride = shape.width + GAP, pixels = (size_t)shape.width * shape.height;
    const size_t scratch_len = TSR_GRAY_HISTORY_SCRATCH_LEN(shape.width);
    const size_t tile_count = TSR_VIEW_TILE_COUNT(shape.width, shape.height);
    struct tsr_gray_history_info info = {shape.width, shape.height, 0, false}, read;
    struct tsr_gray_held sent = {.pixels = block(pixels), .pixels_cap = pixels}, got = sent;
    struct tsr_view_change change = {.tiles = block(tile_count), .tiles_cap = tile_count};
    const size_t cap = tsr_gray_history_encoded_len_max(&info);
    const uint8_t *image = pixels_of(shape, content, 255);
    uint8_t *scratch = block(scratch_len), *out = block(span_of(shape)), *bytes = block(cap);
    got.pixels = block(pixels);
    for (unsigned turn = 0; turn < 2; turn++) {
        size_t len = 0;
        info.against_held = turn == 1;
        if (info.against_held) {
            TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_compare(&sent, image, stride, 0, shape.height, &change));
            memset(change.tiles, 1, tile_count);
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_encode_start(&encoder, &info, &sent, change.tiles, bytes, cap,
                                                                scratch, scratch_len));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_encode_rows(&encoder, image, stride, shape.height));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_encode_finish(&encoder, &len));
        TEST_ASSERT_EQUAL(
            TSR_OK, tsr_gray_history_decode_start(&decoder, cut(bytes, len), len, &got, scratch, scratch_len, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_decode_rows(&decoder, out, stride, shape.height));
        TEST_ASSERT_EQUAL_MEMORY(sent.pixels, got.pixels, pixels);
        TEST_ASSERT_EQUAL(image[span_of(shape) - 1u], out[span_of(shape) - 1u]);
    }
}

static void check_view(struct shape shape, enum content content)
{
    static struct tsr_view_encoder encoder;
    static struct tsr_view_decoder decoder;
    const size_t stride = shape.width + GAP, scratch_len = TSR_VIEW_SCRATCH_LEN(shape.width);
    const size_t held_len = TSR_VIEW_HELD_LEN(shape.width, shape.height);
    const size_t tile_count = TSR_VIEW_TILE_COUNT(shape.width, shape.height);
    struct tsr_view_info info = {shape.width, shape.height, TSR_VIEW_CAP_MAX, false, false}, read;
    struct tsr_view_held sent = {.packed = block(held_len), .packed_cap = held_len}, got = sent;
    struct tsr_view_change change = {.tiles = block(tile_count), .tiles_cap = tile_count};
    const size_t cap = tsr_view_encoded_len_max(&info);
    const uint8_t *view = pixels_of(shape, content, 2u * TSR_VIEW_CAP_MAX);
    uint8_t *scratch = block(scratch_len), *out = block(span_of(shape)), *bytes = block(cap);
    got.packed = block(held_len);
    for (unsigned turn = 0; turn < 2; turn++) {
        size_t len = 0;
        info.against_held = turn == 1;
        if (info.against_held) {
            TEST_ASSERT_EQUAL(TSR_OK, tsr_view_compare(&sent, view, stride, 0, shape.height, &change));
            memset(change.tiles, 1, tile_count);
        }
        TEST_ASSERT_EQUAL(
            TSR_OK, tsr_view_encode_start(&encoder, &info, &sent, change.tiles, bytes, cap, scratch, scratch_len));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, view, stride, shape.height));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
        TEST_ASSERT_EQUAL(TSR_OK,
                          tsr_view_decode_start(&decoder, cut(bytes, len), len, &got, scratch, scratch_len, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_rows(&decoder, out, stride, shape.height));
        TEST_ASSERT_EQUAL_MEMORY(sent.packed, got.packed, held_len);
        TEST_ASSERT_EQUAL(view[span_of(shape) - 1u], out[span_of(shape) - 1u]);
    }
}

static void check_picture(struct shape shape, enum content content)
{
    static struct tsr_picture_encoder encoder;
    static struct tsr_picture_decoder decoder;
    const size_t stride = shape.width + GAP, scratch_len = TSR_PICTURE_SCRATCH_LEN(shape.width);
    struct tsr_picture_info info = {shape.width, shape.height, 0, TSR_PICTURE_PRIOR_TRAINED}, read;
    const size_t cap = tsr_picture_encoded_len_max(&info);
    const uint8_t *picture = pixels_of(shape, content, 255);
    uint8_t *scratch = block(scratch_len), *out = block(span_of(shape)), *bytes = block(cap);
    for (info.step = 0; info.step <= TSR_PICTURE_STEP_MAX; info.step = (uint8_t)(info.step + TSR_PICTURE_STEP_MAX)) {
        size_t len = 0;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_start(&encoder, &info, 0, bytes, cap, scratch, scratch_len));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_rows(&encoder, picture, stride, shape.height));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&encoder, &len));
        TEST_ASSERT_EQUAL(TSR_OK,
                          tsr_picture_decode_start(&decoder, cut(bytes, len), len, scratch, scratch_len, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_rows(&decoder, out, stride, shape.height));
    }
}

/* Each packet goes from an encoder to a decoder, from and into blocks of its length. */
#define SEND_PACKETS(codec, info, from, unit_marks, unit_marks_len)                                                    \
    do {                                                                                                               \
        static struct tsr_##codec##_packet_encoder encoder;                                                            \
        static struct tsr_##codec##_packet_state state;                                                                \
        struct tsr_packet packet;                                                                                      \
        enum tsr_status status = TSR_AGAIN;                                                                            \
        TEST_ASSERT_EQUAL(TSR_OK, tsr_##codec##_packets_start(&encoder, info, from, stride, 0));                       \
        for (; status == TSR_AGAIN; free(blocks[--block_count])) {                                                     \
            size_t len = 0;                                                                                            \
            status = tsr_##codec##_packets_next(&encoder, bytes, SHORTEST, &len);                                      \
            TEST_ASSERT_GREATER_OR_EQUAL(TSR_OK, status);                                                              \
            TEST_ASSERT_EQUAL(TSR_OK, tsr_##codec##_packet_decode(&state, info, 0, cut(bytes, len), len, &packet, out, \
                                                                  stride, unit_marks, unit_marks_len));                \
        }                                                                                                              \
    } while (0)

static void check_image_packets(struct shape shape, enum content content)
{
    const size_t stride = shape.width + GAP, arrived_len = TSR_PACKET_ARRIVED_LEN(shape.width, shape.height);
    const size_t marks_len = TSR_PICTURE_MARKS_LEN(shape.width, shape.height);
    const struct tsr_gray_info gray = {shape.width, shape.height, 0};
    const struct tsr_view_info view = {shape.width, shape.height, TSR_VIEW_CAP_MAX, true, false};
    const struct tsr_picture_info picture = {shape.width, shape.height, 0, TSR_PICTURE_PRIOR_TRAINED};
    const uint8_t *image = pixels_of(shape, content, 255);
    uint8_t *bytes = block(SHORTEST), *out = block(span_of(shape));
    uint8_t *arrived = block(arrived_len), *marks = block(marks_len);
    memset(arrived, 0, arrived_len);
    SEND_PACKETS(gray, &gray, image, arrived, arrived_len);
    TEST_ASSERT_EQUAL(0, tsr_packets_missing(arrived, shape.width, shape.height));
    TEST_ASSERT_EQUAL(image[span_of(shape) - 1u], out[span_of(shape) - 1u]);
    memset(arrived, 0, arrived_len);
    SEND_PACKETS(view, &view, image, arrived, arrived_len);
    TEST_ASSERT_EQUAL(0, tsr_packets_missing(arrived, shape.width, shape.height));
    memset(marks, 0, marks_len);
    SEND_PACKETS(picture, &picture, image, marks, marks_len);
    TEST_ASSERT_EQUAL(0, tsr_picture_packets_missing(&picture, marks));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_packets_smooth(&picture, out, stride, marks, block(span_of(shape)), stride));
}

static void test_maps(void)
{
    for_all(check_map);
}
static void test_map_packets(void)
{
    for_all(check_map_packets);
}
static void test_gray_history(void)
{
    for_all(check_gray_history);
}
static void test_views(void)
{
    for_all(check_view);
}
static void test_pictures(void)
{
    for_all(check_picture);
}
static void test_image_packets(void)
{
    for_all(check_image_packets);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_maps);
    RUN_TEST(test_map_packets);
    RUN_TEST(test_gray_history);
    RUN_TEST(test_views);
    RUN_TEST(test_pictures);
    RUN_TEST(test_image_packets);
    return UNITY_END();
}
