/*
 * EUI-64 of a node, from its site and short address.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/address.h"

void tsr_eui64_derive(uint16_t pan_id, uint16_t address, uint8_t eui64[TSR_EUI64_LEN])
{
    eui64[0] = 0x02;
    eui64[1] = 0x54;
    eui64[2] = 0x53;
    eui64[3] = 0x52;
    eui64[4] = (uint8_t)(pan_id >> 8);
    eui64[5] = (uint8_t)pan_id;
    eui64[6] = (uint8_t)(address >> 8);
    eui64[7] = (uint8_t)address;
}
