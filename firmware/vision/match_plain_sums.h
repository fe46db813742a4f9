/*
 * Column and window sums of a plain mode. Included once by each, after
 *
 *   column_sum, window_sum   types that hold the sums
 *   term(a, b)               what two gray values cost
 *   offset_divisor(a, b)     of the offset; a, b: how much the sums beside the least exceed it
 *   PLAIN_SUMS               the name of the struct tsr_match_plain_sums
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_plain.h"
#include "match_plain_choose.h"

static column_sum *columns_at(const struct tsr_match *match, unsigned x)
{
    uint8_t *columns = tsr_match_share_scratch(match).columns;
    return (column_sum *)(void *)columns + (size_t)x * match->config.disparities;
}

static const uint8_t *left_row_at(const struct tsr_match *match, unsigned y)
{
    return match->left.pixels + (size_t)y * match->left.stride;
}

static void add_row(const struct tsr_match *match, unsigned y, unsigned times)
{
    unsigned width = match->config.width;
    const uint8_t *left = left_row_at(match, y);
    const uint8_t *met = tsr_match_share_plain(match).met[0] + (width - 1u);
    for (unsigned x = 0; x < width; x++) {
        column_sum *column = columns_at(match, x);
        for (unsigned d = 0; d < match->config.disparities; d++) {
            column[d] = (column_sum)(column[d] + times * term(left[x], met[(int)d - (int)x]));
        }
    }
}

static void move_columns(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    const uint8_t *left_new = left_row_at(match, y_new);
    const uint8_t *left_old = left_row_at(match, y_old);
    const struct tsr_match_plain_scratch scratch = tsr_match_share_plain(match);
    for (unsigned x = 0; x < width; x++) {
        column_sum *restrict column = columns_at(match, x);
        const uint8_t *restrict enter = scratch.met[0] + (width - 1u - x);
        const uint8_t *restrict leave = scratch.met[1] + (width - 1u - x);
        for (unsigned d = 0; d < disparities; d++) {
            column[d] = (column_sum)(column[d] + term(left_new[x], enter[d]) - term(left_old[x], leave[d]));
        }
    }
}

static void move_sums(window_sum *restrict sums, const column_sum *restrict enter, const column_sum *restrict leave,
                      unsigned disparities)
{
    for (unsigned d = 0; d < disparities; d++) {
        sums[d] = (window_sum)(sums[d] + enter[d] - leave[d]);
    }
}

/* The window one column left of the image holds column 0 r + 2 times and columns 1 .. r - 1 once, so that moving it to
 * x = 0 is a step like every other. */
static void begin_window(const struct tsr_match *match, window_sum *sums, unsigned radius)
{
    for (unsigned d = 0; d < match->config.disparities; d++) {
        sums[d] = (window_sum)((radius + 2u) * columns_at(match, 0)[d]);
        for (unsigned x = 1; x < radius; x++) {
            sums[d] = (window_sum)(sums[d] + columns_at(match, x)[d]);
        }
    }
}

static void choose_row(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    unsigned last = match->config.width - 1u;
    unsigned radius = match->config.window / 2u;
    window_sum *sums = tsr_match_share_plain(match).sums;
    move_columns(match, y_new, y_old);
    begin_window(match, sums, radius);
    for (unsigned x = 0; x <= last; x++) {
        unsigned enter = x + radius < last ? x + radius : last;
        unsigned leave = x > radius ? x - radius - 1u : 0u;
        move_sums(sums, columns_at(match, enter), columns_at(match, leave), match->config.disparities);
        choose(match, x);
    }
}

const struct tsr_match_plain_sums PLAIN_SUMS = {add_row, choose_row};
