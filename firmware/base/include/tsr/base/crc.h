/*
 * CRC-16 with the polynomial x^16 + x^12 + x^5 + 1, bits reflected.
 *
 * Two uses, told apart by their start value and final exclusive or:
 *   IEEE 802.15.4-2015, 7.2.11 FCS:     start 0x0000, final xor 0x0000
 *   RFC 1662, C.2 FCS-16 (link frames): start 0xffff, final xor 0xffff
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_CRC_H
#define TSR_BASE_CRC_H

#include <stddef.h>
#include <stdint.h>

#define TSR_CRC16_START_802154 0x0000u
#define TSR_CRC16_START_HDLC 0xffffu

/* Continue a CRC over len more bytes; starts with a TSR_CRC16_START_ value.
 * The result is sent least significant byte first. */
uint16_t tsr_crc16(uint16_t crc, const uint8_t *bytes, size_t len);

#endif
