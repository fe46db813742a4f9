/*
 * Addresses of a site: 16-bit short addresses and the EUI-64 behind them.
 *
 * A node's EUI-64 is derived, not stored: 02-54-53-52 (a locally administered
 * prefix, "TSR"), then the PAN identifier, then the short address, both most
 * significant byte first. IEEE 802.15.4-2015, 9.3.3.1 puts it into the nonce
 * of frame security, so sender and receiver need no table.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_ADDRESS_H
#define TSR_WIRE_ADDRESS_H

#include <stdint.h>

#define TSR_ADDRESS_SINK UINT16_C(0x0000) /* behind the gateway, never on air as a MAC address */
#define TSR_ADDRESS_NODE_MIN UINT16_C(0x0001)
#define TSR_ADDRESS_NODE_MAX UINT16_C(0xfffd) /* 0xfffe means "no short address" */
#define TSR_ADDRESS_NONE UINT16_C(0xfffe)
#define TSR_ADDRESS_BROADCAST UINT16_C(0xffff)

#define TSR_EUI64_LEN 8

void tsr_eui64_derive(uint16_t pan_id, uint16_t address, uint8_t eui64[TSR_EUI64_LEN]);

#endif
