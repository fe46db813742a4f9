/*
 * Census descriptors and their Hamming distances, summed over the rows of a box.
 *
 * R. Zabih, J. Woodfill: Non-parametric local transforms for computing visual
 * correspondence, ECCV 1994. The sixteen neighbours, one plane of eight bits each:
 *
 *     . 1 0 1 .       plane 0: the arms of a cross
 *     1 . 0 . 1       plane 1: the knight's moves
 *     0 0 x 0 0
 *     1 . 0 . 1
 *     . 1 0 1 .
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "match_smooth.h"

#define REACH 2 /* rows and columns around the pixel */
#define ROWS (2 * REACH + 1)

struct neighbour {
    int8_t dx;
    int8_t dy;
};

static const struct neighbour neighbours[TSR_MATCH_CENSUS_PLANES][8] = {
    {{0, -2}, {0, -1}, {-2, 0}, {-1, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}},
    {{-1, -2}, {1, -2}, {-2, -1}, {2, -1}, {-2, 1}, {2, 1}, {-1, 2}, {1, 2}},
};

/* The planes of one ring row. */
struct planes {
    uint8_t *left[TSR_MATCH_CENSUS_PLANES];
    uint8_t *right[TSR_MATCH_CENSUS_PLANES];
};

static struct planes planes_at(const struct tsr_match *match, unsigned y)
{
    size_t width = match->config.width;
    size_t right_len = width + match->config.disparities;
    size_t row_len = TSR_MATCH_CENSUS_PLANES * (width + right_len);
    unsigned slot = y % (2u * tsr_match_smooth_radius(&match->config) + 2u);
    uint8_t *row = tsr_match_share_smooth(match).ring + row_len * slot;
    struct planes planes = {{row, row + width}, {row + 2u * width, row + 2u * width + right_len}};
    return planes;
}

static unsigned clip(int value, unsigned last)
{
    if (value < 0) {
        return 0;
    }
    return (unsigned)value < last ? (unsigned)value : last;
}

/* Rows y - 2 .. y + 2 of a frame, or the nearest inside. */
static void find_rows(const struct tsr_gray *frame, unsigned y, const uint8_t *rows[ROWS])
{
    for (int i = 0; i < ROWS; i++) {
        rows[i] = frame->pixels + (size_t)frame->stride * clip((int)y + i - REACH, frame->height - 1u);
    }
}

/* docs/math.md, eq. (40): one plane of the descriptor at column x. */
static uint8_t describe(const uint8_t *const rows[ROWS], unsigned x, unsigned last, unsigned plane)
{
    unsigned bits = 0;
    uint8_t centre = rows[REACH][x];
    for (unsigned i = 0; i < 8; i++) {
        struct neighbour n = neighbours[plane][i];
        uint8_t value = rows[n.dy + REACH][clip((int)x + n.dx, last)];
        bits |= (value > centre ? 1u : 0u) << i;
    }
    return (uint8_t)bits;
}

/* k = W - 1 - x + d holds right column W - 1 - s - k, clipped into the image. */
static void describe_right(const struct tsr_match *match, const uint8_t *const rows[ROWS], uint8_t *plane_row,
                           unsigned plane)
{
    unsigned last = match->config.width - 1u;
    unsigned count = last + match->config.disparities;
    int first = (int)last - match->config.search_start_px;
    unsigned previous = last + 1u; /* no column */
    for (unsigned k = 0; k < count; k++) {
        unsigned column = clip(first - (int)k, last);
        plane_row[k] = column == previous ? plane_row[k - 1u] : describe(rows, column, last, plane);
        previous = column;
    }
}

void tsr_match_describe_row(const struct tsr_match *match, unsigned y)
{
    unsigned width = match->config.width;
    struct planes planes = planes_at(match, y);
    const uint8_t *left[ROWS];
    const uint8_t *right[ROWS];
    find_rows(&match->left, y, left);
    find_rows(&match->right, y, right);
    for (unsigned plane = 0; plane < TSR_MATCH_CENSUS_PLANES; plane++) {
        for (unsigned x = 0; x < width; x++) {
            planes.left[plane][x] = describe(left, x, width - 1u, plane);
        }
        describe_right(match, right, planes.right[plane], plane);
    }
}

/* Set bits of both bytes, 0 .. 16, without a table or a branch. */
static unsigned count_bits(unsigned a, unsigned b)
{
    a -= a >> 1 & 0x55u;
    b -= b >> 1 & 0x55u;
    unsigned fours = (a & 0x33u) + (a >> 2 & 0x33u) + (b & 0x33u) + (b >> 2 & 0x33u);
    return (fours & 0x0fu) + (fours >> 4);
}

/* column[d] += times C(x,y,d), modulo 256: subtracting is adding 255 times. */
static void add_column(uint8_t *restrict column, const struct planes *planes, unsigned x, unsigned from,
                       unsigned disparities, unsigned times)
{
    unsigned left0 = planes->left[0][x];
    unsigned left1 = planes->left[1][x];
    const uint8_t *right0 = planes->right[0] + from;
    const uint8_t *right1 = planes->right[1] + from;
    for (unsigned d = 0; d < disparities; d++) {
        column[d] = (uint8_t)(column[d] + times * count_bits(left0 ^ right0[d], left1 ^ right1[d]));
    }
}

void tsr_match_add_census(const struct tsr_match *match, unsigned y, unsigned times)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *columns = tsr_match_share_smooth(match).columns;
    struct planes planes = planes_at(match, y);
    for (unsigned x = 0; x < width; x++) {
        add_column(columns + (size_t)x * disparities, &planes, x, width - 1u - x, disparities, times);
    }
}

void tsr_match_take_census(const struct tsr_match *match, unsigned y)
{
    tsr_match_add_census(match, y, UINT8_MAX);
}
