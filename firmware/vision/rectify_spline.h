/*
 * One target row of a rectification grid, span by span.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_RECTIFY_SPLINE_H
#define TSR_VISION_RECTIFY_SPLINE_H

#include "tsr/vision/rectify.h"

/* Fraction bits of a position while it is added up, px. */
#define TSR_RECTIFY_SUM_FRACTION_BITS 21

/* A row between the grid's rows: row coefficients of x and y in px, Q18.13,
 * relative to the source's middle. */
struct tsr_rectify_row {
    const uint8_t *point; /* in the first of four grid rows: the next column */
    size_t grid_row_len;
    unsigned step_log2;
    uint32_t middle[2]; /* of the source, px, Q10.21, and half of the last bit that is kept, to round */
    int32_t weight[4];
    int32_t coefficient[2][4]; /* of x and y; the last four columns */
};

/* A coordinate on S pixels: the position in the source, with the rounding added
 * that clipping cuts off, and its forward differences: px, Q10.21 modulo 2^32,
 * so that sums that leave the range on the way do no harm. Every position is
 * inside -512 .. 832 px. */
struct tsr_rectify_cubic {
    uint32_t position;
    uint32_t first;
    uint32_t second;
    uint32_t third;
};

/* Ready for the first span of target row y. */
void tsr_rectify_row_start(struct tsr_rectify_row *row, const struct tsr_rectify_table *table,
                           enum tsr_rectify_side side, unsigned y);

/* Take one more column into coefficient[.][3], the older ones move down. */
void tsr_rectify_row_advance(struct tsr_rectify_row *row);

/* The cubics of the next span, x first; docs/math.md, eq. (63). */
void tsr_rectify_row_next_span(struct tsr_rectify_row *row, struct tsr_rectify_cubic cubic[2]);

/* To the next pixel. */
static inline void tsr_rectify_step(struct tsr_rectify_cubic *cubic)
{
    cubic->position += cubic->first;
    cubic->first += cubic->second;
    cubic->second += cubic->third;
}

/* floor(value / 2^shift). */
static inline int32_t tsr_rectify_floor_shift(int32_t value, unsigned shift)
{
    return value >= 0 ? value >> shift : ~(~value >> shift);
}

/* A position in px, Q24.8, clipped to 0 .. last; docs/math.md, eq. (65). */
static inline int32_t tsr_rectify_clip_position(uint32_t sum, int32_t last_q8)
{
    int32_t position = tsr_rectify_floor_shift((int32_t)sum, TSR_RECTIFY_SUM_FRACTION_BITS - 8);
    if ((uint32_t)position > (uint32_t)last_q8) {
        position = position < 0 ? 0 : last_q8;
    }
    return position;
}

#endif
