/*
 * Byte reader and writer: order, exact ends, sticky overruns.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdlib.h>
#include <string.h>

#include "tsr/base/bytes.h"
#include "tsr/base/status.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void write_all(struct tsr_writer *writer)
{
    const uint8_t span[3] = {0xa1, 0xa2, 0xa3};
    tsr_write_u8(writer, 0x01);
    tsr_write_u16(writer, 0x0302);
    tsr_write_u32(writer, 0x07060504u);
    tsr_write_u64(writer, 0x0f0e0d0c0b0a0908ull);
    tsr_write_span(writer, span, sizeof span);
}

#define ALL_LEN 18u

static void test_least_significant_byte_first(void)
{
    uint8_t bytes[ALL_LEN];
    struct tsr_writer writer = tsr_writer_make(bytes, sizeof bytes);
    write_all(&writer);
    TEST_ASSERT_TRUE(tsr_writer_ok(&writer));
    TEST_ASSERT_EQUAL(ALL_LEN, writer.at);
    for (unsigned i = 0; i < 15; i++) {
        TEST_ASSERT_EQUAL_HEX8(i + 1, bytes[i]);
    }
    struct tsr_reader reader = tsr_reader_make(bytes, sizeof bytes);
    TEST_ASSERT_EQUAL_HEX8(0x01, tsr_read_u8(&reader));
    TEST_ASSERT_EQUAL_HEX16(0x0302, tsr_read_u16(&reader));
    TEST_ASSERT_EQUAL_HEX32(0x07060504u, tsr_read_u32(&reader));
    TEST_ASSERT_EQUAL_HEX64(0x0f0e0d0c0b0a0908ull, tsr_read_u64(&reader));
    TEST_ASSERT_EQUAL(3, tsr_reader_left(&reader));
    TEST_ASSERT_EQUAL_PTR(bytes + 15, tsr_read_span(&reader, 3));
    TEST_ASSERT_EQUAL(0, tsr_reader_left(&reader));
    TEST_ASSERT_TRUE(tsr_reader_ok(&reader));
}

/* At every capacity that is too small, nothing behind it is written and the
 * overrun is remembered by later writes that would fit. */
static void test_writer_stops_at_every_capacity(void)
{
    for (size_t cap = 0; cap < ALL_LEN; cap++) {
        uint8_t bytes[ALL_LEN + 8];
        memset(bytes, 0xee, sizeof bytes);
        struct tsr_writer writer = tsr_writer_make(bytes, cap);
        write_all(&writer);
        tsr_write_span(&writer, bytes, 0);
        TEST_ASSERT_FALSE(tsr_writer_ok(&writer));
        TEST_ASSERT_GREATER_THAN(cap, writer.at);
        for (size_t i = cap; i < sizeof bytes; i++) {
            TEST_ASSERT_EQUAL_HEX8(0xee, bytes[i]);
        }
    }
}

static void test_reader_stops_at_every_length(void)
{
    for (size_t len = 0; len < 15; len++) {
        uint8_t *bytes = malloc(len + 1); /* exact, for the sanitizer */
        memset(bytes, 0xff, len + 1);
        struct tsr_reader reader = tsr_reader_make(bytes + 1, len);
        (void)tsr_read_u8(&reader);
        (void)tsr_read_u16(&reader);
        (void)tsr_read_u32(&reader);
        (void)tsr_read_u64(&reader);
        TEST_ASSERT_FALSE(tsr_reader_ok(&reader));
        TEST_ASSERT_EQUAL(0, tsr_reader_left(&reader));
        TEST_ASSERT_EQUAL(0, tsr_read_u8(&reader));
        TEST_ASSERT_NULL(tsr_read_span(&reader, 0));
        free(bytes);
    }
}

static void test_lengths_near_the_largest_do_not_wrap(void)
{
    uint8_t bytes[4] = {1, 2, 3, 4};
    struct tsr_reader reader = tsr_reader_make(bytes, sizeof bytes);
    (void)tsr_read_u8(&reader);
    TEST_ASSERT_NULL(tsr_read_span(&reader, SIZE_MAX));
    TEST_ASSERT_FALSE(tsr_reader_ok(&reader));
    struct tsr_writer writer = tsr_writer_make(bytes, sizeof bytes);
    tsr_write_u8(&writer, 9);
    tsr_write_span(&writer, bytes, SIZE_MAX);
    TEST_ASSERT_FALSE(tsr_writer_ok(&writer));
}

static void test_every_status_has_its_name(void)
{
    for (int status = TSR_ERR_NOREF; status <= TSR_AGAIN; status++) {
        TEST_ASSERT_TRUE(strcmp(tsr_status_name((enum tsr_status)status), "unknown") != 0);
        for (int other = TSR_ERR_NOREF; other < status; other++) {
            TEST_ASSERT_TRUE(
                strcmp(tsr_status_name((enum tsr_status)status), tsr_status_name((enum tsr_status)other)) != 0);
        }
    }
    TEST_ASSERT_EQUAL_STRING("unknown", tsr_status_name((enum tsr_status)(TSR_ERR_NOREF - 1)));
    TEST_ASSERT_EQUAL_STRING("unknown", tsr_status_name((enum tsr_status)(TSR_AGAIN + 1)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_least_significant_byte_first);
    RUN_TEST(test_writer_stops_at_every_capacity);
    RUN_TEST(test_reader_stops_at_every_length);
    RUN_TEST(test_lengths_near_the_largest_do_not_wrap);
    RUN_TEST(test_every_status_has_its_name);
    return UNITY_END();
}
