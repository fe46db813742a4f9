/*
 * 5x5 median of a block of a row's pixels at once, by a sorting network whose
 * steps compilers turn into vector code: for machines with vectors of many pixels.
 *
 * A window always sorts 25 values. Of its k invalid ones, which neighbours outside
 * the map count to, ceil(k / 2) stand for a value below all others and the rest for
 * one above: then the median of 25 is the lower median of the 25 - k valid ones,
 * docs/math.md, eq. (18).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "median_wide.h"

#ifndef TSR_MEDIAN_SLIDES

#include <stdbool.h>
#include <string.h>

#define SIDE (2u * TSR_MEDIAN_WIDE_RADIUS + 1u)
#define VALUES (SIDE * SIDE)
#define MIDDLE (VALUES / 2u)
#define BLOCK 32u
#define COLUMNS (BLOCK + 2u * TSR_MEDIAN_WIDE_RADIUS)

/* K. E. Batcher's merge exchange (Sorting networks and their applications, AFIPS 32, 1968; D. E. Knuth, The Art of
 * Computer Programming 3, 5.2.2 M) for 25 values, of which only what the middle one depends on. The lesser value goes
 * to the first place. */
static const uint8_t comparators[][2] = {
    {0, 16},  {1, 17},  {2, 18},  {3, 19},  {4, 20},  {5, 21},  {6, 22},  {7, 23},  {8, 24},  {0, 8},   {1, 9},
    {2, 10},  {3, 11},  {4, 12},  {5, 13},  {6, 14},  {7, 15},  {16, 24}, {8, 16},  {9, 17},  {10, 18}, {11, 19},
    {12, 20}, {13, 21}, {14, 22}, {15, 23}, {0, 4},   {1, 5},   {2, 6},   {3, 7},   {8, 12},  {9, 13},  {10, 14},
    {11, 15}, {16, 20}, {17, 21}, {18, 22}, {19, 23}, {4, 16},  {5, 17},  {6, 18},  {7, 19},  {12, 24}, {4, 8},
    {5, 9},   {6, 10},  {7, 11},  {12, 16}, {13, 17}, {14, 18}, {15, 19}, {20, 24}, {0, 2},   {1, 3},   {4, 6},
    {5, 7},   {8, 10},  {9, 11},  {12, 14}, {13, 15}, {16, 18}, {17, 19}, {20, 22}, {21, 23}, {2, 16},  {3, 17},
    {6, 20},  {7, 21},  {10, 24}, {2, 8},   {3, 9},   {6, 12},  {7, 13},  {10, 16}, {11, 17}, {14, 20}, {15, 21},
    {18, 24}, {2, 4},   {3, 5},   {6, 8},   {7, 9},   {10, 12}, {11, 13}, {14, 16}, {15, 17}, {18, 20}, {19, 21},
    {22, 24}, {0, 1},   {2, 3},   {4, 5},   {6, 7},   {8, 9},   {10, 11}, {12, 13}, {14, 15}, {16, 17}, {18, 19},
    {20, 21}, {22, 23}, {1, 16},  {3, 18},  {5, 20},  {7, 22},  {9, 24},  {5, 12},  {7, 14},  {9, 16},  {11, 18},
    {9, 12},  {11, 14}, {11, 12},
};

/* Columns x - TSR_MEDIAN_WIDE_RADIUS .. x + BLOCK + TSR_MEDIAN_WIDE_RADIUS - 1 of the rows around a block; invalid
 * outside the map. */
struct surroundings {
    uint16_t rows[SIDE][COLUMNS];
};

struct windows {
    int16_t values[VALUES][BLOCK]; /* less 2^15, so that their order is the one of vector instructions */
    int16_t valid[BLOCK];
};

/* Columns from .. from + count - 1 of the rows y - TSR_MEDIAN_WIDE_RADIUS .. y + TSR_MEDIAN_WIDE_RADIUS into place;
 * those above are in above, by parity. */
static void load_columns(const struct tsr_median *median, unsigned y, unsigned from, unsigned count, unsigned place,
                         struct surroundings *around)
{
    size_t width = median->width;
    const uint16_t *above = (const uint16_t *)(const void *)median->scratch;
    unsigned inside = from < width ? (unsigned)width - from : 0u;
    inside = inside < count ? inside : count;
    for (unsigned j = 0; j < SIDE; j++) {
        memset(around->rows[j] + place, 0xff, count * sizeof *around->rows[j]);
        unsigned below = y + j; /* row below - TSR_MEDIAN_WIDE_RADIUS */
        if (below < TSR_MEDIAN_WIDE_RADIUS || below - TSR_MEDIAN_WIDE_RADIUS >= median->height) {
            continue;
        }
        const uint16_t *row = j < TSR_MEDIAN_WIDE_RADIUS ? above + below % 2u * width
                                                         : median->map + (below - TSR_MEDIAN_WIDE_RADIUS) * width;
        memcpy(around->rows[j] + place, row + from, inside * sizeof *row);
    }
}

static void fill_windows(const struct surroundings *around, struct windows *windows)
{
    int16_t below[BLOCK]; /* ones if the next invalid value stands for one below all others */
    memset(below, 0xff, sizeof below);
    memset(windows->valid, 0, sizeof windows->valid);
    for (unsigned k = 0; k < VALUES; k++) {
        const uint16_t *row = around->rows[k / SIDE] + k % SIDE;
        int16_t *values = windows->values[k];
        for (unsigned i = 0; i < BLOCK; i++) {
            int16_t value = (int16_t)(row[i] ^ 0x8000u);
            int16_t invalid = (int16_t) - (value == INT16_MAX);
            values[i] = (int16_t)(value ^ (invalid & below[i])); /* INT16_MAX becomes INT16_MIN */
            below[i] = (int16_t)(below[i] ^ invalid);
            windows->valid[i] = (int16_t)(windows->valid[i] + 1 + invalid);
        }
    }
}

static void order(int16_t *restrict a, int16_t *restrict b)
{
    for (unsigned i = 0; i < BLOCK; i++) {
        int16_t lesser = a[i] < b[i] ? a[i] : b[i];
        int16_t greater = a[i] < b[i] ? b[i] : a[i];
        a[i] = lesser;
        b[i] = greater;
    }
}

void tsr_median_filter_wide_row(const struct tsr_median *median, unsigned y)
{
    unsigned width = median->width;
    uint16_t *saved = (uint16_t *)(void *)median->scratch + (size_t)(y % 2u) * width;
    uint16_t *row = median->map + (size_t)y * width;
    unsigned rows_inside = tsr_median_count_inside(y, median->height);
    struct surroundings around;
    memset(&around, 0xff, sizeof around);
    load_columns(median, y, 0, TSR_MEDIAN_WIDE_RADIUS, COLUMNS - TSR_MEDIAN_WIDE_RADIUS, &around);
    for (unsigned x = 0; x < width; x += BLOCK) {
        for (unsigned j = 0; j < SIDE; j++) { /* columns that the block before may have overwritten */
            memmove(around.rows[j], around.rows[j] + BLOCK, 2u * TSR_MEDIAN_WIDE_RADIUS * sizeof *around.rows[j]);
        }
        load_columns(median, y, x + TSR_MEDIAN_WIDE_RADIUS, BLOCK, 2u * TSR_MEDIAN_WIDE_RADIUS, &around);
        struct windows windows;
        fill_windows(&around, &windows);
        for (unsigned k = 0; k < sizeof comparators / sizeof comparators[0]; k++) {
            order(windows.values[comparators[k][0]], windows.values[comparators[k][1]]);
        }
        unsigned count = width - x < BLOCK ? width - x : BLOCK;
        memcpy(saved + x, row + x, count * sizeof *row);
        for (unsigned i = 0; i < count; i++) {
            bool enough =
                2u * (unsigned)windows.valid[i] > rows_inside * tsr_median_count_inside(x + i, width); /* eq. (80) */
            row[x + i] =
                enough ? (uint16_t)((uint16_t)windows.values[MIDDLE][i] ^ 0x8000u) : (uint16_t)TSR_DISPARITY_INVALID;
        }
    }
}
#endif
