/*
 * Census descriptors and their Hamming distances.
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
#include "match_census.h"

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
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
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

/* C(x,y,d) of a pixel's lanes. */
static void find_costs(uint8_t *restrict costs, const struct tsr_match_planes *planes, unsigned x, unsigned from,
                       unsigned disparities)
{
    unsigned left0 = planes->left[0][x];
    unsigned left1 = planes->left[1][x];
    const uint8_t *right0 = planes->right[0] + from;
    const uint8_t *right1 = planes->right[1] + from;
    for (unsigned d = 0; d < disparities; d++) {
        costs[d] = (uint8_t)count_bits(left0 ^ right0[d], left1 ^ right1[d]);
    }
}

void tsr_match_cost_row(const struct tsr_match *match, unsigned y)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *costs = tsr_match_costs_at(match, y);
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    for (unsigned x = 0; x < width; x++) {
        find_costs(costs + (size_t)x * disparities, &planes, x, width - 1u - x, disparities);
    }
}

void tsr_match_add_census(const struct tsr_match *match, unsigned y, unsigned times)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *columns = tsr_match_share_scratch(match).columns;
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    for (unsigned x = 0; x < width; x++) {
        uint8_t costs[TSR_DISPARITY_COUNT_MAX];
        uint8_t *restrict column = columns + (size_t)x * disparities;
        find_costs(costs, &planes, x, width - 1u - x, disparities);
        for (unsigned d = 0; d < disparities; d++) {
            column[d] = (uint8_t)(column[d] + times * costs[d]);
        }
    }
}

/* Adding modulo 256, so that taking away is adding 255 times. */
void tsr_match_census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    tsr_match_add_census(match, y_old, UINT8_MAX);
    tsr_match_add_census(match, y_new, 1u);
    tsr_match_finish_row(match, y);
}
