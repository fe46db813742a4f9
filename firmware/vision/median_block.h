/*
 * 3x3 medians of a block of a row's pixels.
 *
 * The nine values of a window are three columns, each sorted once for the three
 * windows that it is in. Of three sorted columns, sorted again by rank,
 *
 *     low_0 <= low_1 <= low_2        and low_i <= middle_i <= high_i,
 *     middle_0 .. 2, high_0 .. 2     so that what has ranks 1 to 4 of nine is among
 *                                    low_1, low_2, middle_0, middle_1 and high_0.
 *
 * Invalid values are the largest, and the lower median of n valid ones has rank
 * (n - 1) / 2, which is 1 to 4: docs/math.md, eqs. (18), (80).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MEDIAN_BLOCK_H
#define TSR_VISION_MEDIAN_BLOCK_H

#include <stdint.h>

#define TSR_MEDIAN_BLOCK 30
#define TSR_MEDIAN_COLUMNS (TSR_MEDIAN_BLOCK + 2)

/* The rows above, at and below the pixels, from the column before the first one on; invalid outside the map. */
struct tsr_median_block {
    _Alignas(4) uint16_t values[3][TSR_MEDIAN_COLUMNS];
};

void tsr_median_filter_block(const struct tsr_median_block *block, uint16_t medians[TSR_MEDIAN_BLOCK]);

#endif
