/*
 * Filling of a disparity map. After the first pass a row is full or empty: its
 * first pixel tells which.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/fill.h"

#include <stdbool.h>
#include <string.h>

#include "map_buffers.h"

#define NO_ROW UINT16_MAX

size_t tsr_fill_scratch_len(enum tsr_fill_rule rule, uint16_t width)
{
    (void)rule;
    (void)width;
    return 0;
}

enum tsr_status tsr_fill_start(struct tsr_fill *fill, enum tsr_fill_rule rule, uint16_t width, uint16_t height,
                               uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap)
{
    if (fill == NULL || (unsigned)rule >= TSR_FILL_RULE_COUNT) {
        return TSR_ERR_ARG;
    }
    size_t scratch_len = tsr_fill_scratch_len(rule, width);
    const struct tsr_map_buffers buffers = {map, map_cap, scratch, scratch_cap, scratch_len, width, height};
    enum tsr_status status = tsr_map_check_buffers(&buffers);
    if (status == TSR_OK) {
        *fill = (struct tsr_fill){map, width, height, 0, NO_ROW, (uint8_t)rule};
    }
    return status;
}

static void fill_run_of_row(uint16_t *row, unsigned begin, unsigned end, uint16_t value)
{
    for (unsigned x = begin; x < end; x++) {
        row[x] = value;
    }
}

/* TSR_DISPARITY_INVALID is larger than every valid value, so that it stands for
 * a border in the minimum. */
static void fill_row(uint16_t *row, unsigned width)
{
    uint16_t left = TSR_DISPARITY_INVALID;
    unsigned begin = 0; /* of the invalid run that ends at x */
    for (unsigned x = 0; x < width; x++) {
        uint16_t right = row[x];
        if (right != TSR_DISPARITY_INVALID) {
            fill_run_of_row(row, begin, x, left < right ? left : right);
            left = right;
            begin = x + 1u;
        }
    }
    fill_run_of_row(row, begin, width, left);
}

static bool is_full(const struct tsr_fill *fill, unsigned y)
{
    return fill->map[(size_t)y * fill->width] != TSR_DISPARITY_INVALID;
}

/* Rows below y are as the first pass left them. */
static void fill_empty_row(struct tsr_fill *fill, unsigned y)
{
    if (is_full(fill, y)) {
        fill->row_above = (uint16_t)y;
        return;
    }
    unsigned below = y + 1u;
    while (below < fill->height && !is_full(fill, below)) {
        below++;
    }
    unsigned above = fill->row_above;
    unsigned source = above;
    if (below < fill->height && (above == NO_ROW || below - y < y - above)) {
        source = below;
    }
    if (source != NO_ROW) {
        memcpy(fill->map + (size_t)y * fill->width, fill->map + (size_t)source * fill->width,
               sizeof *fill->map * fill->width);
    }
}

enum tsr_status tsr_fill_run(struct tsr_fill *fill, uint16_t rows)
{
    if (fill == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    unsigned height = fill->height;
    for (; rows > 0 && fill->rows_done < TSR_FILL_ROWS_TOTAL(height); rows--, fill->rows_done++) {
        unsigned row = fill->rows_done;
        if (row < height) {
            fill_row(fill->map + (size_t)row * fill->width, fill->width);
        } else {
            fill_empty_row(fill, row - height);
        }
    }
    return fill->rows_done < TSR_FILL_ROWS_TOTAL(height) ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_fill_rows_done(const struct tsr_fill *fill)
{
    return fill->rows_done;
}
