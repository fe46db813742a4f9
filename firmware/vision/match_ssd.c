/*
 * Sums of squared differences of gray values: docs/math.md, eq. (24).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>

typedef uint32_t column_sum;

static inline uint32_t term(uint8_t a, uint8_t b)
{
    int difference = a - b;
    return (uint32_t)(difference * difference);
}

#define PLAIN_SUMS tsr_match_ssd_sums
#include "match_plain_sums.h"
