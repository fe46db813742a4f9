/*
 * Fragments and their reassembly: cutting, every field out of range, any order,
 * repetitions, contradictions.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "codec_random.h"
#include "tsr/wire/fragment.h"
#include "unity.h"

#define PIECE TSR_FRAGMENT_PIECE_MAX
#define MESSAGE_MAX ((size_t)TSR_FRAGMENT_COUNT_MAX * PIECE)

static uint8_t message[MESSAGE_MAX];
static uint8_t room[MESSAGE_MAX];
static uint8_t bytes[TSR_FRAME_PAYLOAD_MAX + 1];
static size_t len;

void setUp(void)
{
    for (size_t i = 0; i < sizeof message; i++) {
        message[i] = (uint8_t)(i * 31 + (i >> 8));
    }
    memset(bytes, 0xee, sizeof bytes);
    len = 777;
}
void tearDown(void) {}

static struct tsr_fragment piece_of(size_t message_len, uint16_t index)
{
    struct tsr_fragment fragment = tsr_fragment_of(message, message_len, index);
    fragment.origin = 3;
    fragment.destination = 9;
    fragment.message_id = 0x1234;
    return fragment;
}

static void test_counts(void)
{
    TEST_ASSERT_EQUAL(90, PIECE);
    TEST_ASSERT_EQUAL(0, tsr_fragment_count(0));
    TEST_ASSERT_EQUAL(1, tsr_fragment_count(1));
    TEST_ASSERT_EQUAL(1, tsr_fragment_count(PIECE));
    TEST_ASSERT_EQUAL(2, tsr_fragment_count(PIECE + 1));
    TEST_ASSERT_EQUAL(1024, tsr_fragment_count(MESSAGE_MAX));
    TEST_ASSERT_EQUAL(0, tsr_fragment_count(MESSAGE_MAX + 1));
    TEST_ASSERT_EQUAL(0, tsr_fragment_count(SIZE_MAX));
}

static void test_octets(void)
{
    const uint8_t expected[] = {0x11, 0x10, 3, 0, 9, 0, 0x34, 0x12, 2, 0, 3, 0};
    struct tsr_fragment fragment = piece_of(2 * PIECE + 5, 2);
    fragment.poll = true;
    TEST_ASSERT_EQUAL(5, fragment.piece_len);
    TEST_ASSERT_EQUAL_PTR(message + 2 * PIECE, fragment.piece);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_write(&fragment, bytes, sizeof bytes, &len));
    TEST_ASSERT_EQUAL(TSR_FRAGMENT_HEADER_LEN + 5, len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, sizeof expected);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(message + 2 * PIECE, bytes + sizeof expected, 5);
    fragment.poll = false;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_write(&fragment, bytes, sizeof bytes, &len));
    TEST_ASSERT_EQUAL_HEX8(0x10, bytes[0]);
}

static void test_write_and_read_back(void)
{
    const size_t lens[] = {1, PIECE - 1, PIECE, PIECE + 1, 7 * PIECE, MESSAGE_MAX - 1, MESSAGE_MAX};
    for (unsigned i = 0; i < sizeof lens / sizeof lens[0]; i++) {
        for (uint16_t index = 0; index < tsr_fragment_count(lens[i]); index++) {
            struct tsr_fragment fragment = piece_of(lens[i], index);
            struct tsr_fragment read;
            memset(&read, 0, sizeof read);
            fragment.poll = index % 2 == 1;
            const size_t whole = TSR_FRAGMENT_HEADER_LEN + (size_t)fragment.piece_len;
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_fragment_write(&fragment, bytes, whole - 1, &len));
            TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_write(&fragment, bytes, whole, &len));
            TEST_ASSERT_EQUAL(whole, len);
            TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_read(bytes, len, &read));
            TEST_ASSERT_EQUAL(fragment.poll, read.poll);
            TEST_ASSERT_EQUAL(TSR_FRAGMENT_TTL_START, read.ttl);
            TEST_ASSERT_EQUAL(3, read.origin);
            TEST_ASSERT_EQUAL(9, read.destination);
            TEST_ASSERT_EQUAL(0x1234, read.message_id);
            TEST_ASSERT_EQUAL(index, read.index);
            TEST_ASSERT_EQUAL(fragment.count, read.count);
            TEST_ASSERT_EQUAL(fragment.piece_len, read.piece_len);
            TEST_ASSERT_EQUAL_PTR(bytes + TSR_FRAGMENT_HEADER_LEN, read.piece);
        }
    }
    TEST_ASSERT_EQUAL_HEX8(0xee, bytes[TSR_FRAME_PAYLOAD_MAX]);
}

static void refuse(struct tsr_fragment fragment)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_fragment_write(&fragment, bytes, sizeof bytes, &len));
    TEST_ASSERT_EQUAL(777, len);
}

static void test_write_refuses_every_field_out_of_range(void)
{
    const struct tsr_fragment right = piece_of(3 * PIECE, 1);
    struct tsr_fragment wrong = right;
    wrong.count = 0;
    refuse(wrong);
    wrong = right;
    wrong.index = wrong.count;
    refuse(wrong);
    wrong = right;
    wrong.count = TSR_FRAGMENT_COUNT_MAX + 1;
    refuse(wrong);
    wrong = right;
    wrong.piece_len = 0;
    refuse(wrong);
    wrong = right;
    wrong.piece_len = PIECE - 1; /* not the last */
    refuse(wrong);
    wrong = right;
    wrong.piece_len = PIECE + 1;
    refuse(wrong);
}

static void expect_read(enum tsr_status expected, size_t read_len)
{
    struct tsr_fragment read;
    memset(&read, 0xab, sizeof read);
    const struct tsr_fragment before = read;
    TEST_ASSERT_EQUAL(expected, tsr_fragment_read(bytes, read_len, &read));
    if (expected != TSR_OK) {
        TEST_ASSERT_EQUAL_MEMORY(&before, &read, sizeof read);
    }
}

static void put_u16(size_t at, unsigned value)
{
    bytes[at] = (uint8_t)value;
    bytes[at + 1] = (uint8_t)(value >> 8);
}

static void test_read_refuses_every_field_out_of_range(void)
{
    const struct tsr_fragment fragment = piece_of(3 * PIECE, 1);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_write(&fragment, bytes, sizeof bytes, &len));
    for (unsigned dispatch = 0; dispatch < 256; dispatch++) {
        bytes[0] = (uint8_t)dispatch;
        expect_read(dispatch == 0x10 || dispatch == 0x11 ? TSR_OK : TSR_ERR_VERSION, len);
    }
    bytes[0] = 0x10;
    for (size_t shorter = 0; shorter < len; shorter++) {
        expect_read(TSR_ERR_FORMAT, shorter);
    }
    expect_read(TSR_ERR_FORMAT, len + 1);
    for (unsigned count = 0; count < 0x10000u; count++) {
        put_u16(10, count);
        expect_read(count > 1 && count <= TSR_FRAGMENT_COUNT_MAX ? TSR_OK : TSR_ERR_FORMAT, len);
    }
    put_u16(10, 3);
    for (unsigned index = 0; index < 0x10000u; index++) {
        put_u16(8, index);
        expect_read(index < 3 ? TSR_OK : TSR_ERR_FORMAT, len);
    }
    put_u16(8, 2); /* the last may be short, but not empty */
    expect_read(TSR_OK, TSR_FRAGMENT_HEADER_LEN + 1);
    expect_read(TSR_ERR_FORMAT, TSR_FRAGMENT_HEADER_LEN);
}

static void check_order(uint16_t count, uint32_t seed)
{
    static uint16_t order[2 * TSR_FRAGMENT_COUNT_MAX];
    struct codec_random random = codec_random_of_seed(seed);
    const size_t message_len = (size_t)(count - 1u) * PIECE + 1 + codec_random_below(&random, PIECE);
    for (unsigned i = 0; i < 2u * count; i++) { /* each twice */
        order[i] = (uint16_t)(i % count);
    }
    for (unsigned i = 2u * count; i > 1; i--) {
        const unsigned other = codec_random_below(&random, i);
        const uint16_t swapped = order[i - 1];
        order[i - 1] = order[other];
        order[other] = swapped;
    }
    struct tsr_reassembly reassembly;
    tsr_reassembly_init(&reassembly, room, message_len);
    memset(room, 0, message_len);
    struct tsr_fragment fragment = piece_of(message_len, order[0]);
    TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &fragment));
    TEST_ASSERT_FALSE(tsr_reassembly_complete(&reassembly));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_reassembly_begin(&reassembly, &fragment));
    bool seen[TSR_FRAGMENT_COUNT_MAX] = {false};
    unsigned received = 0;
    for (unsigned i = 0; i < 2u * count; i++) {
        fragment = piece_of(message_len, order[i]);
        received += seen[order[i]] ? 0 : 1;
        seen[order[i]] = true;
        TEST_ASSERT_TRUE(tsr_reassembly_matches(&reassembly, &fragment));
        TEST_ASSERT_EQUAL(received == count ? TSR_OK : TSR_AGAIN, tsr_reassembly_add(&reassembly, &fragment));
        TEST_ASSERT_EQUAL(received == count, tsr_reassembly_complete(&reassembly));
    }
    TEST_ASSERT_EQUAL(message_len, reassembly.message_len);
    TEST_ASSERT_EQUAL_MEMORY(message, room, message_len);
}

static void test_any_order_with_repetitions(void)
{
    for (uint16_t count = 1; count <= 24; count++) {
        check_order(count, count);
    }
    check_order(TSR_FRAGMENT_COUNT_MAX, 99);
}

static void test_other_messages_do_not_match(void)
{
    struct tsr_reassembly reassembly;
    const struct tsr_fragment fragment = piece_of(200, 0);
    tsr_reassembly_init(&reassembly, room, sizeof room);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_reassembly_begin(&reassembly, &fragment));
    struct tsr_fragment other = fragment;
    other.origin++;
    TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &other));
    other = fragment;
    other.destination++;
    TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &other));
    other = fragment;
    other.message_id++;
    TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &other));
}

static void test_contradictions_are_dropped(void)
{
    struct tsr_reassembly reassembly;
    struct tsr_fragment first = piece_of(3 * PIECE, 0);
    tsr_reassembly_init(&reassembly, room, sizeof room);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_reassembly_add(&reassembly, &first)); /* nothing was begun */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_reassembly_begin(&reassembly, &first));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_reassembly_add(&reassembly, &first));
    struct tsr_fragment other_count = piece_of(4 * PIECE, 1);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_reassembly_add(&reassembly, &other_count));
    struct tsr_fragment beyond = piece_of(4 * PIECE, 3);
    beyond.count = 3;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_reassembly_add(&reassembly, &beyond));
    TEST_ASSERT_EQUAL(1, reassembly.received);
}

/* A capacity one byte short refuses at begin or at the last piece, and no byte
 * behind it is written. */
static void test_capacity(void)
{
    for (size_t message_len = 1; message_len <= 3 * PIECE; message_len++) {
        struct tsr_reassembly reassembly;
        const uint16_t last = (uint16_t)(tsr_fragment_count(message_len) - 1u);
        struct tsr_fragment fragment = piece_of(message_len, last);
        memset(room, 0xee, message_len + 1);
        tsr_reassembly_init(&reassembly, room, message_len - 1);
        enum tsr_status status = tsr_reassembly_begin(&reassembly, &fragment);
        if (message_len % PIECE == 1) {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, status);
            TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &fragment));
        } else {
            TEST_ASSERT_EQUAL(TSR_OK, status);
            TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_reassembly_add(&reassembly, &fragment));
        }
        TEST_ASSERT_EQUAL_HEX8(0xee, room[message_len - 1]);
    }
}

static void test_begin_forgets_what_was_under_way(void)
{
    struct tsr_reassembly reassembly;
    const struct tsr_fragment a = piece_of(2 * PIECE, 0);
    struct tsr_fragment b = piece_of(2 * PIECE, 1);
    tsr_reassembly_init(&reassembly, room, 2 * PIECE);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_reassembly_begin(&reassembly, &a));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_reassembly_add(&reassembly, &a));
    b.message_id++;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_reassembly_begin(&reassembly, &b));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_reassembly_add(&reassembly, &b));
    TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &a));
    struct tsr_fragment huge = piece_of(MESSAGE_MAX, 0);
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_reassembly_begin(&reassembly, &huge));
    TEST_ASSERT_FALSE(tsr_reassembly_complete(&reassembly));
    TEST_ASSERT_FALSE(tsr_reassembly_matches(&reassembly, &b)); /* then nothing is under way */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_counts);
    RUN_TEST(test_octets);
    RUN_TEST(test_write_and_read_back);
    RUN_TEST(test_write_refuses_every_field_out_of_range);
    RUN_TEST(test_read_refuses_every_field_out_of_range);
    RUN_TEST(test_any_order_with_repetitions);
    RUN_TEST(test_other_messages_do_not_match);
    RUN_TEST(test_contradictions_are_dropped);
    RUN_TEST(test_capacity);
    RUN_TEST(test_begin_forgets_what_was_under_way);
    return UNITY_END();
}
