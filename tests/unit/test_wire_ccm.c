/*
 * AES-CCM*: RFC 3610 packet vectors, pieces of every size, refusals.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "mbedtls_aes.h"
#include "tsr/wire/ccm.h"
#include "unity.h"

static struct tsr_cipher cipher;

/* Ops that fail at block number failing_block. */
static unsigned blocks;
static unsigned failing_block;

static enum tsr_status encrypt_or_fail(const struct tsr_aes_key *expanded, const uint8_t in[TSR_AES_BLOCK_LEN],
                                       uint8_t out[TSR_AES_BLOCK_LEN])
{
    return ++blocks == failing_block ? TSR_ERR_IO : test_aes_encrypt(expanded, in, out);
}

static const struct tsr_aes_ops failing_ops = {test_aes_expand, encrypt_or_fail};

void setUp(void)
{
    cipher = test_cipher(0xc0);
    blocks = 0;
    failing_block = 0;
}
void tearDown(void) {}

#define AAD_LEN 8u

static void fill_counting(uint8_t *bytes, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        bytes[i] = (uint8_t)i;
    }
}

/* Seal len counting bytes, the first 8 in clear, in pieces. */
static void seal_in_pieces(const uint8_t nonce[TSR_CCM_NONCE_LEN], uint8_t *packet, size_t len, size_t piece,
                           uint8_t tag[TSR_CCM_TAG_LEN])
{
    struct tsr_ccm ccm;
    fill_counting(packet, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_start(&ccm, &cipher, nonce, packet, AAD_LEN, len - AAD_LEN, 1));
    for (size_t at = AAD_LEN; at < len; at += piece) {
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, packet + at, at + piece < len ? piece : len - at));
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_seal(&ccm, tag));
}

static void check_vector(const uint8_t nonce[TSR_CCM_NONCE_LEN], size_t len, const uint8_t *text,
                         const uint8_t expected_tag[TSR_CCM_TAG_LEN])
{
    for (size_t piece = 1; piece <= len; piece++) {
        uint8_t packet[32];
        uint8_t tag[TSR_CCM_TAG_LEN];
        seal_in_pieces(nonce, packet, len, piece, tag);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(text, packet + AAD_LEN, len - AAD_LEN);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected_tag, tag, sizeof tag);
        struct tsr_ccm ccm;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_start(&ccm, &cipher, nonce, packet, AAD_LEN, len - AAD_LEN, 0));
        for (size_t at = AAD_LEN; at < len; at += piece) {
            TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, packet + at, at + piece < len ? piece : len - at));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_open(&ccm, tag));
        for (size_t i = 0; i < len; i++) {
            TEST_ASSERT_EQUAL_HEX8(i, packet[i]);
        }
    }
}

/* RFC 3610, section 8, packet vectors 1 and 2: M = 8, L = 2. */
static void test_packet_vector_1(void)
{
    const uint8_t nonce[] = {0, 0, 0, 3, 2, 1, 0, 0xa0, 0xa1, 0xa2, 0xa3, 0xa4, 0xa5};
    const uint8_t text[] = {0x58, 0x8c, 0x97, 0x9a, 0x61, 0xc6, 0x63, 0xd2, 0xf0, 0x66, 0xd0, 0xc2,
                            0xc0, 0xf9, 0x89, 0x80, 0x6d, 0x5f, 0x6b, 0x61, 0xda, 0xc3, 0x84};
    const uint8_t tag[] = {0x17, 0xe8, 0xd1, 0x2c, 0xfd, 0xf9, 0x26, 0xe0};
    check_vector(nonce, 31, text, tag);
}

static void test_packet_vector_2(void)
{
    const uint8_t nonce[] = {0, 0, 0, 4, 3, 2, 1, 0xa0, 0xa1, 0xa2, 0xa3, 0xa4, 0xa5};
    const uint8_t text[] = {0x72, 0xc9, 0x1a, 0x36, 0xe1, 0x35, 0xf8, 0xcf, 0x29, 0x1c, 0xa8, 0x94,
                            0x08, 0x5c, 0x87, 0xe3, 0xcc, 0x15, 0xc4, 0x39, 0xc9, 0xe4, 0x3a, 0x3b};
    const uint8_t tag[] = {0xa0, 0x91, 0xd5, 0x6e, 0x10, 0x40, 0x09, 0x16};
    check_vector(nonce, 32, text, tag);
}

/* Lengths around the block and the limits of both inputs: what is sealed opens,
 * and a changed text, tag, nonce or header does not. */
static void check_refusals(size_t aad_len, size_t text_len)
{
    static uint8_t text[TSR_CCM_TEXT_MAX];
    uint8_t aad[TSR_CCM_AAD_MAX];
    uint8_t nonce[TSR_CCM_NONCE_LEN] = {1, 2, 3};
    uint8_t tag[TSR_CCM_TAG_LEN];
    struct tsr_ccm ccm;
    fill_counting(aad, sizeof aad);
    for (unsigned change = 0; change < 5; change++) {
        fill_counting(text, text_len);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_start(&ccm, &cipher, nonce, aad, aad_len, text_len, 1));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, text, text_len));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_seal(&ccm, tag));
        uint8_t *changed = change == 1   ? (text_len > 0 ? &text[text_len - 1] : NULL)
                           : change == 2 ? &tag[TSR_CCM_TAG_LEN - 1]
                           : change == 3 ? &nonce[12]
                           : change == 4 ? (aad_len > 0 ? &aad[aad_len - 1] : NULL)
                                         : NULL;
        if (changed != NULL) {
            *changed ^= 0x80;
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_start(&ccm, &cipher, nonce, aad, aad_len, text_len, 0));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, text, text_len));
        TEST_ASSERT_EQUAL(changed == NULL ? TSR_OK : TSR_ERR_AUTH, tsr_ccm_open(&ccm, tag));
        if (changed != NULL) {
            *changed ^= 0x80;
        }
    }
}

static void test_any_change_is_refused(void)
{
    const size_t lengths[] = {0, 1, 13, 14, 15, 16, 17, 31, 32, 33, 63, 64};
    for (unsigned a = 0; a < sizeof lengths / sizeof lengths[0]; a++) {
        for (unsigned t = 0; t < sizeof lengths / sizeof lengths[0]; t++) {
            check_refusals(lengths[a], lengths[t]);
        }
    }
    check_refusals(15, TSR_CCM_TEXT_MAX);
}

static void test_arguments(void)
{
    struct tsr_ccm ccm;
    uint8_t nonce[TSR_CCM_NONCE_LEN] = {0};
    uint8_t bytes[TSR_CCM_AAD_MAX + 1] = {0};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_ccm_start(NULL, &cipher, nonce, bytes, 1, 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_ccm_start(&ccm, NULL, nonce, bytes, 1, 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_ccm_start(&ccm, &cipher, NULL, bytes, 1, 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_ccm_start(&ccm, &cipher, nonce, NULL, 1, 1, 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_start(&ccm, &cipher, nonce, NULL, 0, 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_ccm_start(&ccm, &cipher, nonce, bytes, TSR_CCM_AAD_MAX + 1, 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_ccm_start(&ccm, &cipher, nonce, bytes, 1, TSR_CCM_TEXT_MAX + 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_cipher_init(NULL, &test_aes_ops, bytes));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_cipher_init(&cipher, NULL, bytes));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_cipher_init(&cipher, &test_aes_ops, NULL));
}

static void test_announced_length_is_kept(void)
{
    struct tsr_ccm ccm;
    uint8_t nonce[TSR_CCM_NONCE_LEN] = {0};
    uint8_t text[20] = {0};
    uint8_t tag[TSR_CCM_TAG_LEN];
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_start(&ccm, &cipher, nonce, NULL, 0, 19, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_ccm_update(&ccm, text, 20));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, text, 18));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_ccm_seal(&ccm, tag));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_ccm_open(&ccm, tag));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_update(&ccm, text, 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_ccm_seal(&ccm, tag));
}

/* A cipher that fails at any block makes the sealing fail, not a weak text. */
static void test_cipher_fails_at_every_block(void)
{
    struct tsr_cipher failing = cipher;
    failing.ops = &failing_ops;
    const uint8_t nonce[TSR_CCM_NONCE_LEN] = {0};
    for (failing_block = 1;; failing_block++) {
        struct tsr_ccm ccm;
        uint8_t text[40] = {0};
        uint8_t tag[TSR_CCM_TAG_LEN];
        blocks = 0;
        enum tsr_status status = tsr_ccm_start(&ccm, &failing, nonce, text, 20, sizeof text, 1);
        if (status == TSR_OK) {
            status = tsr_ccm_update(&ccm, text, sizeof text);
        }
        if (status == TSR_OK) {
            status = tsr_ccm_seal(&ccm, tag);
        }
        if (status == TSR_OK) {
            break;
        }
        TEST_ASSERT_EQUAL(TSR_ERR_IO, status);
    }
    TEST_ASSERT_EQUAL(1 + 2 + 3 + 3 + 1 + 1, failing_block); /* B0, header, text twice, tag; none failed */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_packet_vector_1);
    RUN_TEST(test_packet_vector_2);
    RUN_TEST(test_any_change_is_refused);
    RUN_TEST(test_arguments);
    RUN_TEST(test_announced_length_is_kept);
    RUN_TEST(test_cipher_fails_at_every_block);
    return UNITY_END();
}
