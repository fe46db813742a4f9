/*
 * The 5x5 row of the median.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MEDIAN_WIDE_H
#define TSR_VISION_MEDIAN_WIDE_H

#include "tsr/vision/median.h"

/* Rows 0 .. y - 1 are done. */
void tsr_median_filter_wide_row(const struct tsr_median *median, unsigned y);

#endif
