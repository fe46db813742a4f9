/*
 * Sums of absolute differences of gray values: docs/math.md, eqs. (23), (16).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>

typedef uint16_t window_sum;
typedef uint16_t column_sum;

static inline uint32_t term(uint8_t a, uint8_t b)
{
    return (uint32_t)(a > b ? a - b : b - a);
}

static inline uint32_t offset_divisor(uint32_t below, uint32_t above)
{
    return below > above ? below : above;
}

#define PLAIN_SUMS tsr_match_raw_sums
#include "match_plain_sums.h"
