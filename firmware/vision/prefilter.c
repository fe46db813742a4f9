/*
 * The prefilter alone: checks, and rows from the top.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/prefilter.h"

#include "prefilter_row.h"

enum tsr_status tsr_prefilter_start(struct tsr_prefilter *filter, struct tsr_gray frame, uint8_t cap, uint8_t *scratch,
                                    size_t scratch_cap)
{
    if (filter == NULL || frame.pixels == NULL || scratch == NULL || cap < 1 || cap > TSR_PREFILTER_CAP_MAX ||
        (uintptr_t)scratch % TSR_PREFILTER_SCRATCH_ALIGN != 0) {
        return TSR_ERR_ARG;
    }
    if (frame.width < 1 || frame.width > TSR_IMAGE_WIDTH_MAX || frame.height < 1 ||
        frame.height > TSR_IMAGE_HEIGHT_MAX || frame.stride < frame.width) {
        return TSR_ERR_SIZE;
    }
    if (scratch_cap < TSR_PREFILTER_SCRATCH_LEN(frame.width)) {
        return TSR_ERR_NOBUF;
    }
    *filter = (struct tsr_prefilter){frame, scratch, 0, cap};
    return TSR_OK;
}

enum tsr_status tsr_prefilter_run(struct tsr_prefilter *filter, uint16_t rows)
{
    if (filter == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    uint16_t *sums = (uint16_t *)(void *)filter->scratch;
    uint8_t *above = filter->scratch + 2u * ((size_t)filter->frame.width + 2u);
    for (; rows > 0 && filter->rows_done < filter->frame.height; rows--, filter->rows_done++) {
        tsr_prefilter_row(&filter->frame, filter->rows_done, filter->cap, false, above, sums);
    }
    return filter->rows_done < filter->frame.height ? TSR_AGAIN : TSR_OK;
}
