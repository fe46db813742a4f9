/*
 * 5x5 median for microcontrollers, from a window that slides along the row: its
 * values stay in ascending order while the column at its right end enters and the
 * one at its left end leaves.
 *
 * Scratch holds the two rows above as they were, each at its parity. Row y takes
 * the place of row y - 2 behind the window, where that one is not read any more.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "median_wide.h"

#ifdef TSR_MEDIAN_SLIDES

#include <stdbool.h>

#define SIDE (2u * TSR_MEDIAN_WIDE_RADIUS + 1u)

/* The valid values of a column, ascending. */
struct column {
    uint16_t values[SIDE];
    unsigned count;
};

struct window {
    struct column columns[SIDE]; /* column x at x % SIDE */
    uint16_t values[SIDE * SIDE];
    unsigned count;
};

/* The rows y - 2 .. y + 2 before the median; NULL outside the map. */
struct rows {
    const uint16_t *row[SIDE];
};

static void read_column(const struct rows *rows, unsigned x, struct column *column)
{
    unsigned count = 0;
    for (unsigned j = 0; j < SIDE; j++) {
        uint16_t value = rows->row[j] != NULL ? rows->row[j][x] : TSR_DISPARITY_INVALID;
        if (value == TSR_DISPARITY_INVALID) {
            continue;
        }
        unsigned i = count++;
        for (; i > 0 && column->values[i - 1u] > value; i--) {
            column->values[i] = column->values[i - 1u];
        }
        column->values[i] = value;
    }
    column->count = count;
}

static void remove_column(struct window *window, const struct column *column)
{
    unsigned removed = 0;
    for (unsigned i = 0; i < window->count; i++) {
        uint16_t value = window->values[i];
        if (removed < column->count && value == column->values[removed]) {
            removed++;
        } else {
            window->values[i - removed] = value;
        }
    }
    window->count -= removed;
}

/* From the largest down, until the column is used up. */
static void insert_column(struct window *window, const struct column *column)
{
    unsigned kept = window->count;
    unsigned left = column->count;
    window->count += left;
    for (unsigned at = window->count; left > 0; at--) {
        if (kept > 0 && window->values[kept - 1u] > column->values[left - 1u]) {
            window->values[at - 1u] = window->values[--kept];
        } else {
            window->values[at - 1u] = column->values[--left];
        }
    }
}

static struct rows rows_around(const struct tsr_median *median, unsigned y, uint16_t *above)
{
    size_t width = median->width;
    struct rows rows = {{NULL}};
    for (unsigned j = 0; j < SIDE; j++) {
        unsigned below = y + j; /* row below - TSR_MEDIAN_WIDE_RADIUS */
        if (j < TSR_MEDIAN_WIDE_RADIUS && below >= TSR_MEDIAN_WIDE_RADIUS) {
            rows.row[j] = above + below % 2u * width;
        } else if (j >= TSR_MEDIAN_WIDE_RADIUS && below - TSR_MEDIAN_WIDE_RADIUS < median->height) {
            rows.row[j] = median->map + (below - TSR_MEDIAN_WIDE_RADIUS) * width;
        }
    }
    return rows;
}

void tsr_median_filter_wide_row(const struct tsr_median *median, unsigned y)
{
    unsigned width = median->width;
    uint16_t *above = (uint16_t *)(void *)median->scratch;
    uint16_t *saved = above + (size_t)(y % 2u) * width;
    uint16_t *row = median->map + (size_t)y * width;
    const struct rows rows = rows_around(median, y, above);
    unsigned rows_inside = tsr_median_count_inside(y, median->height);
    struct window window = {.count = 0};
    for (unsigned entering = 0; entering < width + TSR_MEDIAN_WIDE_RADIUS; entering++) {
        struct column *column = &window.columns[entering % SIDE];
        if (entering >= SIDE) {
            remove_column(&window, column);
        }
        column->count = 0;
        if (entering < width) {
            read_column(&rows, entering, column);
            insert_column(&window, column);
        }
        if (entering >= TSR_MEDIAN_WIDE_RADIUS) {
            unsigned x = entering - TSR_MEDIAN_WIDE_RADIUS;
            saved[x] = row[x];
            bool enough =
                2u * window.count > rows_inside * tsr_median_count_inside(x, width); /* docs/math.md, eq. (80) */
            row[x] = enough ? window.values[(window.count - 1u) / 2u] : TSR_DISPARITY_INVALID;
        }
    }
}
#endif
