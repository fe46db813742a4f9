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

/* Rows 0 .. y - 1 are done. */
void tsr_median_filter_wide_row(const struct tsr_median *median, unsigned y);

#endif
