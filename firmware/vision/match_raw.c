/*
 * Sums of absolute differences of gray values: docs/math.md, eq. (23).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>

typedef uint16_t column_sum;

static inline uint32_t term(uint8_t a, uint8_t b)
{
    return (uint32_t)(a > b ? a - b : b - a);
}

#define PLAIN_SUMS tsr_match_raw_sums
#include "match_plain_sums.h"
