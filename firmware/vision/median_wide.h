/*
 * The 5x5 row of the median.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MEDIAN_WIDE_H
#define TSR_VISION_MEDIAN_WIDE_H

#include "tsr/vision/median.h"

/* On one pixel at a time median_wide.c is faster, on vectors of them median_wide_block.c. */
#if defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'
#define TSR_MEDIAN_SLIDES
#endif

#define TSR_MEDIAN_WIDE_RADIUS 2u

/* How many of the columns or rows of a window around i lie in 0 .. len - 1. */
static inline unsigned tsr_median_count_inside(unsigned i, unsigned len)
{
    unsigned before = i < TSR_MEDIAN_WIDE_RADIUS ? i : TSR_MEDIAN_WIDE_RADIUS;
    unsigned behind = len - 1u - i < TSR_MEDIAN_WIDE_RADIUS ? len - 1u - i : TSR_MEDIAN_WIDE_RADIUS;
    return before + 1u + behind;
}

/* Rows 0 .. y - 1 are done. */
void tsr_median_filter_wide_row(const struct tsr_median *median, unsigned y);

#endif
