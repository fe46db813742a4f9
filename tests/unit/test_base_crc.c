/*
 * CRC-16: published check values, pieces, detection of short bursts.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/base/crc.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static const uint8_t digits[] = "123456789";

/* Catalogue of parametrised CRC algorithms (G. Cook): CRC-16/KERMIT, CRC-16/IBM-SDLC. */
static void test_check_values(void)
{
    TEST_ASSERT_EQUAL_HEX16(0x2189, tsr_crc16(TSR_CRC16_START_802154, digits, 9));
    TEST_ASSERT_EQUAL_HEX16(0x906e, tsr_crc16(TSR_CRC16_START_HDLC, digits, 9) ^ 0xffffu);
    TEST_ASSERT_EQUAL_HEX16(0x1234, tsr_crc16(0x1234, digits, 0));
}

/* IEEE 802.15.4-2015, 7.2.11: the example of an acknowledgement with sequence 0x56. */
static void test_example_of_the_standard(void)
{
    const uint8_t ack[3] = {0x02, 0x00, 0x56};
    const uint16_t fcs = tsr_crc16(TSR_CRC16_START_802154, ack, sizeof ack);
    uint8_t sent[5];
    memcpy(sent, ack, sizeof ack);
    sent[3] = (uint8_t)fcs;
    sent[4] = (uint8_t)(fcs >> 8);
    TEST_ASSERT_EQUAL_HEX16(0, tsr_crc16(TSR_CRC16_START_802154, sent, sizeof sent)); /* the residue */
}

static void test_pieces_of_any_size(void)
{
    const uint16_t whole = tsr_crc16(TSR_CRC16_START_HDLC, digits, 9);
    for (size_t a = 0; a <= 9; a++) {
        for (size_t b = a; b <= 9; b++) {
            uint16_t crc = tsr_crc16(TSR_CRC16_START_HDLC, digits, a);
            crc = tsr_crc16(crc, digits + a, b - a);
            TEST_ASSERT_EQUAL_HEX16(whole, tsr_crc16(crc, digits + b, 9 - b));
        }
    }
}

/* A 16-bit CRC detects every burst of up to 16 bits. */
static void test_every_short_burst_is_seen(void)
{
    uint8_t bytes[8] = {0};
    const uint16_t right = tsr_crc16(0, bytes, sizeof bytes);
    for (unsigned burst = 1; burst < 0x10000u; burst += 2) {
        for (unsigned at = 0; at < 8; at++) {
            const uint32_t bits = (uint32_t)burst << at;
            bytes[2] = (uint8_t)bits;
            bytes[3] = (uint8_t)(bits >> 8);
            bytes[4] = (uint8_t)(bits >> 16);
            TEST_ASSERT_TRUE(tsr_crc16(0, bytes, sizeof bytes) != right);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_values);
    RUN_TEST(test_example_of_the_standard);
    RUN_TEST(test_pieces_of_any_size);
    RUN_TEST(test_every_short_burst_is_seen);
    return UNITY_END();
}
