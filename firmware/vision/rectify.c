/*
 * Resampling of a view, row by row, into another frame or in place.
 *
 * In place, target row y overwrites source row y. Before that the source row is
 * copied to the kept rows, a ring of the last rows_above + 1 of them; source
 * rows below y are still in the frame.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/rectify.h"

#include <stdbool.h>
#include <string.h>

#include "rectify_spline.h"

#define POSITION_FRACTION_BITS 8
#define POSITION_FRACTION 255

/* The source rows that the last pixel was read from. */
struct rows {
    int32_t upper_row; /* px */
    const uint8_t *upper;
    const uint8_t *lower;
};

static bool has_shape(uint16_t width, uint16_t height, uint16_t stride, uint16_t table_width, uint16_t table_height)
{
    return width == table_width && height == table_height && stride >= width;
}

static bool is_known_side(enum tsr_rectify_side side)
{
    return side == TSR_RECTIFY_LEFT || side == TSR_RECTIFY_RIGHT;
}

enum tsr_status tsr_rectify_start(struct tsr_rectify *rectify, const struct tsr_rectify_table *table,
                                  enum tsr_rectify_side side, struct tsr_gray_view source, struct tsr_gray target)
{
    if (rectify == NULL || table == NULL || source.pixels == NULL || target.pixels == NULL || !is_known_side(side)) {
        return TSR_ERR_ARG;
    }
    if (!has_shape(source.width, source.height, source.stride, table->source_width, table->source_height) ||
        !has_shape(target.width, target.height, target.stride, table->width, table->height)) {
        return TSR_ERR_SIZE;
    }
    *rectify = (struct tsr_rectify){table, source, target, NULL, 0, 0, (uint8_t)side};
    return TSR_OK;
}

enum tsr_status tsr_rectify_start_in_place(struct tsr_rectify *rectify, const struct tsr_rectify_table *table,
                                           enum tsr_rectify_side side, struct tsr_gray frame, uint8_t *kept,
                                           size_t kept_cap)
{
    if (kept == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_rectify begun;
    enum tsr_status status =
        tsr_rectify_start(rectify == NULL ? NULL : &begun, table, side, tsr_gray_as_view(frame), frame);
    if (status != TSR_OK) {
        return status;
    }
    if (kept_cap < TSR_RECTIFY_KEPT_LEN(frame.width, table->rows_above[side])) {
        return TSR_ERR_NOBUF;
    }
    begun.kept = kept;
    begun.kept_rows = (uint16_t)(table->rows_above[side] + 1u);
    *rectify = begun;
    return TSR_OK;
}

static const uint8_t *find_row(const struct tsr_rectify *rectify, unsigned y, unsigned source_row)
{
    if (rectify->kept != NULL && source_row <= y) {
        return rectify->kept + (size_t)rectify->source.width * (source_row % rectify->kept_rows);
    }
    return rectify->source.pixels + (size_t)rectify->source.stride * source_row;
}

static struct rows select_rows(const struct tsr_rectify *rectify, unsigned y, int32_t upper_row)
{
    unsigned upper = (unsigned)upper_row;
    unsigned lower = upper + 1u < rectify->source.height ? upper + 1u : upper;
    struct rows rows = {upper_row, find_row(rectify, y, upper), find_row(rectify, y, lower)};
    return rows;
}

/* Eq. (66). */
static inline uint8_t sample(const struct rows *rows, int32_t x_q8, int32_t y_part)
{
    int32_t column = x_q8 >> POSITION_FRACTION_BITS;
    int32_t x_part = x_q8 & POSITION_FRACTION;
    int32_t next = column + (x_part != 0 ? 1 : 0);
    int32_t upper = rows->upper[column] * 256 + (rows->upper[next] - rows->upper[column]) * x_part;
    int32_t lower = rows->lower[column] * 256 + (rows->lower[next] - rows->lower[column]) * x_part;
    return (uint8_t)((upper * 256 + (lower - upper) * y_part + 32768) >> 16);
}

/* count pixels of target row y. The cubics are copies: registers. */
static struct rows rectify_span(const struct tsr_rectify *rectify, unsigned y, struct rows rows,
                                struct tsr_rectify_cubic across, struct tsr_rectify_cubic down, uint8_t *target,
                                unsigned count)
{
    const int32_t last_x_q8 = (rectify->source.width - 1) * 256;
    const int32_t last_y_q8 = (rectify->source.height - 1) * 256;
    for (unsigned i = 0; i < count; i++) {
        int32_t y_q8 = tsr_rectify_clip_position(down.position, last_y_q8);
        if (y_q8 >> POSITION_FRACTION_BITS != rows.upper_row) {
            rows = select_rows(rectify, y, y_q8 >> POSITION_FRACTION_BITS);
        }
        target[i] = sample(&rows, tsr_rectify_clip_position(across.position, last_x_q8), y_q8 & POSITION_FRACTION);
        tsr_rectify_step(&across);
        tsr_rectify_step(&down);
    }
    return rows;
}

static void rectify_row(const struct tsr_rectify *rectify, unsigned y)
{
    const unsigned width = rectify->table->width;
    const unsigned step = 1u << rectify->table->step_log2;
    uint8_t *target = rectify->target.pixels + (size_t)rectify->target.stride * y;
    if (rectify->kept != NULL) {
        memcpy(rectify->kept + (size_t)width * (y % rectify->kept_rows), target, width);
    }
    struct rows rows = select_rows(rectify, y, 0);
    struct tsr_rectify_row row;
    struct tsr_rectify_cubic cubic[2];
    tsr_rectify_row_start(&row, rectify->table, (enum tsr_rectify_side)rectify->side, y);
    for (unsigned first = 0; first < width; first += step) {
        const unsigned count = width - first < step ? width - first : step;
        tsr_rectify_row_next_span(&row, cubic);
        rows = rectify_span(rectify, y, rows, cubic[0], cubic[1], target + first, count);
    }
}

enum tsr_status tsr_rectify_run(struct tsr_rectify *rectify, uint16_t rows)
{
    if (rectify == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    for (; rows > 0 && rectify->rows_done < rectify->table->height; rows--, rectify->rows_done++) {
        rectify_row(rectify, rectify->rows_done);
    }
    return rectify->rows_done < rectify->table->height ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_rectify_rows_done(const struct tsr_rectify *rectify)
{
    return rectify->rows_done;
}

void tsr_rectify_position(const struct tsr_rectify_table *table, enum tsr_rectify_side side, uint16_t x, uint16_t y,
                          int32_t position_q8[2])
{
    const int32_t last_q8[2] = {(table->source_width - 1) * 256, (table->source_height - 1) * 256};
    struct tsr_rectify_row row;
    struct tsr_rectify_cubic cubic[2];
    tsr_rectify_row_start(&row, table, side, y);
    for (unsigned span = 0; span <= (unsigned)x >> table->step_log2; span++) {
        tsr_rectify_row_next_span(&row, cubic);
    }
    for (unsigned axis = 0; axis < 2; axis++) {
        for (unsigned t = x & ((1u << table->step_log2) - 1u); t > 0; t--) {
            tsr_rectify_step(&cubic[axis]);
        }
        position_q8[axis] = tsr_rectify_clip_position(cubic[axis].position, last_q8[axis]);
    }
}
