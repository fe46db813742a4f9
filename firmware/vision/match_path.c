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

#include "match_census.h"

_Static_assert(TSR_MATCH_PATHS *(TSR_MATCH_COST_MAX + TSR_MATCH_PENALTY_FAR) <= UINT8_MAX,
               "sums of path costs fit 8 bits");

/* The pixel a path comes from: its path costs, their minimum, and the penalty of a jump. */
struct source {
    const uint8_t *costs;
    unsigned least;
    unsigned penalty_far;
};

/* Three rows of costs, those outside the image being the nearest inside. */
struct costs {
    const uint8_t *rows[TSR_MATCH_SMOOTH_ROWS];
};

static uint8_t smaller(unsigned a, unsigned b)
{
    return (uint8_t)(a < b ? a : b);
}

static struct costs find_costs(const struct tsr_match *match, unsigned y)
{
    unsigned below = y + 1u < match->config.height ? y + 1u : y;
    struct costs costs = {{tsr_match_costs_at(match, y > 0 ? y - 1u : 0u), tsr_match_costs_at(match, y),
                           tsr_match_costs_at(match, below)}};
    return costs;
}

/* docs/math.md, eq. (42): a quarter of the sum over 3x3. */
static void find_box(const struct tsr_match *match, const struct costs *costs, unsigned x, uint8_t *restrict box)
{
    unsigned disparities = match->config.disparities;
    size_t here = (size_t)x * disparities;
    size_t left = x > 0 ? here - disparities : here;
    size_t right = x + 1u < match->config.width ? here + disparities : here;
    for (unsigned d = 0; d < disparities; d++) {
        unsigned sum = 0;
        for (unsigned i = 0; i < TSR_MATCH_SMOOTH_ROWS; i++) {
            const uint8_t *row = costs->rows[i] + d;
            sum += (unsigned)row[left] + row[here] + row[right];
        }
        box[d] = (uint8_t)(sum >> 2);
    }
}

/* docs/math.md, eq. (44): path costs of this pixel from those of the pixel
 * before, which they may overwrite. Returns their minimum. */
static uint8_t walk(const uint8_t *cost, struct source source, uint8_t *path, int16_t *restrict sums,
                    unsigned disparities)
{
    uint8_t before[TSR_DISPARITY_COUNT_MAX + 2u];
    memcpy(before + 1, source.costs, disparities);
    before[0] = before[disparities + 1u] = UINT8_MAX;
    unsigned jump = source.least + source.penalty_far;
    uint8_t least = UINT8_MAX;
    for (unsigned d = 0; d < disparities; d++) {
        unsigned beside = smaller(before[d], before[d + 2u]) + (unsigned)TSR_MATCH_PENALTY_NEAR;
        unsigned best = smaller(smaller(before[d + 1u], jump), beside);
        uint8_t value = (uint8_t)(cost[d] + best - source.least);
        path[d] = value;
        least = smaller(least, value);
        sums[d] = (int16_t)(sums[d] + value);
    }
    return least;
}

/* S(x,y,.) = the sum of three paths. A path that starts here comes from costs of 0, which adds nothing: eq. (45).
 * Walking to the right, the place of this pixel is free as soon as the pixel above has been read, and the pixel above
 * right is still that of the row above. Returns the least cost of the path from the left. */
static uint8_t sum_paths(const struct tsr_match *match, struct tsr_match_paths *paths, unsigned x, unsigned y,
                         uint8_t least_left)
{
    static const uint8_t none[TSR_DISPARITY_COUNT_MAX];
    const struct tsr_match_config *config = &match->config;
    unsigned disparities = config->disparities;
    size_t here = (size_t)x * disparities;
    const uint8_t *row = match->left.pixels + (size_t)y * match->left.stride;
    const uint8_t *row_above = y > 0 ? row - match->left.stride : row;
    int16_t *sums = tsr_match_share_scratch(match).sums;
    memset(sums, 0, sizeof *sums * disparities);

    struct source left = {none, 0, TSR_MATCH_PENALTY_FAR};
    if (x > 0) {
        left = (struct source){paths->before, least_left, tsr_match_penalty_far(row[x], row[x - 1u])};
    }
    least_left = walk(paths->cost, left, paths->before, sums, disparities);

    struct source up = {paths->above[0] + here, paths->least[0][x], tsr_match_penalty_far(row[x], row_above[x])};
    paths->least[0][x] = walk(paths->cost, up, paths->above[0] + here, sums, disparities);

    struct source right = {none, 0, TSR_MATCH_PENALTY_FAR};
    if (x + 1u < config->width) {
        right = (struct source){paths->above[1] + here + disparities, paths->least[1][x + 1u],
                                tsr_match_penalty_far(row[x], row_above[x + 1u])};
    }
    paths->least[1][x] = walk(paths->cost, right, paths->above[1] + here, sums, disparities);
    return least_left;
}

void tsr_match_smooth_row(const struct tsr_match *match, unsigned y)
{
    struct tsr_match_paths paths = tsr_match_share_paths(match);
    const struct costs costs = find_costs(match, y);
    uint8_t least_left = 0;
    tsr_match_begin_choice(match);
    for (unsigned x = 0; x < match->config.width; x++) {
        find_box(match, &costs, x, paths.cost);
        least_left = sum_paths(match, &paths, x, y, least_left);
        tsr_match_choose(match, x, true);
    }
    tsr_match_write_row(match, y);
}
