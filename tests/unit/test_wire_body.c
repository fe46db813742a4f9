/*
 * Message bodies, and the bitmap of missing fragments.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdlib.h>
#include <string.h>

#include "codec_random.h"
#include "tsr/wire/body.h"
#include "unity.h"

static uint8_t bytes[TSR_BODY_STATUS_MAX + 1];
static size_t len;

void setUp(void)
{
    memset(bytes, 0xee, sizeof bytes);
    len = 777;
}
void tearDown(void) {}

static void test_capture(void)
{
    const uint8_t expected[TSR_BODY_WAKE_LEN] = {0x02, 0x01, 0x03};
    const struct tsr_body_capture capture = {0x0102, 3};
    struct tsr_body_capture read = {0, 0};
    tsr_body_write_capture(&capture, bytes);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, sizeof expected);
    TEST_ASSERT_EQUAL_HEX8(0xee, bytes[TSR_BODY_WAKE_LEN]);
    for (size_t read_len = 0; read_len < TSR_BODY_WAKE_LEN; read_len++) {
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_body_read_capture(bytes, read_len, &read));
        TEST_ASSERT_EQUAL(0, read.capture_id);
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_body_read_capture(bytes, sizeof bytes, &read));
    TEST_ASSERT_EQUAL_HEX16(0x0102, read.capture_id);
    TEST_ASSERT_EQUAL(3, read.attempt);
}

static void test_map(void)
{
    uint8_t body[TSR_BODY_MAP_HEADER_LEN + 10] = {0};
    for (size_t reference_len = 0; reference_len < 10; reference_len++) {
        struct tsr_body_map read;
        tsr_body_write_map_header(0x0807060504030201ull, 0x0a09, reference_len, body);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_body_read_map(body, sizeof body, &read));
        TEST_ASSERT_EQUAL_HEX64(0x0807060504030201ull, read.capture_time_us);
        TEST_ASSERT_EQUAL_HEX16(0x0a09, read.capture_id);
        TEST_ASSERT_EQUAL(reference_len, read.reference_len);
        TEST_ASSERT_EQUAL_PTR(reference_len > 0 ? body + TSR_BODY_MAP_HEADER_LEN : NULL, read.reference);
        TEST_ASSERT_EQUAL_PTR(body + TSR_BODY_MAP_HEADER_LEN + reference_len, read.map);
        TEST_ASSERT_EQUAL(10 - reference_len, read.map_len);
        for (size_t shorter = 0; shorter <= TSR_BODY_MAP_HEADER_LEN + reference_len; shorter++) {
            memset(&read, 0xab, sizeof read);
            TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_body_read_map(body, shorter, &read));
            TEST_ASSERT_EQUAL(0xabab, read.capture_id);
        }
    }
    for (unsigned i = 0; i < 32; i++) {
        struct tsr_body_map read;
        tsr_body_write_map_header(1, 2, (size_t)1 << i, body);
        const enum tsr_status status = tsr_body_read_map(body, sizeof body, &read);
        TEST_ASSERT_EQUAL(i < 4 ? TSR_OK : TSR_ERR_FORMAT, status);
    }
}

static struct tsr_body_events events_of(unsigned count)
{
    struct tsr_body_events events;
    memset(&events, 0, sizeof events);
    events.capture_time_us = 0x0807060504030201ull;
    events.capture_id = 0x0a09;
    events.count = (uint8_t)count;
    for (unsigned i = 0; i < count && i < TSR_BODY_EVENTS_MAX; i++) {
        events.events[i] = (struct tsr_body_event){(uint8_t)i, (uint8_t)(1 + i % 4), (uint16_t)(512 * (i + 1)),
                                                   (uint16_t)(0x1000 + i)};
    }
    return events;
}

static void test_events(void)
{
    const uint8_t first[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 0, 1, 0x00, 0x02, 0x00, 0x10};
    uint8_t body[TSR_BODY_EVENT_HEADER_LEN + TSR_BODY_EVENTS_MAX * TSR_BODY_EVENT_LEN + 1];
    struct tsr_body_events read;
    for (unsigned count = 1; count <= TSR_BODY_EVENTS_MAX; count++) {
        const struct tsr_body_events events = events_of(count);
        const size_t whole = TSR_BODY_EVENT_HEADER_LEN + count * TSR_BODY_EVENT_LEN;
        size_t written = 777;
        memset(body, 0xee, sizeof body);
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_body_write_events(&events, body, whole - 1, &written));
        TEST_ASSERT_EQUAL_HEX8(0xee, body[0]);
        TEST_ASSERT_EQUAL(777, written);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_body_write_events(&events, body, whole, &written));
        TEST_ASSERT_EQUAL(whole, written);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(first, body, sizeof first);
        TEST_ASSERT_EQUAL_HEX8(0xee, body[whole]);
        memset(&read, 0, sizeof read);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_body_read_events(body, whole, &read));
        TEST_ASSERT_EQUAL_MEMORY(&events, &read, sizeof read);
        memset(&read, 0xab, sizeof read);
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_body_read_events(body, whole - 1, &read));
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_body_read_events(body, whole + 1, &read));
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_body_read_events(body, TSR_BODY_EVENT_HEADER_LEN, &read));
        TEST_ASSERT_EQUAL_HEX16(0xabab, read.capture_id);
    }
    struct tsr_body_events events = events_of(0);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_body_write_events(&events, body, sizeof body, &len));
    events.count = TSR_BODY_EVENTS_MAX + 1;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_body_write_events(&events, body, sizeof body, &len));
}

static void test_events_refuse_unknown_values(void)
{
    uint8_t body[TSR_BODY_EVENT_HEADER_LEN + TSR_BODY_EVENT_LEN];
    struct tsr_body_events events = events_of(1);
    struct tsr_body_events read;
    const struct {
        uint8_t kind;
        uint16_t share_q12;
        enum tsr_status status;
    } cases[] = {{TSR_EVENT_BEGUN, 0, TSR_OK},
                 {TSR_EVENT_VANISHED, TSR_EVENT_SHARE_ONE, TSR_OK},
                 {0, 0, TSR_ERR_FORMAT},
                 {TSR_EVENT_VANISHED + 1, 0, TSR_ERR_FORMAT},
                 {TSR_EVENT_ENDED, TSR_EVENT_SHARE_ONE + 1, TSR_ERR_FORMAT}};
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        events.events[0].kind = cases[i].kind;
        events.events[0].share_q12 = cases[i].share_q12;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_body_write_events(&events, body, sizeof body, &len));
        TEST_ASSERT_EQUAL(cases[i].status, tsr_body_read_events(body, sizeof body, &read));
    }
}

static struct tsr_body_status status_of_len(unsigned bitmap_len)
{
    struct tsr_body_status status;
    memset(&status, 0, sizeof status);
    status.message_id = 0x0102;
    status.state = TSR_DELIVERY_MISSING;
    status.first = 0x0508;
    status.bitmap_len = (uint8_t)bitmap_len;
    for (unsigned i = 0; i < bitmap_len && i < TSR_BODY_STATUS_BITMAP_MAX; i++) {
        status.bitmap[i] = (uint8_t)(i + 1);
    }
    return status;
}

static void test_status_of_every_length(void)
{
    for (unsigned bitmap_len = 0; bitmap_len <= TSR_BODY_STATUS_BITMAP_MAX; bitmap_len++) {
        const struct tsr_body_status status = status_of_len(bitmap_len);
        const size_t whole = TSR_BODY_STATUS_HEADER_LEN + bitmap_len;
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_body_write_status(&status, bytes, whole - 1, &len));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_body_write_status(&status, bytes, whole, &len));
        TEST_ASSERT_EQUAL(whole, len);
        TEST_ASSERT_EQUAL_HEX8(0xee, bytes[TSR_BODY_STATUS_MAX]);
        struct tsr_body_status read;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_body_read_status(bytes, len, &read));
        TEST_ASSERT_EQUAL_MEMORY(&status, &read, sizeof read);
    }
    const struct tsr_body_status longer = status_of_len(TSR_BODY_STATUS_BITMAP_MAX + 1);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_body_write_status(&longer, bytes, sizeof bytes, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT,
                      tsr_body_read_status(bytes, TSR_BODY_STATUS_MAX + 1, &(struct tsr_body_status){0}));
}

static void test_status_fields_out_of_range(void)
{
    const struct tsr_body_status status = status_of_len(2);
    struct tsr_body_status read;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_body_write_status(&status, bytes, sizeof bytes, &len));
    for (size_t shorter = 0; shorter < TSR_BODY_STATUS_HEADER_LEN; shorter++) {
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_body_read_status(bytes, shorter, &read));
    }
    for (unsigned state = 0; state < 256; state++) {
        bytes[2] = (uint8_t)state;
        TEST_ASSERT_EQUAL(state >= 1 && state <= 3 ? TSR_OK : TSR_ERR_FORMAT, tsr_body_read_status(bytes, len, &read));
    }
    bytes[2] = TSR_DELIVERY_MISSING;
    for (unsigned first = 0; first < 256; first++) {
        bytes[3] = (uint8_t)first;
        TEST_ASSERT_EQUAL(first % 8 == 0 ? TSR_OK : TSR_ERR_FORMAT, tsr_body_read_status(bytes, len, &read));
    }
}

/* A reassembly of count fragments that has those for which have[i] is set. */
static struct tsr_reassembly with_fragments(uint16_t count, const bool *have)
{
    struct tsr_reassembly reassembly;
    memset(&reassembly, 0, sizeof reassembly);
    reassembly.count = count;
    reassembly.message_id = 0x0a0b;
    for (unsigned i = 0; i < count; i++) {
        if (have[i]) {
            reassembly.have[i / 8] |= (uint8_t)(1u << i % 8);
            reassembly.received++;
        }
    }
    return reassembly;
}

/* The bitmap names exactly the missing fragments from the first gap on, as far as it reaches. */
static void check_bitmap(uint16_t count, const bool *have)
{
    const struct tsr_reassembly reassembly = with_fragments(count, have);
    const struct tsr_body_status status = tsr_body_status_of(&reassembly, TSR_DELIVERY_COMMITTED);
    TEST_ASSERT_EQUAL_HEX16(0x0a0b, status.message_id);
    if (reassembly.received == count) {
        TEST_ASSERT_EQUAL(TSR_DELIVERY_COMMITTED, status.state);
        TEST_ASSERT_EQUAL(0, status.bitmap_len);
        return;
    }
    TEST_ASSERT_EQUAL(TSR_DELIVERY_MISSING, status.state);
    TEST_ASSERT_EQUAL(0, status.first % 8);
    const unsigned end = status.first + 8u * status.bitmap_len;
    TEST_ASSERT_TRUE(end >= count || status.bitmap_len == TSR_BODY_STATUS_BITMAP_MAX);
    bool names_one = false;
    for (unsigned i = 0; i < count; i++) {
        if (i < status.first) {
            TEST_ASSERT_TRUE(have[i]);
        } else if (i < end) {
            const bool named = (status.bitmap[(i - status.first) / 8] >> (i - status.first) % 8 & 1) != 0;
            TEST_ASSERT_EQUAL(!have[i], named);
            names_one = names_one || named;
        }
    }
    for (unsigned i = count; i < end; i++) { /* beyond the message */
        TEST_ASSERT_EQUAL(0, status.bitmap[(i - status.first) / 8] >> (i - status.first) % 8 & 1);
    }
    TEST_ASSERT_TRUE(names_one); /* every answer lets the sender go on */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_body_write_status(&status, bytes, TSR_BODY_STATUS_MAX, &len));
}

static void test_every_pattern_of_small_messages(void)
{
    for (uint16_t count = 1; count <= 12; count++) {
        for (unsigned pattern = 0; pattern < 1u << count; pattern++) {
            bool have[12];
            for (unsigned i = 0; i < count; i++) {
                have[i] = (pattern >> i & 1) != 0;
            }
            check_bitmap(count, have);
        }
    }
}

static void test_patterns_of_long_messages(void)
{
    const uint16_t counts[] = {560, 567, 568, 569, 576, 600, 601, 729, 1023, 1024};
    bool have[TSR_FRAGMENT_COUNT_MAX];
    for (unsigned c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        memset(have, 0, sizeof have);
        check_bitmap(counts[c], have);
        for (unsigned gap = 0; gap < counts[c]; gap++) { /* a single gap anywhere */
            memset(have, 1, sizeof have);
            have[gap] = false;
            check_bitmap(counts[c], have);
        }
        for (unsigned seed = 0; seed < 200; seed++) {
            struct codec_random random = codec_random_of_seed(seed);
            const uint32_t loss = 1 + codec_random_below(&random, 100);
            for (unsigned i = 0; i < counts[c]; i++) {
                have[i] = codec_random_below(&random, 100) >= loss;
            }
            check_bitmap(counts[c], have);
        }
        memset(have, 1, sizeof have);
        check_bitmap(counts[c], have);
    }
}

static void test_idle_reassembly(void)
{
    struct tsr_reassembly reassembly;
    tsr_reassembly_init(&reassembly, bytes, sizeof bytes);
    const struct tsr_body_status status = tsr_body_status_of(&reassembly, TSR_DELIVERY_COMMITTED);
    TEST_ASSERT_EQUAL(TSR_DELIVERY_MISSING, status.state);
    TEST_ASSERT_EQUAL(0, status.bitmap_len);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_capture);
    RUN_TEST(test_map);
    RUN_TEST(test_events);
    RUN_TEST(test_events_refuse_unknown_values);
    RUN_TEST(test_status_of_every_length);
    RUN_TEST(test_status_fields_out_of_range);
    RUN_TEST(test_every_pattern_of_small_messages);
    RUN_TEST(test_patterns_of_long_messages);
    RUN_TEST(test_idle_reassembly);
    return UNITY_END();
}
