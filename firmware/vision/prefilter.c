/*
 * The clipped horizontal Sobel derivative, in place.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/prefilter.h"

#include <string.h>

#include "prefilter_row.h"

/* The Sobel sum lies in -1020 .. 1020; a multiple of 4 keeps it positive while it is divided. */
#define SOBEL_BIAS 1024

/* sums[x + 1] = a + 2 b + c of column x; the columns at both ends are replicated. */
static void add_vertically(const uint8_t *restrict above, const uint8_t *restrict row, const uint8_t *restrict below,
                           uint16_t *restrict sums, unsigned width)
{
    for (unsigned x = 0; x < width; x++) {
        sums[x + 1] = (uint16_t)(above[x] + 2 * row[x] + below[x]);
    }
    sums[0] = sums[1];
    sums[width + 1] = sums[width];
}

static uint8_t clip_derivative(const uint16_t *sums, unsigned x, int cap)
{
    int value = (int)((unsigned)(sums[x + 2] - sums[x] + SOBEL_BIAS + 2) / 4u) - SOBEL_BIAS / 4;
    value = value < -cap ? -cap : value;
    value = value > cap ? cap : value;
    return (uint8_t)(value + cap);
}

void tsr_prefilter_row(const struct tsr_gray *frame, unsigned y, int cap, bool mirror, uint8_t *above, uint16_t *sums)
{
    unsigned width = frame->width;
    uint8_t *row = frame->pixels + (size_t)y * frame->stride;
    const uint8_t *below = y + 1u < frame->height ? row + frame->stride : row;
    if (y == 0) {
        memcpy(above, row, width);
    }
    add_vertically(above, row, below, sums, width);
    memcpy(above, row, width);
    if (mirror) {
        for (unsigned x = 0; x < width; x++) {
            row[x] = clip_derivative(sums, width - 1u - x, cap);
        }
    } else {
        for (unsigned x = 0; x < width; x++) {
            row[x] = clip_derivative(sums, x, cap);
        }
    }
}

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
