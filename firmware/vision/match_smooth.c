/*
 * The census modes of the matcher: their scratch and the order of their rows.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_smooth.h"

#include <stdbool.h>
#include <string.h>

static bool has_paths(const struct tsr_match_config *config)
{
    return config->mode == TSR_MATCH_SMOOTH;
}

unsigned tsr_match_smooth_radius(const struct tsr_match_config *config)
{
    return has_paths(config) ? 1u : config->window / 2u;
}

unsigned tsr_match_smooth_rows_total(const struct tsr_match_config *config)
{
    return config->height + tsr_match_smooth_radius(config);
}

static size_t ring_len(const struct tsr_match_config *config)
{
    size_t row_len = TSR_MATCH_CENSUS_PLANES * (2u * (size_t)config->width + config->disparities);
    return row_len * (2u * tsr_match_smooth_radius(config) + 2u);
}

size_t tsr_match_smooth_scratch_len(const struct tsr_match_config *config)
{
    size_t width = config->width;
    size_t disparities = config->disparities;
    size_t len = 2u * disparities + 4u * width + width * disparities + ring_len(config);
    return has_paths(config) ? len + 2u * width * disparities + 2u * width + 2u * disparities : len;
}

struct tsr_match_smooth_scratch tsr_match_share_smooth(const struct tsr_match *match)
{
    size_t width = match->config.width;
    size_t disparities = match->config.disparities;
    struct tsr_match_smooth_scratch scratch;
    scratch.sums = (uint16_t *)(void *)match->scratch;
    scratch.right_cost = scratch.sums + disparities;
    scratch.right_d = (uint8_t *)(scratch.right_cost + width);
    scratch.left_d = scratch.right_d + width;
    scratch.columns = scratch.left_d + width;
    scratch.ring = scratch.columns + width * disparities;
    if (!has_paths(&match->config)) {
        scratch.above[0] = scratch.above[1] = scratch.least[0] = scratch.least[1] = NULL;
        scratch.before = scratch.cost = NULL;
        return scratch;
    }
    scratch.above[0] = scratch.ring + ring_len(&match->config);
    scratch.above[1] = scratch.above[0] + width * disparities;
    scratch.least[0] = scratch.above[1] + width * disparities;
    scratch.least[1] = scratch.least[0] + width;
    scratch.before = scratch.least[1] + width;
    scratch.cost = scratch.before + disparities;
    return scratch;
}

/* The columns one row above the image hold row 0 r + 2 times and rows 1 .. r - 1
 * once, so that moving them down to map row 0 is a step like every other. */
static void warm_up(const struct tsr_match *match, unsigned row, unsigned radius)
{
    if (row == 0) {
        struct tsr_match_smooth_scratch scratch = tsr_match_share_smooth(match);
        memset(scratch.columns, 0, (size_t)match->config.width * match->config.disparities);
        if (has_paths(&match->config)) {
            tsr_match_begin_paths(match);
        }
    }
    tsr_match_describe_row(match, row);
    tsr_match_add_census(match, row, row == 0 ? radius + 2u : 1u);
}

static void move_columns(const struct tsr_match *match, unsigned y, unsigned radius)
{
    unsigned last = match->config.height - 1u;
    if (y + radius <= last) {
        tsr_match_describe_row(match, y + radius);
    }
    tsr_match_take_census(match, y > radius ? y - radius - 1u : 0u);
    tsr_match_add_census(match, y + radius < last ? y + radius : last, 1u);
}

static void move_lanes(uint16_t *restrict sums, const uint8_t *restrict enter, const uint8_t *restrict leave,
                       unsigned disparities)
{
    for (unsigned d = 0; d < disparities; d++) {
        sums[d] = (uint16_t)(sums[d] + enter[d] - leave[d]);
    }
}

/* The window one column left of the image, as the columns above it. */
static void begin_window(const struct tsr_match_smooth_scratch *scratch, unsigned disparities, unsigned radius)
{
    for (unsigned d = 0; d < disparities; d++) {
        scratch->sums[d] = (uint16_t)((radius + 2u) * scratch->columns[d]);
        for (unsigned x = 1; x < radius; x++) {
            scratch->sums[d] = (uint16_t)(scratch->sums[d] + scratch->columns[x * disparities + d]);
        }
    }
}

/* docs/math.md, eq. (47). */
static void move_window(const struct tsr_match *match, const struct tsr_match_smooth_scratch *scratch, unsigned x,
                        unsigned radius)
{
    unsigned last = match->config.width - 1u;
    size_t disparities = match->config.disparities;
    size_t enter = x + radius < last ? x + radius : last;
    size_t leave = x > radius ? x - radius - 1u : 0u;
    move_lanes(scratch->sums, scratch->columns + enter * disparities, scratch->columns + leave * disparities,
               match->config.disparities);
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned radius)
{
    struct tsr_match_smooth_scratch scratch = tsr_match_share_smooth(match);
    bool smooth = has_paths(&match->config);
    move_columns(match, y, radius);
    tsr_match_begin_choice(match);
    if (!smooth) {
        begin_window(&scratch, match->config.disparities, radius);
    }
    for (unsigned x = 0; x < match->config.width; x++) {
        if (smooth) {
            tsr_match_sum_paths(match, x, y);
        } else {
            move_window(match, &scratch, x, radius);
        }
        tsr_match_choose(match, x, y);
    }
    tsr_match_finish_choice(match, y);
}

void tsr_match_smooth_step(const struct tsr_match *match, unsigned step)
{
    unsigned radius = tsr_match_smooth_radius(&match->config);
    if (step < radius) {
        warm_up(match, step, radius);
    } else {
        match_row(match, step - radius, radius);
    }
}
