/*
 * The sum of four bytes: the one thing of change detection that an instruction
 * set does faster. The order of bytes in a word does not matter.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_CHANGE_BYTES_H
#define TSR_VISION_CHANGE_BYTES_H

#include <stdint.h>

#if defined(__ARM_FEATURE_SIMD32)

static inline uint32_t tsr_change_add_bytes(uint32_t sum, uint32_t word)
{
    uint32_t result;
    __asm("usada8 %0, %1, %2, %3" : "=r"(result) : "r"(word), "r"(0), "r"(sum));
    return result;
}

#else

static inline uint32_t tsr_change_add_bytes(uint32_t sum, uint32_t word)
{
    uint32_t pairs = (word & 0x00ff00ffu) + (word >> 8 & 0x00ff00ffu);
    return sum + (pairs & 0xffffu) + (pairs >> 16);
}

#endif

#endif
