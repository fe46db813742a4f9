/*
 * Packets of prefiltered views: every status, header bytes, what is literal.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/view_packet.h"

#define PACKETS(name) tsr_view_##name
#define PACKETS_MARKS_LEN(width, height) TSR_PACKET_ARRIVED_LEN(width, height)
#define PACKETS_MISSING(info, marks) tsr_packets_missing(marks, (info)->width, (info)->height)
#define PACKETS_UNITS(info) ((uint32_t)(info)->width * (info)->height)
#include "codec_packets_contract.h"

void setUp(void)
{
    info = (struct tsr_view_info){.width = PACKETS_WIDTH, .height = PACKETS_HEIGHT, .cap = 7, .coarse = true};
    for (unsigned i = 0; i < PACKETS_WIDTH * PACKETS_HEIGHT; i++) {
        image[i] = (uint8_t)((i % PACKETS_WIDTH * i / 70) % 15);
    }
}
void tearDown(void) {}

static void test_bad_info(void)
{
    struct tsr_packet packet;
    (void)send_all(&info, PACKETS_WIDTH, PACKETS_CAP, 0);
    info.against_held = true;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, receive_bytes(&info, PACKETS_WIDTH, 0, packets[0], packet_lens[0], &packet));
    info.against_held = false;
    info.cap = 6; /* not coarse then */
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
    info.coarse = false;
    TEST_ASSERT_EQUAL(TSR_OK, start(PACKETS_WIDTH, 0));
}

static void draw_noise(void)
{
    struct codec_random random = codec_random_of_seed(1);
    for (unsigned i = 0; i < PACKETS_WIDTH * PACKETS_HEIGHT; i++) {
        image[i] = (uint8_t)codec_random_below(&random, 15);
    }
}

/* A literal pixel has 4 bits. One that the decoder's view does not have counts as the nearest that it has: above 2 cap,
 * and between the levels of a coarse view. */
static void test_noise_is_literal(void)
{
    static const uint8_t coarse_of[15] = {0, 0, 3, 3, 5, 5, 6, 7, 8, 9, 9, 11, 11, 14, 14};
    draw_noise();
    for (unsigned kind = 0; kind < 3; kind++) {
        info.coarse = false;
        info.cap = 7;
        (void)send_all(&info, PACKETS_WIDTH, PACKETS_CAP_MAX, 0);
        info.coarse = kind == 1;
        info.cap = kind == 2 ? 3 : 7;
        receive_nothing();
        const struct tsr_packet packet = receive(&info, PACKETS_WIDTH, 0, 0);
        TEST_ASSERT_TRUE(packet.is_literal);
        TEST_ASSERT_EQUAL((PACKETS_CAP_MAX - TSR_PACKET_HEADER_LEN - TSR_RANGE_FINISH_LEN_MAX) * 2 / 8 * 8,
                          packet.count);
        for (unsigned i = 0; i < packet.count; i++) {
            const unsigned at = i / 16 * PACKETS_WIDTH + i % 16, cut = image[at] < 6 ? image[at] : 6;
            TEST_ASSERT_EQUAL(kind == 0 ? image[at] : kind == 1 ? coarse_of[image[at]] : cut, decoded[at]);
        }
    }
}

static void test_source_beyond_the_cap(void)
{
    info.coarse = false;
    info.cap = 3;
    receive_nothing();
    memset(image, 200, sizeof image);
    (void)send_all(&info, PACKETS_WIDTH, PACKETS_CAP, 0);
    (void)receive(&info, PACKETS_WIDTH, 0, 0);
    TEST_ASSERT_EACH_EQUAL_HEX8(6, decoded, 16);
}

int main(void)
{
    UNITY_BEGIN();
    PACKETS_RUN_CONTRACT();
    RUN_TEST(test_bad_info);
    RUN_TEST(test_noise_is_literal);
    RUN_TEST(test_source_beyond_the_cap);
    return UNITY_END();
}
