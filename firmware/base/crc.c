/*
 * CRC-16, four bits at a time: 32 bytes of table.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/base/crc.h"

/* Remainders of the 16 nibbles for the reflected polynomial 0x8408. */
static const uint16_t nibble_remainder[16] = {
    0x0000, 0x1081, 0x2102, 0x3183, 0x4204, 0x5285, 0x6306, 0x7387,
    0x8408, 0x9489, 0xa50a, 0xb58b, 0xc60c, 0xd68d, 0xe70e, 0xf78f,
};

uint16_t tsr_crc16(uint16_t crc, const uint8_t *bytes, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        crc = (uint16_t)(crc >> 4 ^ nibble_remainder[(crc ^ bytes[i]) & 15u]);
        crc = (uint16_t)(crc >> 4 ^ nibble_remainder[(crc ^ bytes[i] >> 4) & 15u]);
    }
    return crc;
}
