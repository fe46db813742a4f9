/*
 * One row of the prefilter in portable C, eq. (10): the matcher's and tsr/vision/prefilter.h's.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_PREFILTER_ROW_H
#define TSR_VISION_PREFILTER_ROW_H

#include <stdbool.h>

#include "tsr/base/image.h"

/* Filter row y of a frame in place, mirrored if asked; rows in ascending order. above, [width], keeps the unfiltered
 * row from call to call, sums has room for width + 2. */
void tsr_prefilter_row(const struct tsr_gray *frame, unsigned y, int cap, bool mirror, uint8_t *above, uint16_t *sums);

#endif
