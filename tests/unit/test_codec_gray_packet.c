/*
 * Packets of gray images: every status, header bytes, what is literal.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray_packet.h"

#define PACKETS(name) tsr_gray_##name
#define PACKETS_MARKS_LEN(width, height) TSR_PACKET_ARRIVED_LEN(width, height)
#define PACKETS_MISSING(info, marks) tsr_packets_missing(marks, (info)->width, (info)->height)
#define PACKETS_UNITS(info) ((uint32_t)(info)->width * (info)->height)
#include "codec_packets_contract.h"

void setUp(void)
{
    info = (struct tsr_gray_info){.width = PACKETS_WIDTH, .height = PACKETS_HEIGHT, .near = 0};
    for (unsigned i = 0; i < PACKETS_WIDTH * PACKETS_HEIGHT; i++) {
        image[i] = (uint8_t)(i % PACKETS_WIDTH * 3 + i / PACKETS_WIDTH * i / 90);
    }
}
void tearDown(void) {}

static void test_bad_info(void)
{
    info.near = TSR_GRAY_NEAR_BY_ACTIVITY + 1;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
}

/* The shortest packets hold a group of noise, long ones as many pixels as fit in 8 bits each, before the coder's end.
 */
static void test_noise_is_literal(void)
{
    struct codec_random random = codec_random_of_seed(1);
    for (unsigned i = 0; i < PACKETS_WIDTH * PACKETS_HEIGHT; i++) {
        image[i] = (uint8_t)codec_random_next(&random);
    }
    const unsigned count = send_all(&info, PACKETS_WIDTH, TSR_PACKET_LEN_MIN, 0);
    TEST_ASSERT_UINT_WITHIN(8, PACKETS_WIDTH * PACKETS_HEIGHT / 8, count);
    receive_nothing();
    TEST_ASSERT_EQUAL(8, receive(&info, PACKETS_WIDTH, 0, 0).count);
    (void)send_all(&info, PACKETS_WIDTH, PACKETS_CAP_MAX, 0);
    const struct tsr_packet packet = receive(&info, PACKETS_WIDTH, 0, 0);
    TEST_ASSERT_TRUE(packet.is_literal);
    TEST_ASSERT_EQUAL((PACKETS_CAP_MAX - TSR_PACKET_HEADER_LEN - TSR_RANGE_FINISH_LEN_MAX) / 8 * 8, packet.count);
    for (unsigned i = 0; i < packet.count; i++) {
        const unsigned at = i / 16 * PACKETS_WIDTH + i % 16;
        TEST_ASSERT_EQUAL(image[at], decoded[at]);
    }
}

/* A flat image: one pixel tells all of a packet, and 4096 are the most of one. */
static void test_flat_image(void)
{
    memset(image, 99, sizeof image);
    info.width = 160;
    info.height = 120;
    const unsigned count = send_all(&info, 160, PACKETS_CAP, 0);
    TEST_ASSERT_EQUAL((160 * 120 + 4095) / 4096, count);
    receive_nothing();
    TEST_ASSERT_EQUAL(4096, receive(&info, 160, 0, 0).count);
    TEST_ASSERT_FALSE(receive(&info, 160, 0, 0).is_literal);
}

static void test_missing_pixels(void)
{
    const uint8_t arrived[TSR_PACKET_ARRIVED_LEN(20, 5)] = {0x01, 0x12}; /* groups 0, 9 and 12, the last, of 4 pixels */
    TEST_ASSERT_EQUAL(0, tsr_packets_missing(NULL, 20, 5));
    TEST_ASSERT_EQUAL(100 - 8 - 8 - 4, tsr_packets_missing(arrived, 20, 5));
    TEST_ASSERT_TRUE(tsr_packets_have(arrived, 20, 5, 7, 0));
    TEST_ASSERT_FALSE(tsr_packets_have(arrived, 20, 5, 8, 0));
    TEST_ASSERT_TRUE(tsr_packets_have(arrived, 20, 5, 8, 4));   /* pixel 72 */
    TEST_ASSERT_FALSE(tsr_packets_have(arrived, 20, 5, 16, 0)); /* pixel 80, of the strip that is 4 wide */
    TEST_ASSERT_TRUE(tsr_packets_have(arrived, 20, 5, 16, 4));  /* pixel 96 */
}

int main(void)
{
    UNITY_BEGIN();
    PACKETS_RUN_CONTRACT();
    RUN_TEST(test_bad_info);
    RUN_TEST(test_noise_is_literal);
    RUN_TEST(test_flat_image);
    RUN_TEST(test_missing_pixels);
    return UNITY_END();
}
