/*
 * Maps in packets: each decodes alone and in any order; what is lost loses its own pixels and no others; no packet
 * outgrows its size, whatever the map holds.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>
#include <string.h>

#include "codec_random.h"
#include "tsr/codec/map_packet.h"
#include "unity.h"

#define PIXELS_MAX (160u * 120u)
#define STRIDE_EXTRA 3u
#define PACKETS_MAX 8192u
#define PACKET_CAP_MAX 200u

static uint16_t map[PIXELS_MAX * 4u];
static uint16_t decoded[PIXELS_MAX * 4u];
static uint16_t scratch[TSR_MAP_PACKET_SCRATCH_COUNT];
static uint8_t packets[PACKETS_MAX][PACKET_CAP_MAX];
static size_t packet_lens[PACKETS_MAX];
static struct tsr_map_packet_encoder encoder;
static struct tsr_map_model model;
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

/* Patches of slopes, plain and noisy, with holes. */
static void draw(struct codec_random *random, const struct tsr_map_info *info, size_t stride, unsigned noise)
{
    const unsigned steps = info->disparities * 16u >> info->step_log2;
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            unsigned label = (x / 23u * 7u + y / 17u * 5u + (x + y) / 29u) % steps;
            if (codec_random_below(random, 100) < noise) {
                label = codec_random_below(random, steps);
            }
            const bool hole = (x / 11u + y / 7u) % 9u == 0 || codec_random_below(random, 100) < noise / 8u;
            map[y * stride + x] = hole ? TSR_DISPARITY_INVALID : (uint16_t)(label << info->step_log2);
        }
    }
}

static unsigned encode(const struct tsr_map_info *info, size_t stride, size_t cap, uint8_t map_id)
{
    unsigned count = 0;
    enum tsr_status status = TSR_AGAIN;
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_map_packets_start(&encoder, info, map, stride, map_id, scratch, TSR_MAP_PACKET_SCRATCH_COUNT));
    while (status == TSR_AGAIN) {
        TEST_ASSERT_LESS_THAN(PACKETS_MAX, count);
        memset(packets[count], 0xa5, PACKET_CAP_MAX);
        status = tsr_map_packets_next(&encoder, packets[count], cap, &packet_lens[count]);
        TEST_ASSERT_GREATER_OR_EQUAL(TSR_OK, status);
        TEST_ASSERT_LESS_OR_EQUAL(cap, packet_lens[count]);
        for (size_t i = cap; i < PACKET_CAP_MAX; i++) {
            TEST_ASSERT_EQUAL_HEX8(0xa5, packets[count][i]);
        }
        count++;
    }
    return count;
}

static struct tsr_map_packet decode(const struct tsr_map_info *info, size_t stride, unsigned i, uint8_t map_id)
{
    struct tsr_map_packet packet;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packet_decode(&model, info, map_id, packets[i], packet_lens[i], scratch,
                                                    TSR_MAP_PACKET_SCRATCH_COUNT, &packet, decoded, stride));
    return packet;
}

/* Pixels that differ by more than near steps, or in having a match; missing ones aside. */
static unsigned wrong_pixels(const struct tsr_map_info *info, size_t stride)
{
    unsigned wrong = 0;
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            const unsigned was = map[y * stride + x], is = decoded[y * stride + x];
            const unsigned away = was > is ? was - is : is - was;
            const bool valid = was != TSR_DISPARITY_INVALID && is != TSR_DISPARITY_INVALID;
            wrong +=
                is != TSR_MAP_PIXEL_MISSING && (valid ? away > (unsigned)info->near << info->step_log2 : was != is);
        }
    }
    return wrong;
}

static void check_one(struct codec_random *random)
{
    struct tsr_map_info info = {.width = (uint16_t)(1u + codec_random_below(random, 160)),
                                .height = (uint16_t)(1u + codec_random_below(random, 120)),
                                .disparities = (uint16_t)(1u + codec_random_below(random, 128)),
                                .step_log2 = (uint8_t)codec_random_below(random, TSR_MAP_STEP_LOG2_MAX + 1),
                                .near = (uint8_t)codec_random_below(random, TSR_MAP_NEAR_MAX + 1)};
    const size_t stride = info.width + codec_random_below(random, STRIDE_EXTRA);
    const size_t cap = TSR_MAP_PACKET_LEN_MIN + codec_random_below(random, PACKET_CAP_MAX - TSR_MAP_PACKET_LEN_MIN);
    const uint8_t map_id = (uint8_t)codec_random_below(random, TSR_MAP_PACKET_MAP_ID_MAX + 1);
    draw(random, &info, stride, codec_random_below(random, 3) == 0 ? 100 : codec_random_below(random, 20));
    const unsigned count = encode(&info, stride, cap, map_id);

    /* From the last to the first, each with a chance to be lost, or to come twice. */
    size_t expected_missing = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packets_clear(&info, decoded, stride));
    for (unsigned i = count; i > 0; i--) {
        const unsigned chance = codec_random_below(random, 8);
        if (chance == 0) {
            /* Told by its neighbours' positions. */
            struct tsr_map_packet lost, next = {.first = (uint32_t)info.width * info.height};
            static uint16_t elsewhere[PIXELS_MAX * 4u];
            TEST_ASSERT_EQUAL(TSR_OK,
                              tsr_map_packet_decode(&model, &info, map_id, packets[i - 1], packet_lens[i - 1], scratch,
                                                    TSR_MAP_PACKET_SCRATCH_COUNT, &lost, elsewhere, stride));
            if (i < count) {
                TEST_ASSERT_EQUAL(TSR_OK,
                                  tsr_map_packet_decode(&model, &info, map_id, packets[i], packet_lens[i], scratch,
                                                        TSR_MAP_PACKET_SCRATCH_COUNT, &next, elsewhere, stride));
            }
            TEST_ASSERT_EQUAL(next.first, lost.first + lost.count);
            expected_missing += lost.count;
            continue;
        }
        (void)decode(&info, stride, i - 1, map_id);
        if (chance == 1) {
            (void)decode(&info, stride, i - 1, map_id);
        }
    }
    TEST_ASSERT_EQUAL(expected_missing, tsr_map_packets_missing(&info, decoded, stride));
    TEST_ASSERT_EQUAL(0, wrong_pixels(&info, stride));
}

static void test_random_maps(void)
{
    const uint64_t first = codec_setting("SEED", 1);
    const uint64_t runs = codec_setting("RUNS", 150);
    for (seed = first; seed < first + runs; seed++) {
        struct codec_random random = codec_random_of_seed(seed);
        check_one(&random);
    }
    seed = 0;
}

static void test_damaged_packets(void)
{
    struct tsr_map_info info = {.width = 70, .height = 50, .disparities = 32, .step_log2 = 3};
    struct codec_random random = codec_random_of_seed(9);
    draw(&random, &info, info.width, 4);
    const unsigned count = encode(&info, info.width, 60, 2);
    for (unsigned run = 0; run < 4000; run++) {
        const unsigned i = codec_random_below(&random, count);
        struct tsr_map_packet packet = {.count = 0};
        uint8_t bytes[60];
        size_t len = codec_random_below(&random, (uint32_t)packet_lens[i] + 1);
        memcpy(bytes, packets[i], len);
        for (unsigned change = 0; change < 3 && len > 0; change++) {
            bytes[codec_random_below(&random, (uint32_t)len)] ^= (uint8_t)codec_random_next(&random);
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packets_clear(&info, decoded, info.width));
        const enum tsr_status status = tsr_map_packet_decode(
            &model, &info, 2, bytes, len, scratch, TSR_MAP_PACKET_SCRATCH_COUNT, &packet, decoded, info.width);
        TEST_ASSERT_TRUE(status == TSR_OK || status == TSR_ERR_FORMAT || status == TSR_ERR_VERSION ||
                         status == TSR_ERR_NOREF);
        TEST_ASSERT_EQUAL(70u * 50u - packet.count, tsr_map_packets_missing(&info, decoded, info.width));
    }
}

static void test_refusals(void)
{
    struct tsr_map_info info = {.width = 40, .height = 9, .disparities = 16, .step_log2 = 4};
    struct tsr_map_packet packet;
    size_t len = 77;
    struct codec_random random = codec_random_of_seed(3);
    draw(&random, &info, info.width, 0);
    const size_t cap = TSR_MAP_PACKET_SCRATCH_COUNT;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_start(NULL, &info, map, 40, 0, scratch, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_start(&encoder, NULL, map, 40, 0, scratch, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_start(&encoder, &info, NULL, 40, 0, scratch, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_start(&encoder, &info, map, 40, 8, scratch, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_start(&encoder, &info, map, 40, 0, NULL, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_packets_start(&encoder, &info, map, 39, 0, scratch, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_map_packets_start(&encoder, &info, map, 40, 0, scratch, cap - 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_packets_start(&encoder, &info, map, 40, 0, scratch, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_map_packets_next(&encoder, packets[0], TSR_MAP_PACKET_LEN_MIN - 1, &len));
    map[5] = 7;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_next(&encoder, packets[0], 90, &len));
    TEST_ASSERT_EQUAL(77, len);
    map[5] = 16;
    const unsigned count = encode(&info, 40, 90, 5);
    TEST_ASSERT_EQUAL(1, count);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_packets_next(&encoder, packets[1], 90, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, tsr_map_packet_decode(&model, &info, 4, packets[0], packet_lens[0], scratch, cap,
                                                           &packet, decoded, 40));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packet_decode(&model, &info, 8, packets[0], packet_lens[0], scratch, cap,
                                                         &packet, decoded, 40));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT,
                      tsr_map_packet_decode(&model, &info, 5, packets[0], 3, scratch, cap, &packet, decoded, 40));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_packet_decode(&model, &info, 5, packets[0], packet_lens[0], scratch, cap,
                                                          &packet, decoded, 39));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_map_packet_decode(&model, &info, 5, packets[0], packet_lens[0], scratch,
                                                           cap - 1, &packet, decoded, 40));
    info.height = 8; /* the packet ends eight pixels and more beyond this map */
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_map_packet_decode(&model, &info, 5, packets[0], packet_lens[0], scratch, cap,
                                                            &packet, decoded, 40));
    info.height = 9;
    packets[0][3] ^= 0xc0;
    TEST_ASSERT_EQUAL(TSR_ERR_VERSION, tsr_map_packet_decode(&model, &info, 5, packets[0], packet_lens[0], scratch, cap,
                                                             &packet, decoded, 40));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_packets_clear(NULL, decoded, 40));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_packets_clear(&info, decoded, 39));
    TEST_ASSERT_EQUAL(0, tsr_map_packets_missing(NULL, decoded, 40));
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_random_maps);
    RUN_TEST(test_damaged_packets);
    RUN_TEST(test_refusals);
    return UNITY_END();
}
