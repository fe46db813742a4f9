/*
 * Path costs of a row in vectors of bytes over d, and their sums as the keys of
 * match_vector_sums.h, from where the choice goes on as in the SAD modes.
 *
 * A vector's neighbours d - 1 and d + 1 come from registers, so that path costs
 * may be stored where those of the row above were. Where the last vector ends
 * behind the last disparity, its other lanes hold 255.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_SMOOTH_H
#define TSR_VISION_MATCH_VECTOR_SMOOTH_H

#include "match_vector_census.h"
#include "match_vector_choose.h"
#include "match_vector_sums.h"

#define SUM_BIAS 128 /* sums are widened with a sign */

/* What a row works on, and what goes from pixel to pixel. */
struct smooth_row {
    const uint8_t *costs[TSR_MATCH_SMOOTH_ROWS];
    struct tsr_match_paths paths;
    const uint8_t *gray;
    const uint8_t *gray_above;
    unsigned width;
    unsigned disparities;
    int start;
    vec8 excess;                                        /* 255 in the lanes of the last vector that do not count */
    vec8 least_left;                                    /* of left, in every byte */
    _Alignas(32) uint8_t here[TSR_DISPARITY_COUNT_MAX]; /* sums of C over three rows: of column x, */
    _Alignas(32) uint8_t both[TSR_DISPARITY_COUNT_MAX]; /* of columns x - 1 and x together */
    _Alignas(32) uint8_t left[TSR_DISPARITY_COUNT_MAX]; /* path costs of the pixel before */
    _Alignas(32) int16_t base[TSR_DISPARITY_COUNT_MAX]; /* of keys */
};

/* One path on its way over the vectors of a pixel: eq. (44). */
struct path {
    const uint8_t *source;
    uint8_t *target;
    vec8 least; /* of the source, in every byte */
    vec8 jump;  /* the same with the penalty */
    vec8 previous;
    vec8 here;
    vec8 found; /* least of the target so far, lane by lane */
};

/* Vector i of costs, where lanes that do not count hold 255. */
INLINE vec8 load_costs(const struct smooth_row *row, struct shape shape, const uint8_t *at, unsigned i)
{
    vec8 costs = load8(at + i * VECTOR_LEN);
    return i + 1u < shape.vectors ? costs : add_saturated8(costs, row->excess);
}

INLINE struct path begin_path(const struct smooth_row *row, struct shape shape, const uint8_t *source, uint8_t *target,
                              vec8 least, uint8_t penalty)
{
    struct path path = {source,
                        target,
                        least,
                        add8(least, splat8(penalty)),
                        splat8(UINT8_MAX),
                        load_costs(row, shape, source, 0),
                        splat8(UINT8_MAX)};
    return path;
}

/* No lane that counts wraps: costs are at most 68, and best is never below least. */
INLINE vec8 walk(const struct smooth_row *row, struct shape shape, struct path *path, unsigned i, vec8 cost)
{
    bool is_last = i + 1u == shape.vectors;
    vec8 next = is_last ? splat8(UINT8_MAX) : load_costs(row, shape, path->source, i + 1u);
    vec8 beside = min8(before8(path->here, path->previous), behind8(path->here, next));
    vec8 best = min8(min8(path->here, path->jump), add_saturated8(beside, splat8(TSR_MATCH_PENALTY_NEAR)));
    vec8 value = subtract8(add8(cost, best), path->least);
    if (is_last) {
        store_lanes8(path->target + i * VECTOR_LEN, value, row->disparities - i * VECTOR_LEN);
        path->found = min8(path->found, add_saturated8(value, row->excess));
    } else {
        store8(path->target + i * VECTOR_LEN, value);
        path->found = min8(path->found, value);
    }
    path->previous = path->here;
    path->here = next;
    return value;
}

/* Eq. (42): column enters, which gives B of the one before. */
INLINE vec8 move_box(struct smooth_row *row, unsigned column, unsigned i)
{
    size_t at = (size_t)column * row->disparities + i * VECTOR_LEN;
    vec8 sums = add8(add8(load8(row->costs[0] + at), load8(row->costs[1] + at)), load8(row->costs[2] + at));
    vec8 here = load8_aligned(row->here + i * VECTOR_LEN);
    vec8 both = load8_aligned(row->both + i * VECTOR_LEN);
    store8(row->here + i * VECTOR_LEN, sums);
    store8(row->both + i * VECTOR_LEN, add8(here, sums));
    return quarter8(add8(both, sums));
}

/* Lane x - s becomes a candidate, the one behind W of them ceases to be. */
INLINE void move_candidates(struct smooth_row *row, unsigned x)
{
    int lane = (int)x - row->start;
    lane -= lane >= (int)row->width ? (int)row->width : 0;
    if (lane >= 0 && lane < (int)row->disparities) {
        row->base[lane] = (int16_t)(row->base[lane] ^ INT16_MIN);
    }
}

/* Keys and the least of them of one pixel: eqs. (42) to (46). */
INLINE void sum_paths(struct smooth_row *row, struct shape shape, unsigned x, int16_t *keys, int16_t *kept)
{
    static const _Alignas(32) uint8_t none[TSR_DISPARITY_COUNT_MAX] = {0};
    struct tsr_match_paths *paths = &row->paths;
    size_t at = (size_t)x * row->disparities;
    unsigned last = row->width - 1u;
    uint8_t gray = row->gray[x];
    struct path left = begin_path(row, shape, x > 0 ? row->left : none, row->left, row->least_left,
                                  x > 0 ? tsr_match_penalty_far(gray, row->gray[x - 1u]) : 0);
    struct path up = begin_path(row, shape, paths->above[0] + at, paths->above[0] + at, splat8(paths->least[0][x]),
                                tsr_match_penalty_far(gray, row->gray_above[x]));
    struct path right =
        x < last ? begin_path(row, shape, paths->above[1] + at + row->disparities, paths->above[1] + at,
                              splat8(paths->least[1][x + 1u]), tsr_match_penalty_far(gray, row->gray_above[x + 1u]))
                 : begin_path(row, shape, none, paths->above[1] + at, splat8(0), 0);
    vec16 least = splat16(INT16_MAX);
    for (unsigned i = 0; i < shape.vectors; i++) {
        vec8 cost = move_box(row, x < last ? x + 1u : last, i);
        vec8 sums = add8(walk(row, shape, &left, i, cost),
                         add8(walk(row, shape, &up, i, cost), walk(row, shape, &right, i, cost)));
        vec8 biased = pair_lanes(xor8(sums, splat8(SUM_BIAS)));
        vec16 first = add16(first_times16(biased), load16(row->base + i * VECTOR_LEN));
        vec16 second = add16(second_times16(biased), load16(row->base + i * VECTOR_LEN + LANES16));
        first = mask_excess(first, shape, 2u * i, row->disparities);
        second = mask_excess(second, shape, 2u * i + 1u, row->disparities);
        store16(keys + i * VECTOR_LEN, first);
        store16(keys + i * VECTOR_LEN + LANES16, second);
        least = min16(least, min16(first, second));
    }
    keep_least16(least, kept);
    row->least_left = spread_least8(left.found);
    paths->least[0][x] = first_byte8(spread_least8(up.found));
    paths->least[1][x] = first_byte8(spread_least8(right.found));
}

/* Column 0 enters, and stands for the one before it as well. */
INLINE void begin_smooth_row(struct smooth_row *row, struct shape shape)
{
    for (unsigned i = 0; i < shape.vectors; i++) {
        (void)move_box(row, 0, i);
        (void)move_box(row, 0, i);
    }
    for (unsigned d = 0; d < shape.vectors * VECTOR_LEN; d++) {
        bool is_candidate = (int)d < -row->start && d < row->disparities;
        row->base[d] = (int16_t)((int)(d / shape.lanes) + 16 * SUM_BIAS + (is_candidate ? INT16_MIN : 0));
    }
    uint8_t excess[VECTOR_LEN];
    for (unsigned i = 0; i < VECTOR_LEN; i++) {
        excess[i] = (shape.vectors - 1u) * VECTOR_LEN + i < row->disparities ? 0 : UINT8_MAX;
    }
    row->excess = load8(excess);
}

INLINE void find_smooth_winners(struct smooth_row *row, struct shape shape, unsigned percent, struct winners *winners)
{
    _Alignas(32) int16_t keys[KEYS_MAX];
    for (unsigned i = 0; i <= BLOCK; i++) {
        memset(keys_at(keys, shape, i) - KEY_PAD, 0, KEY_PAD * sizeof *keys);
    }
    begin_smooth_row(row, shape);
    for (unsigned from = 0; from < row->width; from += BLOCK) {
        unsigned left = row->width - from;
        unsigned count = left < BLOCK ? left : BLOCK;
        for (unsigned i = 0; i < count; i++) {
            move_candidates(row, from + i);
            sum_paths(row, shape, from + i, keys_at(keys, shape, i), winners->kept + (size_t)(from + i) * KEPT_LANES);
        }
        find_bounds(shape, from, percent, winners);
        count_within(shape, keys, from, winners);
    }
}

/* With the usual counts of vectors as constants. */
static void find_smooth_winners_for(struct smooth_row *row, unsigned percent, struct winners *winners)
{
    unsigned vectors = (row->disparities + VECTOR_LEN - 1u) / VECTOR_LEN;
    bool excess = row->disparities % VECTOR_LEN != 0;
    if (vectors == 32u / VECTOR_LEN && !excess) {
        find_smooth_winners(row, (struct shape){32u / VECTOR_LEN, false, false, least_lanes(32u / VECTOR_LEN)}, percent,
                            winners);
    } else if (vectors == 64u / VECTOR_LEN && !excess) {
        find_smooth_winners(row, (struct shape){64u / VECTOR_LEN, false, false, least_lanes(64u / VECTOR_LEN)}, percent,
                            winners);
    } else {
        find_smooth_winners(row, (struct shape){vectors, excess, false, least_lanes(vectors)}, percent, winners);
    }
}

static void smooth_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    const uint8_t *gray = match->left.pixels + (size_t)y * match->left.stride;
    struct smooth_row row = {.costs = {tsr_match_costs_at(match, y > 0 ? y - 1u : 0u), tsr_match_costs_at(match, y),
                                       tsr_match_costs_at(match, y + 1u < config->height ? y + 1u : y)},
                             .paths = tsr_match_share_paths(match),
                             .gray = gray,
                             .gray_above = y > 0 ? gray - match->left.stride : gray,
                             .width = config->width,
                             .disparities = config->disparities,
                             .start = config->search_start_px};
    struct winners winners;
    struct verdicts verdicts;
    struct choices choices;
    memset(winners.kept + (size_t)config->width * KEPT_LANES, 0, BLOCK * KEPT_LANES * sizeof *winners.kept);
    find_smooth_winners_for(&row, config->uniqueness_percent, &winners);
    memset(verdicts.textured, 0xff, sizeof verdicts.textured);
    choose(config, &winners, &verdicts, &choices);
    write_row(match, y, &winners, &choices);
}

#endif
