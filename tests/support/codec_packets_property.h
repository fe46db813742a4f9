/*
 * Packets of random images, for property tests of any of the codecs: see codec_packets.h for what a test defines;
 * beside that
 *
 *   static struct PACKETS(info) draw_info(struct codec_random *random);   at most PACKETS_WIDTH_MAX x
 * PACKETS_HEIGHT_MAX static uint8_t draw_pixel(struct codec_random *random, unsigned content, unsigned x, unsigned y);
 *   static unsigned expect(const struct PACKETS(info) *info, size_t stride, uint8_t id, unsigned count);
 *                                                       fills expected[], of count packets; gives the largest error
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_PACKETS_PROPERTY_H
#define TSR_TESTS_CODEC_PACKETS_PROPERTY_H

#include "codec_packets.h"
#include "codec_seed.h"

#define PACKETS_RUNS 250

static uint8_t expected[sizeof image];

void setUp(void) {}

static struct PACKETS(info) draw_info(struct codec_random *random);
static uint8_t draw_pixel(struct codec_random *random, unsigned content, unsigned x, unsigned y);
static unsigned expect(const struct PACKETS(info) * info, size_t stride, uint8_t id, unsigned count);

static void draw_image(struct codec_random *random, const struct PACKETS(info) * info, size_t stride)
{
    const unsigned content = codec_random_below(random, 16);
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            image[y * stride + x] = draw_pixel(random, content, x, y);
        }
    }
}

/* What has come is right, the rest of the array is as it was. */
static void check_image(const struct PACKETS(info) * info, size_t stride, unsigned error_max)
{
    for (size_t y = 0; y < info->height; y++) {
        for (size_t x = 0; x < stride; x++) {
            if (x < info->width && PACKETS_HAVE(info, marks, (uint16_t)x, (uint16_t)y)) {
                TEST_ASSERT_INT_WITHIN(error_max, expected[y * stride + x], decoded[y * stride + x]);
            } else {
                TEST_ASSERT_EQUAL_HEX8(PACKETS_UNTOUCHED, decoded[y * stride + x]);
            }
        }
    }
}

/* In any order, each with a chance to be lost, or to come twice. */
static void check_seed(void)
{
    static unsigned order[PACKETS_COUNT_MAX];
    struct codec_random random = codec_random_of_seed(seed);
    const struct PACKETS(info) info = draw_info(&random);
    const size_t stride = info.width + codec_random_below(&random, 7);
    const size_t cap = TSR_PACKET_LEN_MIN + codec_random_below(&random, PACKETS_CAP_MAX - TSR_PACKET_LEN_MIN);
    const uint8_t id = (uint8_t)codec_random_below(&random, TSR_PACKET_ID_MAX + 1);
    draw_image(&random, &info, stride);
    const unsigned count = send_all(&info, stride, cap, id);
    const unsigned error_max = expect(&info, stride, id, count);
    receive_nothing();
    for (unsigned i = 0; i < count; i++) {
        const unsigned other = codec_random_below(&random, i + 1);
        order[i] = order[other];
        order[other] = i;
    }
    size_t arrived = 0;
    for (unsigned i = 0; i < count; i++) {
        for (unsigned chance = codec_random_below(&random, 8); chance > 0; chance = chance == 7 ? 1 : 0) {
            const struct tsr_packet packet = receive(&info, stride, id, order[i]);
            arrived += chance == 7 ? 0 : packet.count;
        }
    }
    TEST_ASSERT_EQUAL(PACKETS_UNITS(&info) - arrived, PACKETS_MISSING(&info, marks));
    check_image(&info, stride, error_max);
}

static void test_random_images(void)
{
    check_seeds(PACKETS_RUNS, check_seed);
}

/* Whatever comes has a named status and touches its own units only. */
static void test_damaged_packets(void)
{
    struct codec_random random = codec_random_of_seed(9);
    struct PACKETS(info) info = draw_info(&random);
    info.width = 70;
    info.height = 50;
    draw_image(&random, &info, info.width);
    const unsigned count = send_all(&info, info.width, 60, 2);
    for (unsigned run = 0; run < 3000; run++) {
        const unsigned i = codec_random_below(&random, count);
        struct tsr_packet packet = {.count = 0};
        uint8_t bytes[60];
        const size_t len = codec_random_below(&random, (uint32_t)packet_lens[i] + 1);
        memcpy(bytes, packets[i], len);
        for (unsigned change = 0; change < 3 && len > 0; change++) {
            bytes[codec_random_below(&random, (uint32_t)len)] ^= (uint8_t)codec_random_next(&random);
        }
        receive_nothing();
        const enum tsr_status status = receive_bytes(&info, info.width, 2, bytes, len, &packet);
        TEST_ASSERT_TRUE(status == TSR_OK || status == TSR_ERR_FORMAT || status == TSR_ERR_VERSION ||
                         status == TSR_ERR_NOREF);
        TEST_ASSERT_EQUAL(PACKETS_UNITS(&info) - packet.count, PACKETS_MISSING(&info, marks));
        for (unsigned at = 0; at < sizeof decoded; at++) {
            const unsigned x = at % info.width, y = at / info.width;
            if (y >= info.height || !PACKETS_HAVE(&info, marks, (uint16_t)x, (uint16_t)y)) {
                TEST_ASSERT_EQUAL_HEX8(PACKETS_UNTOUCHED, decoded[at]);
            }
        }
    }
}

#endif
