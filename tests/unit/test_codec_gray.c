/*
 * Gray-image codec: header bytes, every status, capacities, what errors leave untouched.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray.h"

#define FRAME_WIDTH 21
#define FRAME_HEIGHT 13
#define FRAME_HEADER_LEN TSR_GRAY_HEADER_LEN
#define FRAME_OUT_CAP TSR_GRAY_ENCODED_LEN_MAX(FRAME_WIDTH, FRAME_HEIGHT)
#define FRAME_SCRATCH_LEN TSR_GRAY_SCRATCH_LEN(FRAME_WIDTH)
#define FRAME(name) tsr_gray_##name
#define FRAME_ENCODE_START(encoder, info, out, out_cap, scratch, scratch_cap)                                          \
    tsr_gray_encode_start(encoder, info, out, out_cap, scratch, scratch_cap)
#define FRAME_DECODE_START(decoder, bytes, len, scratch, scratch_cap, info)                                            \
    tsr_gray_decode_start(decoder, bytes, len, scratch, scratch_cap, info)
#include "codec_frame.h"

void setUp(void)
{
    info = (struct tsr_gray_info){.width = FRAME_WIDTH, .height = FRAME_HEIGHT, .near = 0};
    for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
        const unsigned x = i % FRAME_WIDTH, y = i / FRAME_WIDTH;
        image[i] = (uint8_t)(x < 8 ? 250 + (x * y) % 6 : 10 * y + x * x / 4);
    }
    frame_set_up();
}
void tearDown(void) {}

static void test_round_trip_within_near(void)
{
    size_t shortest = FRAME_OUT_CAP;
    for (uint8_t near = 0; near <= TSR_GRAY_NEAR_BY_ACTIVITY; near++) {
        info.near = near;
        const size_t len = encode();
        TEST_ASSERT_LESS_THAN(shortest, len);
        shortest = near == 0 ? len : shortest;
        TEST_ASSERT_EQUAL(near, decode(len).near);
        for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
            TEST_ASSERT_INT_WITHIN(near == TSR_GRAY_NEAR_BY_ACTIVITY ? TSR_GRAY_NEAR_BY_ACTIVITY_MAX : near, image[i],
                                   decoded[i]);
        }
    }
}

static void test_header_bytes(void)
{
    info.near = 4;
    (void)encode();
    const uint8_t header[TSR_GRAY_HEADER_LEN] = {0x01, 0x04, FRAME_WIDTH, 0, FRAME_HEIGHT, 0};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(header, out, TSR_GRAY_HEADER_LEN);
}

static void test_start_refuses_bad_info(void)
{
    info.near = TSR_GRAY_NEAR_BY_ACTIVITY + 1;
    check_bad_info();
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x11);
    check_header_refused(TSR_ERR_VERSION, 1, 0x10);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x09);
}

int main(void)
{
    UNITY_BEGIN();
    FRAME_RUN_CONTRACT();
    RUN_TEST(test_round_trip_within_near);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_header_refused);
    return UNITY_END();
}
