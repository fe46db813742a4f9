/*
 * Sums of squared differences of gray values: docs/math.md, eqs. (24), (25).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>

typedef uint32_t window_sum;
typedef uint32_t column_sum;

static inline uint32_t term(uint8_t a, uint8_t b)
{
    int difference = a - b;
    return (uint32_t)(difference * difference);
}

static inline uint32_t offset_divisor(uint32_t below, uint32_t above)
{
    return below + above;
}

#define PLAIN_SUMS tsr_match_ssd_sums
#include "match_plain_sums.h"
