/*
 * Range coder: round trips, length, carries, full buffers.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>
#include <string.h>

#include "tsr/codec/range.h"
#include "unity.h"

#define BIT_COUNT 5000
#define OUT_CAP 8192

static uint8_t out[OUT_CAP];
static uint8_t bits[BIT_COUNT];

void setUp(void)
{
    memset(out, 0xa5, sizeof out);
}
void tearDown(void) {}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static size_t encode(size_t cap, enum tsr_status expected)
{
    struct tsr_range_encoder encoder;
    struct tsr_range_bit contexts[3];
    size_t len = SIZE_MAX;
    tsr_range_bits_reset(contexts, 3);
    tsr_range_encode_start(&encoder, out, cap);
    for (size_t i = 0; i < BIT_COUNT; i++) {
        tsr_range_encode_bit(&encoder, &contexts[i % 3], bits[i]);
        if (i % 7 == 0) {
            tsr_range_encode_direct(&encoder, (uint32_t)i, 1 + (unsigned)(i % TSR_RANGE_DIRECT_COUNT_MAX));
        }
    }
    TEST_ASSERT_EQUAL(expected, tsr_range_encode_finish(&encoder, &len));
    return len;
}

static void check_decodes(size_t len)
{
    struct tsr_range_decoder decoder;
    struct tsr_range_bit contexts[3];
    tsr_range_bits_reset(contexts, 3);
    tsr_range_decode_start(&decoder, out, len);
    for (size_t i = 0; i < BIT_COUNT; i++) {
        TEST_ASSERT_EQUAL(bits[i], tsr_range_decode_bit(&decoder, &contexts[i % 3]));
        if (i % 7 == 0) {
            const unsigned bit_count = 1 + (unsigned)(i % TSR_RANGE_DIRECT_COUNT_MAX);
            TEST_ASSERT_EQUAL(i & ((1u << bit_count) - 1), tsr_range_decode_direct(&decoder, bit_count));
        }
    }
}

static void fill_bits(uint32_t seed, unsigned ones_of_256)
{
    uint32_t state = seed;
    for (size_t i = 0; i < BIT_COUNT; i++) {
        bits[i] = (next_random(&state) & 255) < ones_of_256;
    }
}

static void test_round_trip(void)
{
    for (uint32_t seed = 1; seed <= 50; seed++) {
        fill_bits(seed, seed * 5 % 257);
        check_decodes(encode(OUT_CAP, TSR_OK));
    }
}

static void test_full_buffer(void)
{
    fill_bits(7, 100);
    const size_t len = encode(OUT_CAP, TSR_OK);
    TEST_ASSERT_EQUAL(len, encode(len, TSR_OK));
    for (size_t cap = 0; cap < len; cap += cap < 64 ? 1 : 97) {
        memset(out, 0xa5, sizeof out);
        TEST_ASSERT_EQUAL(SIZE_MAX, encode(cap, TSR_ERR_NOBUF));
        TEST_ASSERT_EACH_EQUAL_UINT8(0xa5, out + cap, OUT_CAP - cap);
    }
    TEST_ASSERT_EQUAL(SIZE_MAX, encode(len - 1, TSR_ERR_NOBUF));
}

/* A carry runs back over every byte 0xff and stops at the first other one. */
static void test_carry_runs_over_ff(void)
{
    const uint8_t written[5] = {0x12, 0xfe, 0xff, 0xff, 0xff};
    const uint8_t carried[5] = {0x12, 0xff, 0x00, 0x00, 0x00};
    memcpy(out, written, sizeof written);
    struct tsr_range_encoder encoder = {.out = out, .cap = 5, .at = 5, .low = 0xfffffff0u, .range = 0x02000000u};
    struct tsr_range_bit context = {.p_one_q16 = 0x8000, .count = 60};
    tsr_range_encode_bit(&encoder, &context, 0);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(carried, out, sizeof carried);
    TEST_ASSERT_EQUAL(5, encoder.at);
    TEST_ASSERT_EQUAL_HEX32(0x00fffff0u, encoder.low);
}

/* Trailing zeros are not sent, so a carry may shorten the stream. */
static void test_finish_takes_the_shortest_number(void)
{
    memset(out, 0xff, 3);
    out[0] = 0x7f;
    struct tsr_range_encoder encoder = {.out = out, .cap = 4, .at = 3, .low = 0xff000001u, .range = 0x01000000u};
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_range_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(1, len);
    TEST_ASSERT_EQUAL_HEX8(0x80, out[0]);
}

static void test_nothing_takes_no_byte(void)
{
    struct tsr_range_encoder encoder;
    size_t len = 9;
    tsr_range_encode_start(&encoder, out, 0);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_range_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(0, len);
}

/* 5000 bits of probability 1/256 carry 23.6 bytes of information. */
static void test_rare_bits_are_cheap(void)
{
    struct tsr_range_encoder encoder;
    struct tsr_range_bit context;
    uint32_t state = 3;
    size_t len = 0;
    tsr_range_bits_reset(&context, 1);
    tsr_range_encode_start(&encoder, out, OUT_CAP);
    for (unsigned i = 0; i < BIT_COUNT; i++) {
        tsr_range_encode_bit(&encoder, &context, (next_random(&state) & 255) == 0);
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_range_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_THAN(40, len);
}

static void test_trained_start(void)
{
    static const uint8_t counts[16] = {0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 33, 40, 48, 54, 60};
    struct tsr_range_bit contexts[16];
    uint16_t prior[16];
    for (unsigned i = 0; i < 16; i++) {
        prior[i] = (uint16_t)((2 + 272 * i) << 4 | i);
    }
    tsr_range_bits_load(contexts, prior, 16);
    for (unsigned i = 0; i < 16; i++) {
        TEST_ASSERT_EQUAL((2 + 272 * i) * 16, contexts[i].p_one_q16);
        TEST_ASSERT_EQUAL(counts[i], contexts[i].count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_round_trip);
    RUN_TEST(test_full_buffer);
    RUN_TEST(test_carry_runs_over_ff);
    RUN_TEST(test_finish_takes_the_shortest_number);
    RUN_TEST(test_nothing_takes_no_byte);
    RUN_TEST(test_rare_bits_are_cheap);
    RUN_TEST(test_trained_start);
    return UNITY_END();
}
