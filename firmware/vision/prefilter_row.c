/*
 * One row of the clipped horizontal Sobel derivative, in place.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "prefilter_row.h"

#include <string.h>

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
