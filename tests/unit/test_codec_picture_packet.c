/*
 * Packets of pictures: every status, header bytes, blocks that are too dear, the filter.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/picture_packet.h"

#define PACKETS(name) tsr_picture_##name
#define PACKETS_MARKS_LEN(width, height) TSR_PICTURE_MARKS_LEN(width, height)
#define PACKETS_MISSING(info, marks) tsr_picture_packets_missing(info, marks)
#define PACKETS_UNITS(info) ((uint32_t)TSR_PICTURE_MARKS_LEN((info)->width, (info)->height))
#include "codec_packets_contract.h"

static uint8_t smoothed[sizeof decoded];

void setUp(void)
{
    info = (struct tsr_picture_info){
        .width = PACKETS_WIDTH, .height = PACKETS_HEIGHT, .step = 20, .prior = TSR_PICTURE_PRIOR_TRAINED};
    for (unsigned i = 0; i < PACKETS_WIDTH * PACKETS_HEIGHT; i++) {
        image[i] = (uint8_t)(i % PACKETS_WIDTH * 3 + i / PACKETS_WIDTH * i / 90);
    }
}
void tearDown(void) {}

static void draw_noise(void)
{
    struct codec_random random = codec_random_of_seed(1);
    for (unsigned i = 0; i < PACKETS_WIDTH * PACKETS_HEIGHT; i++) {
        image[i] = codec_random_below(&random, 2) != 0 ? 255 : 0;
    }
}

static void test_bad_info(void)
{
    info.prior = TSR_PICTURE_PRIOR_NONE;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
    info.prior = TSR_PICTURE_PRIOR_TRAINED;
    info.step = TSR_PICTURE_STEP_MAX + 1;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
}

/* At the finest step hardly a block of noise fits in 60 bytes: such a packet holds one, coarser, and says so. */
static void test_dear_blocks_are_coarser(void)
{
    draw_noise();
    info.step = 0;
    const unsigned count = send_all(&info, PACKETS_WIDTH, PACKETS_CAP, 0);
    TEST_ASSERT_LESS_OR_EQUAL(PACKETS_UNITS(&info), count);
    unsigned coarser = 0;
    receive_nothing();
    for (unsigned i = 0; i < count; i++) {
        const struct tsr_packet packet = receive(&info, PACKETS_WIDTH, 0, i);
        TEST_ASSERT_FALSE(packet.is_literal);
        coarser += packet.coarser > 0 ? 1u : 0u;
        TEST_ASSERT_EQUAL(packet.coarser, (packets[i][1] >> 5 | packets[i][2] << 3) & 15);
    }
    TEST_ASSERT_GREATER_THAN(count / 2, coarser);
    TEST_ASSERT_EQUAL(0, PACKETS_MISSING(&info, marks));
}

/* A literal block is a byte, its mean. */
static void test_literal_blocks(void)
{
    static const uint8_t bytes[] = {0x01, 0x00, 0x02, 0x44, 0x12, 0xef}; /* blocks 1 and 2 */
    struct tsr_packet packet;
    receive_nothing();
    TEST_ASSERT_EQUAL(TSR_OK, receive_bytes(&info, PACKETS_WIDTH, 0, bytes, sizeof bytes, &packet));
    TEST_ASSERT_TRUE(packet.is_literal);
    TEST_ASSERT_EQUAL(2, packet.count);
    for (unsigned y = 0; y < 8; y++) {
        TEST_ASSERT_EACH_EQUAL_HEX8(PACKETS_UNTOUCHED, decoded + y * PACKETS_WIDTH, 8);
        TEST_ASSERT_EACH_EQUAL_HEX8(0x12, decoded + y * PACKETS_WIDTH + 8, 8);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xef, decoded + y * PACKETS_WIDTH + 16, 8);
    }
    TEST_ASSERT_EQUAL(0, marks[0]);
    TEST_ASSERT_EQUAL(1 + 59, marks[1]);
    TEST_ASSERT_EQUAL(1 + 59, marks[2]);
    /* They pull at each other, by a quarter of their difference at most; the missing ones do not. */
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_picture_packets_smooth(&info, decoded, PACKETS_WIDTH, marks, smoothed, PACKETS_WIDTH));
    TEST_ASSERT_EQUAL_HEX8(PACKETS_UNTOUCHED, smoothed[7]);
    TEST_ASSERT_EQUAL_HEX8(0x12, smoothed[8]);
    TEST_ASSERT_EQUAL(0x12 + ((4 * 59 + 4) >> 3), smoothed[15]);
    TEST_ASSERT_EQUAL(0xef + ((-4 * 59 + 4) >> 3), smoothed[16]);
    TEST_ASSERT_EQUAL_HEX8(0xef, smoothed[17]);
}

static void test_smooth_refuses(void)
{
    const size_t w = PACKETS_WIDTH;
    receive_nothing();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_packets_smooth(NULL, decoded, w, marks, smoothed, w));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_packets_smooth(&info, NULL, w, marks, smoothed, w));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_packets_smooth(&info, decoded, w, NULL, smoothed, w));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_packets_smooth(&info, decoded, w, marks, NULL, w));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_packets_smooth(&info, decoded, w - 1, marks, smoothed, w));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_packets_smooth(&info, decoded, w, marks, smoothed, w - 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_packets_smooth(&info, decoded, w, marks, smoothed, w));
    TEST_ASSERT_EQUAL(0, tsr_picture_packets_missing(NULL, marks));
    TEST_ASSERT_EQUAL(0, tsr_picture_packets_missing(&info, NULL));
}

int main(void)
{
    UNITY_BEGIN();
    PACKETS_RUN_CONTRACT();
    RUN_TEST(test_bad_info);
    RUN_TEST(test_dear_blocks_are_coarser);
    RUN_TEST(test_literal_blocks);
    RUN_TEST(test_smooth_refuses);
    return UNITY_END();
}
