/*
 * End-to-end messages: layout, both ways of sealing, refusals.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "mbedtls_aes.h"
#include "tsr/wire/message.h"
#include "unity.h"

#define BODY_LEN 50u
#define BODY_MAX TSR_CCM_TEXT_MAX

static struct tsr_cipher cipher;
static struct tsr_message_header header;
static uint8_t message[BODY_MAX + TSR_MESSAGE_OVERHEAD_LEN];
static size_t message_len;
static size_t body_len;

void setUp(void)
{
    const struct tsr_message_header example = {TSR_MESSAGE_MAP, TSR_KEY_NODE, 0x0102, 0, 0x0a0b0c0du};
    cipher = test_cipher(0x20);
    header = example;
    message_len = body_len = 777;
}
void tearDown(void) {}

static void put_body(size_t len)
{
    for (size_t i = 0; i < len; i++) {
        message[TSR_MESSAGE_HEADER_LEN + i] = (uint8_t)(i * 7 + 3);
    }
}

static void check_body(size_t len)
{
    for (size_t i = 0; i < len; i++) {
        TEST_ASSERT_EQUAL_HEX8((uint8_t)(i * 7 + 3), message[TSR_MESSAGE_HEADER_LEN + i]);
    }
}

static void seal(size_t len)
{
    put_body(len);
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_message_seal(&header, &cipher, message, len + TSR_MESSAGE_OVERHEAD_LEN, len, &message_len));
    TEST_ASSERT_EQUAL(len + TSR_MESSAGE_OVERHEAD_LEN, message_len);
}

static void test_round_trip(void)
{
    const uint8_t expected[TSR_MESSAGE_HEADER_LEN] = {3, 1, 0x0d, 0x0c, 0x0b, 0x0a};
    const size_t lens[] = {0, 1, 15, 16, 17, BODY_LEN, BODY_MAX};
    for (unsigned i = 0; i < sizeof lens / sizeof lens[0]; i++) {
        struct tsr_message_header read;
        memset(&read, 0, sizeof read);
        seal(lens[i]);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, message, sizeof expected);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_message_parse(message, message_len, 0x0102, 0, &read));
        TEST_ASSERT_EQUAL(TSR_MESSAGE_MAP, read.kind);
        TEST_ASSERT_EQUAL(TSR_KEY_NODE, read.key_use);
        TEST_ASSERT_EQUAL_HEX32(0x0a0b0c0du, read.counter);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_message_open(&read, &cipher, message, message_len, &body_len));
        TEST_ASSERT_EQUAL(lens[i], body_len);
        check_body(body_len);
    }
}

/* Sealed in pieces as in one call. */
static void test_pieces(void)
{
    static uint8_t whole[BODY_LEN + TSR_MESSAGE_OVERHEAD_LEN];
    seal(BODY_LEN);
    memcpy(whole, message, sizeof whole);
    for (size_t piece = 1; piece <= BODY_LEN; piece++) {
        struct tsr_ccm ccm;
        put_body(BODY_LEN);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_message_seal_start(&ccm, &header, &cipher, message, sizeof whole, BODY_LEN));
        for (size_t at = 0; at < BODY_LEN; at += piece) {
            const size_t len = at + piece < BODY_LEN ? piece : BODY_LEN - at;
            TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, message + TSR_MESSAGE_HEADER_LEN + at, len));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_seal(&ccm, message + TSR_MESSAGE_HEADER_LEN + BODY_LEN));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(whole, message, sizeof whole);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_message_open_start(&ccm, &header, &cipher, sizeof whole));
        for (size_t at = 0; at < BODY_LEN; at += piece) {
            const size_t len = at + piece < BODY_LEN ? piece : BODY_LEN - at;
            TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, message + TSR_MESSAGE_HEADER_LEN + at, len));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_open(&ccm, message + TSR_MESSAGE_HEADER_LEN + BODY_LEN));
        check_body(BODY_LEN);
    }
}

static void expect_refused(const struct tsr_message_header *claimed)
{
    TEST_ASSERT_EQUAL(TSR_ERR_AUTH, tsr_message_open(claimed, &cipher, message, message_len, &body_len));
    TEST_ASSERT_EQUAL(777, body_len);
    for (size_t i = 0; i < BODY_LEN; i++) {
        TEST_ASSERT_EQUAL_HEX8(0, message[TSR_MESSAGE_HEADER_LEN + i]);
    }
}

/* Origin and destination come from the fragments: they are sealed as the rest. */
static void test_every_field_is_authenticated(void)
{
    for (unsigned field = 0; field < 5; field++) {
        struct tsr_message_header claimed = header;
        seal(BODY_LEN);
        switch (field) {
        case 0: claimed.kind = TSR_MESSAGE_VIEW; break;
        case 1: claimed.key_use = TSR_KEY_PAIR; break;
        case 2: claimed.origin ^= 0x100; break;
        case 3: claimed.destination ^= 1; break;
        default: claimed.counter ^= 0x80000000u; break;
        }
        expect_refused(&claimed);
    }
    for (size_t bit = 0; bit < 8 * (BODY_LEN + TSR_CCM_TAG_LEN); bit++) {
        seal(BODY_LEN);
        message[TSR_MESSAGE_HEADER_LEN + bit / 8] ^= (uint8_t)(1u << bit % 8);
        expect_refused(&header);
    }
    seal(BODY_LEN);
    cipher = test_cipher(0x21);
    expect_refused(&header);
}

static void test_unknown_kinds_and_key_uses(void)
{
    struct tsr_message_header read;
    seal(BODY_LEN);
    for (unsigned kind = 0; kind < 256; kind++) {
        message[0] = (uint8_t)kind;
        TEST_ASSERT_EQUAL(kind >= 1 && kind <= 5 ? TSR_OK : TSR_ERR_FORMAT,
                          tsr_message_parse(message, message_len, 1, 2, &read));
    }
    message[0] = TSR_MESSAGE_WAKE;
    for (unsigned use = 0; use < 256; use++) {
        message[1] = (uint8_t)use;
        TEST_ASSERT_EQUAL(use == 1 || use == 2 ? TSR_OK : TSR_ERR_FORMAT,
                          tsr_message_parse(message, message_len, 1, 2, &read));
    }
}

static void test_limits(void)
{
    struct tsr_message_header read;
    struct tsr_ccm ccm;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_message_seal(&header, &cipher, message,
                                                      BODY_LEN + TSR_MESSAGE_OVERHEAD_LEN - 1, BODY_LEN, &message_len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_message_seal(&header, &cipher, message, sizeof message, BODY_MAX + 1, &message_len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_message_seal(&header, &cipher, message, sizeof message, SIZE_MAX, &message_len));
    TEST_ASSERT_EQUAL(777, message_len);
    for (size_t len = 0; len < TSR_MESSAGE_OVERHEAD_LEN; len++) {
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_message_parse(message, len, 1, 2, &read));
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_message_open_start(&ccm, &header, &cipher, len));
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_message_open(&header, &cipher, message, len, &body_len));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_round_trip);
    RUN_TEST(test_pieces);
    RUN_TEST(test_every_field_is_authenticated);
    RUN_TEST(test_unknown_kinds_and_key_uses);
    RUN_TEST(test_limits);
    return UNITY_END();
}
