/*
 * 802.15.4 frames: layout, round trip, every flipped bit, limits, acknowledgements.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "mbedtls_aes.h"
#include "tsr/base/crc.h"
#include "tsr/wire/address.h"
#include "tsr/wire/frame.h"
#include "unity.h"

static struct tsr_cipher cipher;
static struct tsr_frame_header header;
static uint8_t payload[TSR_FRAME_PAYLOAD_MAX + 1];
static uint8_t psdu[TSR_FRAME_PSDU_MAX + 1];
static uint8_t opened[TSR_FRAME_PAYLOAD_MAX + 1];
static size_t psdu_len;
static size_t opened_len;

void setUp(void)
{
    const struct tsr_frame_header example = {0x42, true, 0xbeef, 0x0102, 0x0304, 0x05060708u};
    cipher = test_cipher(0x10);
    header = example;
    for (unsigned i = 0; i < sizeof payload; i++) {
        payload[i] = (uint8_t)(3 * i + 1);
    }
    memset(psdu, 0xee, sizeof psdu);
    memset(opened, 0xdd, sizeof opened);
    psdu_len = opened_len = 777;
}
void tearDown(void) {}

static void repair_fcs(uint8_t *bytes, size_t len)
{
    const uint16_t fcs = tsr_crc16(TSR_CRC16_START_802154, bytes, len - 2);
    bytes[len - 2] = (uint8_t)fcs;
    bytes[len - 1] = (uint8_t)(fcs >> 8);
}

static void test_header_octets(void)
{
    const uint8_t expected[TSR_FRAME_HEADER_LEN] = {0x69, 0x98, 0x42, 0xef, 0xbe, 0x02, 0x01, 0x04,
                                                    0x03, 0x0e, 0x08, 0x07, 0x06, 0x05, 0x01};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, 5, psdu, sizeof psdu, &psdu_len));
    TEST_ASSERT_EQUAL(5 + TSR_FRAME_OVERHEAD_LEN, psdu_len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, psdu, sizeof expected);
    TEST_ASSERT_EQUAL_HEX8(0xee, psdu[psdu_len]);
    header.ack_request = false;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, 5, psdu, sizeof psdu, &psdu_len));
    TEST_ASSERT_EQUAL_HEX8(0x49, psdu[0]);
}

static void test_round_trip_of_every_length(void)
{
    for (size_t len = 0; len <= TSR_FRAME_PAYLOAD_MAX; len++) {
        struct tsr_frame_header read;
        memset(&read, 0, sizeof read);
        header.ack_request = len % 2 == 0;
        header.counter = len == 0 ? 0 : 0xfffffffeu;
        TEST_ASSERT_EQUAL(
            TSR_OK, tsr_frame_seal(&header, &cipher, payload, len, psdu, len + TSR_FRAME_OVERHEAD_LEN, &psdu_len));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_parse(psdu, psdu_len, &read));
        TEST_ASSERT_EQUAL(header.sequence, read.sequence);
        TEST_ASSERT_EQUAL(header.ack_request, read.ack_request);
        TEST_ASSERT_EQUAL_HEX16(header.pan_id, read.pan_id);
        TEST_ASSERT_EQUAL_HEX16(header.destination, read.destination);
        TEST_ASSERT_EQUAL_HEX16(header.source, read.source);
        TEST_ASSERT_EQUAL_HEX32(header.counter, read.counter);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_open(psdu, psdu_len, &cipher, opened, len, &opened_len));
        TEST_ASSERT_EQUAL(len, opened_len);
        if (len > 0) {
            TEST_ASSERT_EQUAL_HEX8_ARRAY(payload, opened, len);
            TEST_ASSERT_TRUE(len < 8 || memcmp(payload, psdu + TSR_FRAME_HEADER_LEN, len) != 0);
        }
        TEST_ASSERT_EQUAL_HEX8(0xdd, opened[TSR_FRAME_PAYLOAD_MAX]);
    }
}

/* With the FCS as it was the frame is no frame; with the FCS made right again
 * the tag, which covers header and payload, refuses it. */
static void test_every_flipped_bit_is_refused(void)
{
    const size_t lens[] = {0, 1, 16, TSR_FRAME_PAYLOAD_MAX};
    for (unsigned i = 0; i < sizeof lens / sizeof lens[0]; i++) {
        TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, lens[i], psdu, sizeof psdu, &psdu_len));
        for (size_t bit = 0; bit < 8 * psdu_len; bit++) {
            struct tsr_frame_header read;
            uint8_t changed[TSR_FRAME_PSDU_MAX];
            memcpy(changed, psdu, psdu_len);
            changed[bit / 8] ^= (uint8_t)(1u << bit % 8);
            TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_frame_parse(changed, psdu_len, &read));
            TEST_ASSERT_EQUAL(TSR_ERR_FORMAT,
                              tsr_frame_open(changed, psdu_len, &cipher, opened, sizeof opened, &opened_len));
            if (bit < 8 * (psdu_len - TSR_FRAME_FCS_LEN)) {
                repair_fcs(changed, psdu_len);
                memset(opened, 0xdd, sizeof opened);
                const enum tsr_status status =
                    tsr_frame_open(changed, psdu_len, &cipher, opened, sizeof opened, &opened_len);
                TEST_ASSERT_TRUE(status == TSR_ERR_AUTH || status == TSR_ERR_FORMAT);
                TEST_ASSERT_EQUAL(777, opened_len);
                for (size_t k = 0; k < lens[i]; k++) { /* nothing of the text remains */
                    TEST_ASSERT_EQUAL_HEX8(status == TSR_ERR_AUTH ? 0 : 0xdd, opened[k]);
                }
            }
        }
    }
}

static void test_every_other_length_is_refused(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, 30, psdu, sizeof psdu, &psdu_len));
    for (size_t len = 0; len < psdu_len; len++) {
        struct tsr_frame_header read;
        uint8_t cut[TSR_FRAME_PSDU_MAX];
        memcpy(cut, psdu, len);
        if (len >= 2) {
            repair_fcs(cut, len);
        }
        if (len < TSR_FRAME_OVERHEAD_LEN) {
            TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_frame_parse(cut, len, &read));
        } else {
            TEST_ASSERT_EQUAL(TSR_ERR_AUTH, tsr_frame_open(cut, len, &cipher, opened, sizeof opened, &opened_len));
        }
    }
    uint8_t longer[TSR_FRAME_PSDU_MAX + 1] = {0};
    struct tsr_frame_header read;
    memcpy(longer, psdu, psdu_len);
    repair_fcs(longer, sizeof longer);
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_frame_parse(longer, sizeof longer, &read));
}

static void test_limits(void)
{
    const size_t max = TSR_FRAME_PAYLOAD_MAX;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_frame_seal(&header, &cipher, payload, max + 1, psdu, sizeof psdu, &psdu_len));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_frame_seal(&header, &cipher, payload, max, psdu, 126, &psdu_len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, max, psdu, 127, &psdu_len));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_frame_open(psdu, psdu_len, &cipher, opened, max - 1, &opened_len));
    TEST_ASSERT_EQUAL_HEX8(0xdd, opened[0]);
    TEST_ASSERT_EQUAL(777, opened_len);
    header.counter = 0xffffffffu;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_frame_seal(&header, &cipher, payload, 1, psdu, sizeof psdu, &psdu_len));
}

/* IEEE 802.15.4-2015, 9.2.3: a frame with the last counter is not taken either. */
static void test_worn_out_counter_is_not_parsed(void)
{
    struct tsr_frame_header read;
    header.counter = 0xfffffffeu;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, 4, psdu, sizeof psdu, &psdu_len));
    memset(psdu + 10, 0xff, 4);
    repair_fcs(psdu, psdu_len);
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_frame_parse(psdu, psdu_len, &read));
}

static void test_other_key_is_refused(void)
{
    const struct tsr_cipher other = test_cipher(0x11);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, 4, psdu, sizeof psdu, &psdu_len));
    TEST_ASSERT_EQUAL(TSR_ERR_AUTH, tsr_frame_open(psdu, psdu_len, &other, opened, sizeof opened, &opened_len));
}

static void test_acknowledgements(void)
{
    for (unsigned sequence = 0; sequence < 256; sequence++) {
        uint8_t ack[TSR_FRAME_ACK_LEN + 1];
        uint8_t read = 0;
        struct tsr_frame_header parsed;
        tsr_frame_write_ack((uint8_t)sequence, ack);
        TEST_ASSERT_EQUAL_HEX8(0x02, ack[0]);
        TEST_ASSERT_EQUAL_HEX8(0x00, ack[1]);
        TEST_ASSERT_EQUAL_HEX16(0, tsr_crc16(TSR_CRC16_START_802154, ack, TSR_FRAME_ACK_LEN));
        TEST_ASSERT_TRUE(tsr_frame_is_ack(ack, TSR_FRAME_ACK_LEN, &read));
        TEST_ASSERT_EQUAL(sequence, read);
        TEST_ASSERT_FALSE(tsr_frame_is_ack(ack, TSR_FRAME_ACK_LEN - 1, &read));
        TEST_ASSERT_FALSE(tsr_frame_is_ack(ack, TSR_FRAME_ACK_LEN + 1, &read));
        TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_frame_parse(ack, TSR_FRAME_ACK_LEN, &parsed));
        for (unsigned bit = 0; bit < 8 * TSR_FRAME_ACK_LEN; bit++) {
            ack[bit / 8] ^= (uint8_t)(1u << bit % 8);
            TEST_ASSERT_FALSE(tsr_frame_is_ack(ack, TSR_FRAME_ACK_LEN, &read));
            ack[bit / 8] ^= (uint8_t)(1u << bit % 8);
        }
    }
}

static void test_derived_address(void)
{
    const uint8_t expected[TSR_EUI64_LEN] = {0x02, 0x54, 0x53, 0x52, 0xbe, 0xef, 0x12, 0x34};
    uint8_t eui64[TSR_EUI64_LEN];
    tsr_eui64_derive(0xbeef, 0x1234, eui64);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, eui64, sizeof expected);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_header_octets);
    RUN_TEST(test_round_trip_of_every_length);
    RUN_TEST(test_every_flipped_bit_is_refused);
    RUN_TEST(test_every_other_length_is_refused);
    RUN_TEST(test_limits);
    RUN_TEST(test_worn_out_counter_is_not_parsed);
    RUN_TEST(test_other_key_is_refused);
    RUN_TEST(test_acknowledgements);
    RUN_TEST(test_derived_address);
    return UNITY_END();
}
