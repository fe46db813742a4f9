/*
 * Gateway link framing: stuffing, capacities, damage, resynchronisation.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "codec_random.h"
#include "tsr/base/crc.h"
#include "tsr/wire/link.h"
#include "unity.h"

static uint8_t bytes[TSR_LINK_FRAME_MAX + 1];
static uint8_t body[TSR_LINK_BODY_MAX + 1];
static size_t len;
static struct tsr_link_decoder decoder;

void setUp(void)
{
    memset(bytes, 0xee, sizeof bytes);
    len = 777;
    tsr_link_decoder_init(&decoder);
}
void tearDown(void) {}

static size_t encode(const struct tsr_link_frame *frame)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_link_encode(frame, bytes, sizeof bytes, &len));
    return len;
}

/* Feed all bytes; exactly the last one completes the frame. */
static void expect_frame(const struct tsr_link_frame *expected)
{
    struct tsr_link_frame frame;
    for (size_t i = 0; i + 1 < len; i++) {
        TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_link_decode(&decoder, bytes[i], &frame));
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_link_decode(&decoder, bytes[len - 1], &frame));
    TEST_ASSERT_EQUAL(expected->type, frame.type);
    TEST_ASSERT_EQUAL_HEX16(expected->sequence, frame.sequence);
    TEST_ASSERT_EQUAL(expected->body_len, frame.body_len);
    if (frame.body_len > 0) {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected->body, frame.body, frame.body_len);
    }
}

static void test_octets(void)
{
    const uint8_t two[] = {0x7e, 0x7d};
    const struct tsr_link_frame frame = {TSR_LINK_UPLINK, 0x7d7e, two, sizeof two};
    const uint8_t content[] = {2, 0x7e, 0x7d, 0x7e, 0x7d};
    const uint8_t start[] = {0x7e, 2, 0x7d, 0x5e, 0x7d, 0x5d, 0x7d, 0x5e, 0x7d, 0x5d};
    const uint16_t fcs = (uint16_t)~tsr_crc16(TSR_CRC16_START_HDLC, content, sizeof content);
    encode(&frame);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(start, bytes, sizeof start);
    TEST_ASSERT_EQUAL_HEX8((uint8_t)fcs, bytes[sizeof start]); /* neither octet needs an escape here */
    TEST_ASSERT_EQUAL_HEX8(fcs >> 8, bytes[sizeof start + 1]);
    TEST_ASSERT_EQUAL_HEX8(0x7e, bytes[sizeof start + 2]);
    TEST_ASSERT_EQUAL(sizeof start + 3, len);
}

static void test_every_byte_everywhere(void)
{
    for (unsigned value = 0; value < 256; value++) {
        for (size_t body_len = 0; body_len < 4; body_len++) {
            memset(body, (int)value, body_len);
            const struct tsr_link_frame frame = {(uint8_t)(1 + value % 3), (uint16_t)(value * 257u), body, body_len};
            encode(&frame);
            for (size_t i = 1; i + 1 < len; i++) {
                TEST_ASSERT_TRUE(bytes[i] != 0x7e);
            }
            expect_frame(&frame);
        }
    }
    for (unsigned i = 0; i < 256; i++) {
        body[i] = (uint8_t)i;
    }
    const struct tsr_link_frame all = {TSR_LINK_ANSWER, 1, body, 256};
    encode(&all);
    expect_frame(&all);
    /* The sequence walks the FCS through values that need an escape. */
    for (unsigned sequence = 0; sequence < 0x10000u; sequence++) {
        const struct tsr_link_frame frame = {TSR_LINK_UPLINK, (uint16_t)sequence, body, 1};
        encode(&frame);
        expect_frame(&frame);
    }
    TEST_ASSERT_EQUAL(0, decoder.rejected);
}

static void test_longest_frame(void)
{
    memset(body, 0x7e, sizeof body);
    const struct tsr_link_frame frame = {TSR_LINK_ANSWER, 0x7e7e, body, TSR_LINK_BODY_MAX};
    encode(&frame);
    TEST_ASSERT_LESS_OR_EQUAL(TSR_LINK_FRAME_MAX, len);
    TEST_ASSERT_EQUAL_HEX8(0xee, bytes[TSR_LINK_FRAME_MAX]);
    expect_frame(&frame);
}

static void test_every_smaller_capacity(void)
{
    for (unsigned i = 0; i < 40; i++) {
        body[i] = (uint8_t)(0x7d + i % 2);
    }
    const struct tsr_link_frame frame = {TSR_LINK_UPLINK, 5, body, 40};
    const size_t whole = encode(&frame);
    for (size_t cap = 0; cap < whole; cap++) {
        memset(bytes, 0xee, sizeof bytes);
        len = 777;
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_link_encode(&frame, bytes, cap, &len));
        TEST_ASSERT_EQUAL(777, len);
        TEST_ASSERT_EQUAL_HEX8(0xee, bytes[cap]);
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_link_encode(&frame, bytes, whole, &len));
}

static void test_arguments(void)
{
    struct tsr_link_frame frame = {TSR_LINK_ANSWER, 0, body, TSR_LINK_BODY_MAX + 1};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_link_encode(&frame, bytes, sizeof bytes, &len));
    frame.body_len = 0;
    for (unsigned type = 0; type < 256; type++) {
        frame.type = (uint8_t)type;
        TEST_ASSERT_EQUAL(type >= 1 && type <= 3 ? TSR_OK : TSR_ERR_ARG,
                          tsr_link_encode(&frame, bytes, sizeof bytes, &len));
    }
}

static enum tsr_status feed(const uint8_t *fed, size_t fed_len)
{
    struct tsr_link_frame frame;
    enum tsr_status last = TSR_AGAIN;
    for (size_t i = 0; i < fed_len; i++) {
        last = tsr_link_decode(&decoder, fed[i], &frame);
    }
    return last;
}

/* Content with a right FCS, whatever it is. */
static void put_content(const uint8_t *content, size_t content_len)
{
    const uint16_t fcs = (uint16_t)~tsr_crc16(TSR_CRC16_START_HDLC, content, content_len);
    const uint8_t tail[2] = {(uint8_t)fcs, (uint8_t)(fcs >> 8)};
    len = 0;
    bytes[len++] = 0x7e;
    for (size_t i = 0; i < content_len + 2; i++) {
        const uint8_t byte = i < content_len ? content[i] : tail[i - content_len];
        if (byte == 0x7e || byte == 0x7d) {
            bytes[len++] = 0x7d;
        }
        bytes[len++] = (uint8_t)(byte == 0x7e || byte == 0x7d ? byte ^ 0x20 : byte);
    }
    bytes[len++] = 0x7e;
}

static void test_short_and_unknown_frames_are_rejected(void)
{
    uint8_t content[4] = {TSR_LINK_HELLO, 0, 0, 0};
    for (size_t content_len = 0; content_len < TSR_LINK_HEADER_LEN; content_len++) {
        put_content(content, content_len);
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, feed(bytes, len));
    }
    for (unsigned type = 0; type < 256; type++) {
        content[0] = (uint8_t)type;
        put_content(content, sizeof content);
        TEST_ASSERT_EQUAL(type >= 1 && type <= 3 ? TSR_OK : TSR_ERR_FORMAT, feed(bytes, len));
    }
    TEST_ASSERT_EQUAL(TSR_LINK_HEADER_LEN + 253, decoder.rejected);
    TEST_ASSERT_EQUAL(3, decoder.frames);
}

static void test_every_flipped_bit_is_rejected(void)
{
    const struct tsr_link_frame frame = {TSR_LINK_UPLINK, 0x1234, body, 30};
    memset(body, 0x55, 30);
    const size_t whole = encode(&frame);
    for (size_t bit = 8; bit < 8 * (whole - 1); bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        struct tsr_link_frame read;
        for (size_t i = 0; i < whole; i++) {
            TEST_ASSERT_TRUE(tsr_link_decode(&decoder, bytes[i], &read) != TSR_OK);
        }
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        TEST_ASSERT_EQUAL(TSR_OK, feed(bytes, whole)); /* and the next one is good again */
    }
}

/* Overlong content is dropped to its flag; the frame after it comes through. */
static void test_overrun(void)
{
    const struct tsr_link_frame frame = {TSR_LINK_ANSWER, 7, body, 3};
    const uint8_t flag = 0x7e;
    for (size_t extra = 1; extra < 2000; extra += 333) {
        const uint8_t filling = 0x11;
        feed(&flag, 1);
        for (size_t i = 0; i < TSR_LINK_CONTENT_MAX + 2 + extra; i++) {
            TEST_ASSERT_EQUAL(TSR_AGAIN, feed(&filling, 1));
        }
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, feed(&flag, 1));
        encode(&frame);
        expect_frame(&frame);
    }
}

static void test_garbage_between_frames(void)
{
    const struct tsr_link_frame frame = {TSR_LINK_UPLINK, 9, body, 10};
    for (uint32_t seed = 1; seed < 500; seed++) {
        struct codec_random random = codec_random_of_seed(seed);
        const size_t garbage_len = codec_random_below(&random, 700);
        for (size_t i = 0; i < garbage_len; i++) {
            const uint8_t garbage = (uint8_t)codec_random_next(&random);
            (void)feed(&garbage, 1);
        }
        const uint32_t frames = decoder.frames;
        encode(&frame);
        TEST_ASSERT_EQUAL(TSR_OK, feed(bytes, len));
        TEST_ASSERT_EQUAL(frames + 1, decoder.frames);
    }
}

/* RFC 1662, 4.3: an escape before the flag aborts the frame. */
static void test_escape_before_flag_aborts(void)
{
    const struct tsr_link_frame frame = {TSR_LINK_UPLINK, 9, body, 10};
    encode(&frame);
    bytes[len - 1] = 0x7d;
    bytes[len] = 0x7e;
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, feed(bytes, len + 1));
    const uint8_t flags[] = {0x7e, 0x7e, 0x7e};
    TEST_ASSERT_EQUAL(TSR_AGAIN, feed(flags, sizeof flags));
    TEST_ASSERT_EQUAL(1, decoder.rejected);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_octets);
    RUN_TEST(test_every_byte_everywhere);
    RUN_TEST(test_longest_frame);
    RUN_TEST(test_every_smaller_capacity);
    RUN_TEST(test_arguments);
    RUN_TEST(test_short_and_unknown_frames_are_rejected);
    RUN_TEST(test_every_flipped_bit_is_rejected);
    RUN_TEST(test_overrun);
    RUN_TEST(test_garbage_between_frames);
    RUN_TEST(test_escape_before_flag_aborts);
    return UNITY_END();
}
