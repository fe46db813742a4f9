/*
 * Costs aggregated along three paths that end at a pixel and come from pixels
 * already matched: from the left, from above and from above right.
 *
 * H. Hirschmueller: Stereo processing by semiglobal matching and mutual
 * information, IEEE TPAMI 30(2), 2008, of which only these paths are walked. A
 * path cost is at most COST_MAX + PENALTY_FAR, three of them fit 8 bits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "match_smooth.h"

#define PATHS 3
#define COST_MAX 36    /* (9 * 16) >> 2 */
#define PENALTY_NEAR 8 /* for a disparity that differs by 1 */
#define PENALTY_FAR 32 /* for any other, less the step of the gray value */

_Static_assert(PATHS *(COST_MAX + PENALTY_FAR) <= UINT8_MAX, "sums of path costs fit 8 bits");

/* The pixel a path comes from: its path costs, their minimum, and the penalty of a jump. */
struct source {
    const uint8_t *costs;
    unsigned least;
    unsigned penalty_far;
};

void tsr_match_begin_paths(const struct tsr_match *match)
{
    struct tsr_match_smooth_scratch scratch = tsr_match_share_smooth(match);
    size_t width = match->config.width;
    for (unsigned i = 0; i < 2; i++) {
        memset(scratch.above[i], 0, width * match->config.disparities);
        memset(scratch.least[i], 0, width);
    }
}

/* docs/math.md, eq. (43). */
static unsigned penalty_far(unsigned gray, unsigned gray_before)
{
    unsigned step = gray > gray_before ? gray - gray_before : gray_before - gray;
    return step + PENALTY_NEAR < PENALTY_FAR ? PENALTY_FAR - step : PENALTY_NEAR;
}

static uint8_t smaller(unsigned a, unsigned b)
{
    return (uint8_t)(a < b ? a : b);
}

/* docs/math.md, eq. (42): a quarter of the sum over 3x3. */
static void box_cost(const struct tsr_match *match, const struct tsr_match_smooth_scratch *scratch, unsigned x)
{
    size_t disparities = match->config.disparities;
    const uint8_t *here = scratch->columns + x * disparities;
    const uint8_t *left = x > 0 ? here - disparities : here;
    const uint8_t *right = x + 1u < match->config.width ? here + disparities : here;
    for (size_t d = 0; d < disparities; d++) {
        scratch->cost[d] = (uint8_t)((left[d] + here[d] + right[d]) >> 2);
    }
}

/* docs/math.md, eq. (44): path costs of this pixel from those of the pixel
 * before, which they may overwrite. Returns their minimum. */
static uint8_t walk(const uint8_t *cost, struct source source, uint8_t *path, uint16_t *restrict sums,
                    unsigned disparities)
{
    uint8_t before[TSR_DISPARITY_COUNT_MAX + 2u];
    memcpy(before + 1, source.costs, disparities);
    before[0] = before[disparities + 1u] = UINT8_MAX;
    unsigned jump = source.least + source.penalty_far;
    uint8_t least = UINT8_MAX;
    for (unsigned d = 0; d < disparities; d++) {
        unsigned beside = smaller(before[d], before[d + 2u]) + (unsigned)PENALTY_NEAR;
        unsigned best = smaller(smaller(before[d + 1u], jump), beside);
        uint8_t value = (uint8_t)(cost[d] + best - source.least);
        path[d] = value;
        least = smaller(least, value);
        sums[d] = (uint16_t)(sums[d] + value);
    }
    return least;
}

static uint8_t least_of(const uint8_t *costs, unsigned disparities)
{
    uint8_t least = UINT8_MAX;
    for (unsigned d = 0; d < disparities; d++) {
        least = smaller(least, costs[d]);
    }
    return least;
}

/* A path that starts here comes from costs of 0, which adds nothing: eq. (45).
 * Walking to the right, the place of this pixel is free as soon as the pixel
 * above has been read, and the pixel above right is still that of the row above. */
void tsr_match_sum_paths(const struct tsr_match *match, unsigned x, unsigned y)
{
    static const uint8_t none[TSR_DISPARITY_COUNT_MAX];
    struct tsr_match_smooth_scratch scratch = tsr_match_share_smooth(match);
    unsigned disparities = match->config.disparities;
    size_t here = (size_t)x * disparities;
    const uint8_t *row = match->left.pixels + (size_t)y * match->left.stride;
    const uint8_t *row_above = y > 0 ? row - match->left.stride : row;
    box_cost(match, &scratch, x);
    memset(scratch.sums, 0, sizeof *scratch.sums * disparities);

    struct source left = {none, 0, PENALTY_FAR};
    if (x > 0) {
        left = (struct source){scratch.before, least_of(scratch.before, disparities), penalty_far(row[x], row[x - 1u])};
    }
    walk(scratch.cost, left, scratch.before, scratch.sums, disparities);

    struct source up = {scratch.above[0] + here, scratch.least[0][x], penalty_far(row[x], row_above[x])};
    scratch.least[0][x] = walk(scratch.cost, up, scratch.above[0] + here, scratch.sums, disparities);

    struct source right = {none, 0, PENALTY_FAR};
    if (x + 1u < match->config.width) {
        right = (struct source){scratch.above[1] + here + disparities, scratch.least[1][x + 1u],
                                penalty_far(row[x], row_above[x + 1u])};
    }
    scratch.least[1][x] = walk(scratch.cost, right, scratch.above[1] + here, scratch.sums, disparities);
}
