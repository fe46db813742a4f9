/*
 * Median of a disparity map, in place: the rows that are already overwritten
 * are read from copies. Here is 3x3, block by block; median_wide.c has 5x5.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/median.h"

#include <string.h>

#include "map_buffers.h"
#include "median_block.h"
#include "median_wide.h"

/* The nearest rows before the median; NULL outside the map. */
struct rows {
    const uint16_t *row[3];
};

enum tsr_status tsr_median_start_window(struct tsr_median *median, uint8_t window, uint16_t width, uint16_t height,
                                        uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap)
{
    if (median == NULL || (window != TSR_MEDIAN_WINDOW && window != TSR_MEDIAN_WINDOW_MAX)) {
        return TSR_ERR_ARG;
    }
    const struct tsr_map_buffers buffers = {map,   map_cap, scratch, scratch_cap, TSR_MEDIAN_SCRATCH_LEN(width),
                                            width, height};
    enum tsr_status status = tsr_map_check_buffers(&buffers);
    if (status == TSR_OK) {
        *median = (struct tsr_median){map, scratch, width, height, 0, window};
    }
    return status;
}

enum tsr_status tsr_median_start(struct tsr_median *median, uint16_t width, uint16_t height, uint16_t *map,
                                 size_t map_cap, uint8_t *scratch, size_t scratch_cap)
{
    return tsr_median_start_window(median, TSR_MEDIAN_WINDOW, width, height, map, map_cap, scratch, scratch_cap);
}

/* Columns x - 1 .. x + TSR_MEDIAN_BLOCK of one row, invalid outside the map. */
static void copy_row(const uint16_t *row, unsigned x, unsigned width, uint16_t values[TSR_MEDIAN_COLUMNS])
{
    memset(values, 0xff, TSR_MEDIAN_COLUMNS * sizeof *values);
    unsigned first = x > 0 ? x - 1u : 0u;
    unsigned end = x + TSR_MEDIAN_BLOCK + 1u < width ? x + TSR_MEDIAN_BLOCK + 1u : width;
    if (row != NULL) {
        memcpy(values + (first + 1u - x), row + first, (end - first) * sizeof *values);
    }
}

/* Scratch holds rows y - 1 and y as they were, at y's parity; each row is saved
 * just before it is overwritten. */
static void filter_row(const struct tsr_median *median, unsigned y)
{
    size_t width = median->width;
    uint16_t *saved[2] = {(uint16_t *)(void *)median->scratch, (uint16_t *)(void *)median->scratch + width};
    uint16_t *row = median->map + (size_t)y * width;
    memcpy(saved[y % 2u], row, sizeof *row * width);
    struct rows rows = {
        {y > 0 ? saved[(y + 1u) % 2u] : NULL, saved[y % 2u], y + 1u < median->height ? row + width : NULL}};
    for (unsigned x = 0; x < width; x += TSR_MEDIAN_BLOCK) {
        struct tsr_median_block block;
        uint16_t medians[TSR_MEDIAN_BLOCK];
        for (unsigned i = 0; i < 3; i++) {
            copy_row(rows.row[i], x, median->width, block.values[i]);
        }
        tsr_median_filter_block(&block, medians);
        memcpy(row + x, medians, (x + TSR_MEDIAN_BLOCK < width ? TSR_MEDIAN_BLOCK : width - x) * sizeof *row);
    }
}

enum tsr_status tsr_median_run(struct tsr_median *median, uint16_t rows)
{
    if (median == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    for (; rows > 0 && median->rows_done < median->height; rows--, median->rows_done++) {
        if (median->window == TSR_MEDIAN_WINDOW) {
            filter_row(median, median->rows_done);
        } else {
            tsr_median_filter_wide_row(median, median->rows_done);
        }
    }
    return median->rows_done < median->height ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_median_rows_done(const struct tsr_median *median)
{
    return median->rows_done;
}
