/*
 * The matcher's prefilter alone, in place: the clipped horizontal Sobel derivative.
 *
 *   P(x,y) = clip(round(x-Sobel / 4)) + cap, 0 .. 2 cap       docs/math.md, eq. (10)
 *
 * A board that captures the right view filters and sends it, and the one that
 * matches takes it with right_is_prefiltered (tsr/vision/match.h): the same map
 * as from the gray view, from a view that codes smaller. A row or column outside
 * the image is the nearest inside.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_PREFILTER_H
#define TSR_VISION_PREFILTER_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_PREFILTER_CAP_MAX 7 /* filtered pixels take 4 bits */
#define TSR_PREFILTER_SCRATCH_ALIGN 2

/* Scratch: the unfiltered row above, and vertical sums. */
#define TSR_PREFILTER_SCRATCH_LEN(width) (4u * (size_t)(width) + 4u)

/* Content belongs to the module. */
struct tsr_prefilter {
    struct tsr_gray frame;
    uint8_t *scratch;
    uint16_t rows_done;
    uint8_t cap;
};

/*
 * Begin filtering a view.
 *
 *   filter       filled; kept until run returns TSR_OK or the work is given up
 *   frame        [height][width] gray, in and out; kept as the filter. Sides 1 .. TSR_IMAGE_*_MAX
 *   cap          1 .. TSR_PREFILTER_CAP_MAX; the matcher's, tsr_match_prefilter_cap()
 *   scratch      [scratch_cap] kept as the frame, apart from it; aligned to TSR_PREFILTER_SCRATCH_ALIGN
 *   scratch_cap  bytes, >= TSR_PREFILTER_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer or a cap out of
 * range; TSR_ERR_SIZE for a side out of range or a stride < width;
 * TSR_ERR_NOBUF if scratch is too small. On error nothing is written, on TSR_OK only *filter.
 */
enum tsr_status tsr_prefilter_start(struct tsr_prefilter *filter, struct tsr_gray frame, uint8_t cap, uint8_t *scratch,
                                    size_t scratch_cap);

/*
 * Filter at most rows more rows, from the top. Row y is final as soon as it is
 * done and the rows below are still gray. The result does not depend on how the
 * rows are divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when all are filtered (and from
 * then on, doing nothing); TSR_ERR_ARG for a null filter or rows = 0.
 */
enum tsr_status tsr_prefilter_run(struct tsr_prefilter *filter, uint16_t rows);

#endif
