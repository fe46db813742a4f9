/*
 * Rectification: a view resampled so that the rows of a pair are aligned.
 *
 *   target(x,y) = bilinear source at p(x,y)            docs/math.md, eq. (66)
 *   p(x,y)      = sum over i, j of B_i(x/S) B_j(y/S) c_ij        eq. (60)
 *
 * with c_ij a coarse grid of control points and B the uniform cubic B-spline
 * (C. de Boor, *A Practical Guide to Splines*, 1978). A spline needs about a
 * quarter of the points that bilinear interpolation needs for the same error,
 * follows lines exactly and never leaves the hull of its control points, and
 * costs three additions per coordinate and pixel by forward differences.
 *
 * The table (made by `tarsier rectify-table`), little-endian:
 *
 *     0  4  magic "TSRM"                22  4  f of the rectified view, px, UQ16.16
 *     4  1  version                     26  4  baseline, mm, UQ16.16
 *     5  1  log2 S, 3 .. 5              30  4  cx of the left view, px, Q16.16
 *     6  2  width, px                   34  4  cy of both views, px, Q16.16
 *     8  2  height, px                  38     left grid, right grid: rows x columns
 *    10  2  source width, px                   points of x and y, each 2 bytes, px, Q10.6,
 *    12  2  source height, px                  relative to (source width / 2, height / 2),
 *    14  2  rows above, left                   both rounded down
 *    16  2  rows above, right          end-2  CRC-16 (RFC 1662) of all bytes before
 *    18  2  d0, px, Q12.4
 *    20  2  zero
 *
 * columns = ceil(width / S) + 3, rows = ceil(height / S) + 3; point (i,j) belongs
 * to the target's pixel ((i - 1) S, (j - 1) S). d0 is that of search start 0.
 *
 * This portable C is the definition: every variant gives the same bits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_RECTIFY_H
#define TSR_VISION_RECTIFY_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_RECTIFY_VERSION 1
#define TSR_RECTIFY_STEP_LOG2_MIN 3
#define TSR_RECTIFY_STEP_LOG2_MAX 5
#define TSR_RECTIFY_SIDE_MIN 16 /* px, of either image */
#define TSR_RECTIFY_HEADER_LEN 38u
#define TSR_RECTIFY_CRC_LEN 2u
#define TSR_RECTIFY_POINT_LEN 4u
#define TSR_RECTIFY_POINT_FRACTION_BITS 6

/* Control points along a side of length px, and bytes of a table. */
#define TSR_RECTIFY_POINTS(length, step_log2)                                                                          \
    ((((size_t)(length) + ((size_t)1 << (step_log2)) - 1u) >> (step_log2)) + 3u)
#define TSR_RECTIFY_TABLE_LEN(width, height, step_log2)                                                                \
    (TSR_RECTIFY_HEADER_LEN + TSR_RECTIFY_CRC_LEN +                                                                    \
     2u * TSR_RECTIFY_POINT_LEN * TSR_RECTIFY_POINTS(width, step_log2) * TSR_RECTIFY_POINTS(height, step_log2))

/* Bytes of source rows that rectification in place keeps. */
#define TSR_RECTIFY_KEPT_LEN(width, rows_above) ((size_t)(width) * ((size_t)(rows_above) + 1u))

enum tsr_rectify_side {
    TSR_RECTIFY_LEFT = 0,
    TSR_RECTIFY_RIGHT = 1
};

/* A table that was checked. Its grids stay in the bytes it was opened from. */
struct tsr_rectify_table {
    const uint8_t *grid[2]; /* by side */
    uint16_t width;         /* px, of the rectified view */
    uint16_t height;
    uint16_t source_width; /* px, of the camera's frame */
    uint16_t source_height;
    uint16_t rows_above[2]; /* by side: target row y reads no source row above y - rows_above */
    int16_t d0_q4;          /* px, offset of the disparities at search start 0 */
    uint8_t step_log2;
    uint32_t focal_q16;    /* px */
    uint32_t baseline_q16; /* mm */
    int32_t cx_q16;        /* px */
    int32_t cy_q16;
};

/*
 * Check a table and find its parts.
 *
 *   table  filled
 *   bytes  [len] in, any alignment, flash or RAM; kept as long as the table
 *   len    exactly the table's length
 *
 * Takes about 57 instructions per pixel of the view (Cortex-M4): once, at the
 * start.
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer; TSR_ERR_FORMAT for another
 * magic, a CRC that does not hold, a nonzero reserved field, f or baseline of
 * zero or a count of rows above that is not that of the grid; TSR_ERR_VERSION;
 * TSR_ERR_SIZE for a side or S out of range or a len that does not fit them.
 * On error *table is untouched.
 */
enum tsr_status tsr_rectify_open(struct tsr_rectify_table *table, const uint8_t *bytes, size_t len);

/*
 * How far above its own row any target row reads, px: the least n >= 0 such that
 * every position of every row y, clipped to the source, is at row y - n or below.
 *
 *   table  in, all but rows_above set, sizes and step in range
 */
uint16_t tsr_rectify_measure_rows_above(const struct tsr_rectify_table *table, enum tsr_rectify_side side);

/* Where target pixel (x, y) is read, px, Q24.8, clipped to the source; equals
 * what run reads. For tools and tests: each call costs a row's beginning. The
 * table was opened, (x, y) is inside the target. */
void tsr_rectify_position(const struct tsr_rectify_table *table, enum tsr_rectify_side side, uint16_t x, uint16_t y,
                          int32_t position_q8[2]);

/* Content belongs to the module. */
struct tsr_rectify {
    const struct tsr_rectify_table *table;
    struct tsr_gray_view source;
    struct tsr_gray target;
    uint8_t
        *kept; /* rows y - kept_rows + 1 .. y of the source in place, row r at r mod kept_rows; null: not in place */
    uint16_t kept_rows;
    uint16_t rows_done;
    uint8_t side;
};

/*
 * Begin rectifying a view into another frame.
 *
 *   rectify  filled; kept until run returns TSR_OK or the work is given up
 *   table    opened; kept as rectify
 *   source   [source_height][source_width] gray; kept as rectify
 *   target   [height][width] out; kept as rectify; apart from the source (rows
 *            may interleave)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an unknown side;
 * TSR_ERR_SIZE if a frame does not have the table's size or its stride < width.
 * On error nothing is written, on TSR_OK only *rectify.
 */
enum tsr_status tsr_rectify_start(struct tsr_rectify *rectify, const struct tsr_rectify_table *table,
                                  enum tsr_rectify_side side, struct tsr_gray_view source, struct tsr_gray target);

/*
 * Begin rectifying a view in its own place: the bits are those of another frame.
 *
 *   frame     [height][width] in and out, of a table whose source has the
 *             target's size; kept as rectify
 *   kept      [kept_cap] for source rows that are overwritten but still read;
 *             kept as rectify, apart from the frame. It may be the matcher's
 *             scratch: one side is done before the other begins.
 *   kept_cap  bytes, >= TSR_RECTIFY_KEPT_LEN(width, rows_above of the side)
 *
 * In the pair layout (match.h) both views are rectified where they were
 * captured, one after the other, without a third frame.
 *
 * Returns as tsr_rectify_start, and TSR_ERR_NOBUF if kept_cap is too small,
 * TSR_ERR_SIZE if source and target of the table differ in size.
 */
enum tsr_status tsr_rectify_start_in_place(struct tsr_rectify *rectify, const struct tsr_rectify_table *table,
                                           enum tsr_rectify_side side, struct tsr_gray frame, uint8_t *kept,
                                           size_t kept_cap);

/*
 * Continue for at most rows rows of the target, each about 77 instructions per
 * pixel (Cortex-M4, -O3, S = 16; 68 with S = 32). Positions outside the source
 * take the nearest pixel inside; bilinear weights are of 1/256 px, the value is
 * rounded to nearest, ties up. The result does not depend on how the rows are
 * divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the view is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null rectify or rows = 0.
 */
enum tsr_status tsr_rectify_run(struct tsr_rectify *rectify, uint16_t rows);

uint16_t tsr_rectify_rows_done(const struct tsr_rectify *rectify);

#endif
