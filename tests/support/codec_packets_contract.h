/*
 * What packets of gray images, views and pictures promise alike, as unit tests: see codec_packets.h for what a test
 * defines; beside that
 *
 *   static struct PACKETS(info) info;   PACKETS_WIDTH x PACKETS_HEIGHT pixels, more than one packet of 60 bytes
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_PACKETS_CONTRACT_H
#define TSR_TESTS_CODEC_PACKETS_CONTRACT_H

#include "codec_packets.h"

#define PACKETS_WIDTH 41
#define PACKETS_HEIGHT 30
#define PACKETS_CAP 60
#define PACKETS_ID 5

static struct PACKETS(info) info;

static enum tsr_status start(size_t stride, uint8_t id)
{
    return PACKETS(packets_start)(&encoder, &info, image, stride, id);
}

static void test_start_refuses(void)
{
    const struct PACKETS(info) good = info;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, PACKETS(packets_start)(NULL, &info, image, PACKETS_WIDTH, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, PACKETS(packets_start)(&encoder, NULL, image, PACKETS_WIDTH, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, PACKETS(packets_start)(&encoder, &info, NULL, PACKETS_WIDTH, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, TSR_PACKET_ID_MAX + 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, start(PACKETS_WIDTH - 1, 0));
    info.width = 0;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
    info = good;
    info.height = TSR_IMAGE_HEIGHT_MAX + 1;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(PACKETS_WIDTH, 0));
    info = good;
    TEST_ASSERT_EQUAL(TSR_OK, start(PACKETS_WIDTH, TSR_PACKET_ID_MAX));
}

static void test_next_refuses(void)
{
    size_t len = 77;
    uint8_t out[PACKETS_CAP];
    TEST_ASSERT_EQUAL(TSR_OK, start(PACKETS_WIDTH, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, PACKETS(packets_next)(NULL, out, sizeof out, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, PACKETS(packets_next)(&encoder, NULL, sizeof out, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, PACKETS(packets_next)(&encoder, out, sizeof out, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, PACKETS(packets_next)(&encoder, out, TSR_PACKET_LEN_MIN - 1, &len));
    TEST_ASSERT_GREATER_THAN(1, send_all(&info, PACKETS_WIDTH, PACKETS_CAP, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, PACKETS(packets_next)(&encoder, out, sizeof out, &len));
    TEST_ASSERT_EQUAL(77, len);
}

/* 31..30 version   29..27 id   26 literal   25..17 count - 1   16..0 first, in groups. */
static void test_header_of_each_packet(void)
{
    const unsigned count = send_all(&info, PACKETS_WIDTH, PACKETS_CAP, PACKETS_ID);
    const unsigned group = PACKETS_UNITS(&info) == PACKETS_WIDTH * PACKETS_HEIGHT ? TSR_PACKET_GROUP_PX : 1u;
    uint32_t next = 0;
    receive_nothing();
    for (unsigned i = 0; i < count; i++) {
        const uint8_t *bytes = packets[i];
        const uint32_t word = bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
        const struct tsr_packet packet = receive(&info, PACKETS_WIDTH, PACKETS_ID, i);
        TEST_ASSERT_EQUAL(1, word >> 30);
        TEST_ASSERT_EQUAL(PACKETS_ID, word >> 27 & 7u);
        TEST_ASSERT_EQUAL(packet.is_literal, word >> 26 & 1u);
        TEST_ASSERT_EQUAL((packet.count + group - 1u) / group, (word >> 17 & 511u) + 1u);
        TEST_ASSERT_EQUAL(packet.first / group, word & 0x1fffu);
        TEST_ASSERT_EQUAL(next, packet.first);
        next += packet.count;
    }
    TEST_ASSERT_EQUAL(PACKETS_UNITS(&info), next);
    TEST_ASSERT_EQUAL(0, PACKETS_MISSING(&info, marks));
}

static void check_refused(enum tsr_status expected, uint8_t id, size_t len)
{
    struct tsr_packet packet = {.count = 77};
    receive_nothing();
    TEST_ASSERT_EQUAL(expected, receive_bytes(&info, PACKETS_WIDTH, id, packets[0], len, &packet));
    TEST_ASSERT_EQUAL(77, packet.count);
    TEST_ASSERT_EACH_EQUAL_HEX8(PACKETS_UNTOUCHED, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(PACKETS_UNITS(&info), PACKETS_MISSING(&info, marks));
}

static void test_packets_refused(void)
{
    (void)send_all(&info, PACKETS_WIDTH, PACKETS_CAP, PACKETS_ID);
    check_refused(TSR_ERR_NOREF, PACKETS_ID - 1, packet_lens[0]);
    for (size_t len = 0; len < TSR_PACKET_HEADER_LEN; len++) {
        check_refused(TSR_ERR_FORMAT, PACKETS_ID, len);
    }
    packets[0][3] ^= 0xc0; /* another version, and then another id too */
    check_refused(TSR_ERR_VERSION, PACKETS_ID, packet_lens[0]);
    check_refused(TSR_ERR_VERSION, PACKETS_ID - 1, packet_lens[0]);
    packets[0][3] ^= 0xc0;
    packets[0][1] |= 0x1f; /* begins beyond the image, and is of another one */
    check_refused(TSR_ERR_FORMAT, PACKETS_ID, packet_lens[0]);
    check_refused(TSR_ERR_FORMAT, PACKETS_ID - 1, packet_lens[0]);
    packets[0][1] &= 0xe0;
    packets[0][2] |= 0xfe; /* ends beyond it */
    packets[0][3] |= 0x03;
    check_refused(TSR_ERR_FORMAT, PACKETS_ID, packet_lens[0]);
}

static void test_decode_refuses(void)
{
    (void)send_all(&info, PACKETS_WIDTH, PACKETS_CAP, PACKETS_ID);
    const uint8_t *in = packets[0];
    const size_t len = packet_lens[0], cap = PACKETS_MARKS_LEN(PACKETS_WIDTH, PACKETS_HEIGHT), w = PACKETS_WIDTH;
    struct tsr_packet said;
    struct PACKETS(info) bad = info;
    receive_nothing();
    bad.height = 0;
#define DECODE PACKETS(packet_decode)
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(NULL, &info, PACKETS_ID, in, len, &said, decoded, w, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(&state, NULL, PACKETS_ID, in, len, &said, decoded, w, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(&state, &bad, PACKETS_ID, in, len, &said, decoded, w, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(&state, &info, PACKETS_ID, NULL, len, &said, decoded, w, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(&state, &info, PACKETS_ID, in, len, NULL, decoded, w, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(&state, &info, PACKETS_ID, in, len, &said, NULL, w, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, DECODE(&state, &info, PACKETS_ID, in, len, &said, decoded, w, NULL, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, DECODE(&state, &info, PACKETS_ID, in, len, &said, decoded, w - 1, marks, cap));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, DECODE(&state, &info, PACKETS_ID, in, len, &said, decoded, w, marks, cap - 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(PACKETS_UNTOUCHED, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_OK, DECODE(&state, &info, PACKETS_ID, in, len, &said, decoded, w, marks, cap));
#undef DECODE
    TEST_ASSERT_EQUAL(PACKETS_UNITS(&info) - said.count, PACKETS_MISSING(&info, marks));
}

#define PACKETS_RUN_CONTRACT()                                                                                         \
    do {                                                                                                               \
        RUN_TEST(test_start_refuses);                                                                                  \
        RUN_TEST(test_next_refuses);                                                                                   \
        RUN_TEST(test_header_of_each_packet);                                                                          \
        RUN_TEST(test_packets_refused);                                                                                \
        RUN_TEST(test_decode_refuses);                                                                                 \
    } while (0)

#endif
