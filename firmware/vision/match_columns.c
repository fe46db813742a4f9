/*
 * Column sums of the matcher: A(x,y,d) over the window's rows, for every column
 * and disparity, moved down row by row.
 *
 * The right row is mirrored, so consecutive lanes d of column x meet consecutive
 * pixels, from mirrored column W - 1 - x + s on. Where those lie outside the
 * picture the nearest one inside stands for them: eq. (11).
 *
 *     d   0 ........ middle .................. upper ........... D
 *         right of the     the right picture    left of the
 *         right picture    has x - s - d        right picture
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "match_stages.h"

/* The prefiltered rows of both frames, the right one mirrored. */
struct rows {
    const uint8_t *left;
    const uint8_t *right;
};

/* Where the lanes of a column change their run, and what the first of middle meets. */
struct runs {
    unsigned middle;
    unsigned upper;
    int first;
};

static struct rows rows_at(const struct tsr_match *match, unsigned y)
{
    struct rows rows = {match->left.pixels + (size_t)y * match->left.stride,
                        match->right.pixels + (size_t)y * match->right.stride};
    return rows;
}

static unsigned clip_lane(int d, unsigned disparities)
{
    unsigned positive = d < 0 ? 0u : (unsigned)d;
    return positive < disparities ? positive : disparities;
}

static struct runs find_runs(const struct tsr_match_config *config, unsigned x)
{
    int last = config->width - 1;
    int lane_of_first = (int)x - config->search_start_px; /* the d whose right pixel is 0 */
    struct runs runs;
    runs.middle = clip_lane(lane_of_first - last, config->disparities);
    runs.upper = clip_lane(lane_of_first + 1, config->disparities);
    runs.first = last - lane_of_first + (int)runs.middle;
    return runs;
}

static inline uint8_t difference(uint8_t a, uint8_t b)
{
    return (uint8_t)(a > b ? a - b : b - a);
}

static void add_same(uint8_t *column, unsigned count, uint8_t term)
{
    for (unsigned d = 0; d < count; d++) {
        column[d] = (uint8_t)(column[d] + term);
    }
}

static void add_lanes(uint8_t *restrict column, unsigned count, unsigned times, uint8_t one,
                      const uint8_t *restrict many)
{
    for (unsigned d = 0; d < count; d++) {
        column[d] = (uint8_t)(column[d] + times * difference(one, many[d]));
    }
}

/* Column sums of A stay within 127; what lies between adding and taking away may
 * wrap around. */
static void move_lanes(uint8_t *restrict column, unsigned count, uint8_t one_new, const uint8_t *restrict many_new,
                       uint8_t one_old, const uint8_t *restrict many_old)
{
    unsigned d = 0;
    for (; d + TSR_MATCH_LANES <= count; d += TSR_MATCH_LANES) {
        for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
            uint8_t added = difference(one_new, many_new[d + i]);
            uint8_t taken = difference(one_old, many_old[d + i]);
            column[d + i] = (uint8_t)(column[d + i] + added - taken);
        }
    }
    for (; d < count; d++) {
        column[d] = (uint8_t)(column[d] + difference(one_new, many_new[d]) - difference(one_old, many_old[d]));
    }
}

void tsr_match_add_row(const struct tsr_match *match, unsigned y, unsigned times)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    struct rows rows = rows_at(match, y);
    unsigned last = config->width - 1u;
    for (unsigned x = 0; x < config->width; x++) {
        uint8_t *column = scratch.columns + (size_t)x * config->disparities;
        struct runs runs = find_runs(config, x);
        uint8_t left = rows.left[x];
        add_same(column, runs.middle, (uint8_t)(times * difference(left, rows.right[0])));
        if (runs.upper > runs.middle) {
            add_lanes(column + runs.middle, runs.upper - runs.middle, times, left, rows.right + runs.first);
        }
        add_same(column + runs.upper, config->disparities - runs.upper,
                 (uint8_t)(times * difference(left, rows.right[last])));
    }
    add_lanes(scratch.texture, config->width, times, config->prefilter_cap, rows.left);
}

void tsr_match_move_columns(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    struct rows new = rows_at(match, y_new);
    struct rows old = rows_at(match, y_old);
    unsigned last = config->width - 1u;
    for (unsigned x = 0; x < config->width; x++) {
        uint8_t *column = scratch.columns + (size_t)x * config->disparities;
        struct runs runs = find_runs(config, x);
        add_same(column, runs.middle,
                 (uint8_t)(difference(new.left[x], new.right[0]) - difference(old.left[x], old.right[0])));
        if (runs.upper > runs.middle) {
            move_lanes(column + runs.middle, runs.upper - runs.middle, new.left[x], new.right + runs.first, old.left[x],
                       old.right + runs.first);
        }
        add_same(column + runs.upper, config->disparities - runs.upper,
                 (uint8_t)(difference(new.left[x], new.right[last]) - difference(old.left[x], old.right[last])));
    }
    move_lanes(scratch.texture, config->width, config->prefilter_cap, new.left, config->prefilter_cap, old.left);
}
