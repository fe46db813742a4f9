/*
 * Column sums of the matcher: A(x,y,d) over the window's rows, for every column
 * and disparity, moved down row by row.
 *
 * A(.,.,d) exists for the columns x_first(d) = max(0, d + s) to
 * x_last(d) = min(W - 1, W - 1 + d + s). Outside them the column is the nearest
 * one inside: left of x_first it pairs P_left(d + s) with P_right(0), right of
 * x_last P_left(W - 1 + d + s) with P_right(W - 1). So the lanes d of a column
 * fall into three runs, and in each of them one value of one frame meets
 * consecutive values of the other:
 *
 *     d   0 ........ middle .................. upper ........... D
 *         right border     the right frame has     left border
 *                          x - s - d
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <string.h>

#include "match_stages.h"

/* The prefiltered rows of both frames, the right one mirrored. */
struct rows {
    const uint8_t *left;
    const uint8_t *right;
};

/* Lanes from .. from + count - 1 of a column: value one of one row against the
 * values from many on of the other. */
struct run {
    unsigned from;
    unsigned count;
    int one;
    int many;
    bool one_is_left;
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

/* The three runs of column x. Those without lanes come with a count of 0. */
static void find_runs(const struct tsr_match_config *config, unsigned x, struct run runs[3])
{
    int start = config->search_start_px;
    int last = config->width - 1;
    int lane_of_first = (int)x - start; /* the d whose right pixel is 0 */
    unsigned middle = clip_lane(lane_of_first - last, config->disparities);
    unsigned upper = clip_lane(lane_of_first + 1, config->disparities);
    runs[0] = (struct run){0, middle, 0, last + start, false};
    runs[1] = (struct run){middle, upper - middle, (int)x, last - lane_of_first + (int)middle, true};
    runs[2] = (struct run){upper, config->disparities - upper, last, start + (int)upper, false};
}

static inline uint8_t difference(uint8_t a, uint8_t b)
{
    return (uint8_t)(a > b ? a - b : b - a);
}

static void add_lanes(uint8_t *restrict column, unsigned count, unsigned times, uint8_t one,
                      const uint8_t *restrict many)
{
    for (unsigned d = 0; d < count; d++) {
        column[d] = (uint8_t)(column[d] + times * difference(one, many[d]));
    }
}

/* Column sums of A stay within 255 (window * 2 cap); what lies between adding
 * and taking away may wrap around. */
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
    for (unsigned x = 0; x < config->width; x++) {
        uint8_t *column = scratch.columns + (size_t)x * config->disparities;
        struct run runs[3];
        find_runs(config, x, runs);
        for (unsigned i = 0; i < 3; i++) {
            if (runs[i].count > 0) {
                const uint8_t *one = runs[i].one_is_left ? rows.left : rows.right;
                const uint8_t *many = runs[i].one_is_left ? rows.right : rows.left;
                add_lanes(column + runs[i].from, runs[i].count, times, one[runs[i].one], many + runs[i].many);
            }
        }
    }
    add_lanes(scratch.texture, config->width, times, config->prefilter_cap, rows.left);
}

void tsr_match_move_columns(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    struct rows new = rows_at(match, y_new);
    struct rows old = rows_at(match, y_old);
    for (unsigned x = 0; x < config->width; x++) {
        uint8_t *column = scratch.columns + (size_t)x * config->disparities;
        struct run runs[3];
        find_runs(config, x, runs);
        for (unsigned i = 0; i < 3; i++) {
            int one = runs[i].one;
            int many = runs[i].many;
            if (runs[i].count == 0) {
                continue;
            }
            if (runs[i].one_is_left) {
                move_lanes(column + runs[i].from, runs[i].count, new.left[one], new.right + many, old.left[one],
                           old.right + many);
            } else {
                move_lanes(column + runs[i].from, runs[i].count, new.right[one], new.left + many, old.right[one],
                           old.left + many);
            }
        }
    }
    move_lanes(scratch.texture, config->width, config->prefilter_cap, new.left, config->prefilter_cap, old.left);
}
