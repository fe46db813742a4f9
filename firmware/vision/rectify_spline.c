/*
 * Cubic B-splines in integers: exact weights down the grid's columns, forward
 * differences along the row.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "rectify_spline.h"

#include <string.h>

/* Round to nearest, ties up. |value| + divisor fits 31 bits. */
static int32_t round_divide(int32_t value, int32_t divisor)
{
    int32_t raised = value + divisor / 2;
    return raised >= 0 ? raised / divisor : -((divisor - 1 - raised) / divisor);
}

/* value 2^exponent, rounded as above. */
static int32_t round_scale(int32_t value, int exponent)
{
    if (exponent >= 0) {
        return value * ((int32_t)1 << exponent);
    }
    unsigned shift = (unsigned)-exponent;
    return tsr_rectify_floor_shift(value + ((int32_t)1 << (shift - 1u)), shift);
}

void tsr_rectify_row_start(struct tsr_rectify_row *row, const struct tsr_rectify_table *table,
                           enum tsr_rectify_side side, unsigned y)
{
    memset(row, 0, sizeof *row);
    row->step_log2 = table->step_log2;
    row->grid_row_len = TSR_RECTIFY_POINT_LEN * TSR_RECTIFY_POINTS(table->width, table->step_log2);
    const uint32_t half = 1u << (TSR_RECTIFY_SUM_FRACTION_BITS - 9);
    row->middle[0] = ((uint32_t)table->source_width / 2u << TSR_RECTIFY_SUM_FRACTION_BITS) + half;
    row->middle[1] = ((uint32_t)table->source_height / 2u << TSR_RECTIFY_SUM_FRACTION_BITS) + half;
    row->point = table->grid[side] + row->grid_row_len * (y >> table->step_log2);
    /* Eq. (61): 6 S^3 B_k(t / S), of sum 6 S^3. */
    int32_t step = (int32_t)1 << table->step_log2;
    int32_t t = (int32_t)(y & (unsigned)(step - 1));
    int32_t rest = step - t;
    row->weight[0] = rest * rest * rest;
    row->weight[1] = 3 * t * t * (t - 2 * step) + 4 * step * step * step;
    row->weight[2] = 3 * rest * rest * (rest - 2 * step) + 4 * step * step * step;
    row->weight[3] = t * t * t;
    for (unsigned i = 0; i < 3; i++) {
        tsr_rectify_row_advance(row);
    }
}

static int32_t read_i16(const uint8_t *bytes)
{
    return (int16_t)(uint16_t)(bytes[0] | (unsigned)bytes[1] << 8);
}

/* Eq. (62): the weighted points as a row coefficient. */
static int32_t blend_points(const struct tsr_rectify_row *row, const uint8_t *point)
{
    int64_t sum = 0;
    for (unsigned k = 0; k < 4; k++) {
        sum += (int64_t)row->weight[k] * read_i16(point + k * row->grid_row_len);
    }
    /* 3072 = 6 * 8^3 times the point: the step's share of the weights goes first. */
    unsigned shift = 3u * row->step_log2 - 9u;
    int64_t raised = sum + ((int64_t)1 << shift >> 1);
    int64_t shifted = raised >= 0 ? raised >> shift : ~(~raised >> shift);
    return round_divide((int32_t)shifted, 24);
}

void tsr_rectify_row_advance(struct tsr_rectify_row *row)
{
    for (unsigned axis = 0; axis < 2; axis++) {
        int32_t *coefficient = row->coefficient[axis];
        coefficient[0] = coefficient[1];
        coefficient[1] = coefficient[2];
        coefficient[2] = coefficient[3];
        coefficient[3] = blend_points(row, row->point + 2u * axis);
    }
    row->point += TSR_RECTIFY_POINT_LEN;
}

void tsr_rectify_row_next_span(struct tsr_rectify_row *row, struct tsr_rectify_cubic cubic[2])
{
    tsr_rectify_row_advance(row);
    int log2 = (int)row->step_log2;
    for (unsigned axis = 0; axis < 2; axis++) {
        const int32_t *v = row->coefficient[axis];
        int32_t slope = v[2] - v[0];
        int32_t bend = v[0] - 2 * v[1] + v[2];
        int32_t twist = v[3] - v[0] + 3 * (v[1] - v[2]);
        int32_t third = round_scale(twist, 8 - 3 * log2);
        int32_t first = round_scale(slope, 7 - log2) + round_scale(bend, 7 - 2 * log2) +
                        round_divide(twist, 3 * ((int32_t)1 << (3 * log2 - 7)));
        cubic[axis].position = row->middle[axis] + (uint32_t)v[1] * 256u + (uint32_t)round_divide(bend * 128, 3);
        cubic[axis].first = (uint32_t)first;
        cubic[axis].second = (uint32_t)(round_scale(bend, 8 - 2 * log2) + third);
        cubic[axis].third = (uint32_t)third;
    }
}
