/*
 * The matcher's rows with MVE (Helium), the vector extension of Armv8.1-M.
 *
 * Every column holds all lanes, eq. (11); a lane d that the pixel cannot search
 * is barred, in 16-bit sums by a bit of its key that is taken away at pixel
 * x = s + d, in 8-bit sums by searching the first x - s + 1 lanes only.
 *
 * The window begins at the first column that counts, as if that column stood
 * there `window` times; what leaves until then is that column too: eq. (12).
 *
 * Texture and offset, eqs. (13) and (16), wait until eight pixels are found.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <string.h>

#include "match_mve.h"
#include "match_mve_search.h"

#define CLAIM_SHIFT 2u /* of the SAD modes */

/* What one row works on. */
struct row {
    struct mve_uniqueness uniqueness;
    struct mve_window window;
    struct tsr_mve_found found[TSR_MVE_FOUND_COUNT];
    struct tsr_mve_found *next; /* of found */
    uint16_t *claims;           /* of the next pixel's lane 0 */
    uint16_t *choices;          /* of the first pixel in found */
    unsigned enter;             /* the next column */
    uint8_t *first_column;
    unsigned first; /* its number */
    unsigned start; /* s */
    unsigned last;  /* W - 1 */
    unsigned radius;
    unsigned settled; /* until this column has entered, what leaves is the first column */
    unsigned texture_least;
    unsigned shift; /* of sums in found */
};

static inline unsigned least_of(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* Lays a row's working memory over the scratch. */
static void begin_row(const struct tsr_match *match, unsigned y_new, unsigned y_old, struct row *row)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    bool textured = config->texture_min != TSR_MATCH_TEST_OFF;
    uint16_t *keys = (uint16_t *)(void *)match->scratch;
    row->uniqueness = mve_uniqueness_of(config);
    row->claims = scratch.claims;
    row->choices = scratch.choices + start;
    row->next = row->found;
    row->start = start;
    row->last = config->width - 1u;
    row->radius = config->window / 2u;
    row->first = start > row->radius ? start - row->radius : 0u;
    row->enter = row->first + 1u;
    row->settled = row->first + 2u * row->radius + 1u; /* at least s */
    row->first_column = scratch.columns + (size_t)row->first * config->disparities;
    row->texture_least = textured ? (unsigned)config->texture_min * config->window : 0u;
    row->window = (struct mve_window){
        .left_new = match->left.pixels + (size_t)y_new * match->left.stride + row->first - 1,
        .left_old = match->left.pixels + (size_t)y_old * match->left.stride + row->first - 1,
        .right_new = match->right.pixels + (size_t)y_new * match->right.stride + row->last,
        .right_old = match->right.pixels + (size_t)y_old * match->right.stride + row->last,
        .column = row->first_column - config->disparities,
        .even = keys,
        .odd = keys + config->disparities / 2u + MVE_PAD,
        .lanes = config->disparities,
    };
    memset(scratch.claims, 0xff, sizeof *scratch.claims * config->width);
    memset(scratch.choices, 0xff, sizeof *scratch.choices * start);
}

/* The room for the next pixels. */
static __attribute__((noinline)) struct tsr_mve_found *finish_found(struct row *row, const struct tsr_mve_found *end)
{
    unsigned count = (unsigned)(end - row->found);
    tsr_mve_choose(row->found, count, row->shift, row->texture_least, row->choices);
    row->choices += count;
    return row->found;
}

/* Before the step to a column that is left of the first pixel with all lanes, or right of the picture: the last column
 * is then taken again, unmoved. */
static inline void set_border(struct row *row, unsigned enter)
{
    struct mve_window *window = &row->window;
    if (enter > row->settled && enter <= row->last) { /* also right of s: one more lane than before */
        window->limit += window->limit < window->lanes - 1u ? 1u : 0u;
        return;
    }
    unsigned x = enter;
    if (enter <= row->settled) {
        window->leave = row->first_column - window->lanes;
    }
    if (enter <= row->start) {
        window->right_new++;
        window->right_old++;
    }
    if (enter > row->last) {
        x = row->last;
        window->column -= window->lanes;
        window->right_new = ++window->right_old;
        window->left_new = --window->left_old;
    }
    unsigned lane_of_first = x > row->start ? x - row->start : 0u; /* the d whose right pixel is 0 */
    window->limit = least_of(lane_of_first, window->lanes - 1u);
}

/* Moves the first column, and starts the keys with it; all are barred. */
static void begin_keys(struct row *row)
{
    uint16_t *even = row->window.even;
    uint16_t *odd = row->window.odd;
    memset(even + row->window.lanes / 2u, 0xff, sizeof *even * MVE_PAD);
    memset(odd + row->window.lanes / 2u, 0xff, sizeof *odd * MVE_PAD);
    set_border(row, row->first);
    (void)mve_move_clipped_keys(&row->window);
    mve_fill_keys(even, odd, row->window.lanes, row->first_column, 2u * row->radius + 1u);
}

/* As begin_keys, of 8-bit sums, which lie between pads. */
static void begin_sums(struct row *row)
{
    uint8_t *sums = row->window.even;
    memset(sums, 0xff, TSR_MVE_GROUP);
    sums += TSR_MVE_GROUP;
    row->window.even = sums;
    memset(sums + row->window.lanes, 0xff, TSR_MVE_GROUP);
    set_border(row, row->first);
    mve_move_clipped_sums(&row->window);
    mve_fill_sums(sums, row->window.lanes, row->first_column, 2u * row->radius + 1u);
}

/* Lane d is searched from the next pixel on. */
static inline void unbar_key(const struct row *row, unsigned d)
{
    uint16_t *key = (d % 2u != 0 ? row->window.odd : (uint16_t *)row->window.even) + d / 2u;
    *key = (uint16_t)(*key ^ MVE_KEY_BARRED);
}

/* Columns row->enter .. end - 1. */
static inline __attribute__((always_inline)) void slide_keys(struct row *row, unsigned end, bool border)
{
    struct tsr_mve_found *next = row->next;
    uint16_t *claims = row->claims;
    unsigned pixel = row->start + row->radius; /* the column that completes the first window */
    for (unsigned enter = row->enter; enter < end; enter++) {
        unsigned key;
        if (border) {
            if (enter - pixel < row->window.lanes) {
                unbar_key(row, enter - pixel);
            }
            set_border(row, enter);
            key = mve_move_clipped_keys(&row->window);
            if (enter < pixel) {
                continue;
            }
        } else {
            key = mve_move_keys(&row->window);
        }
        *next++ = mve_search_keys(&row->uniqueness, &row->window, claims++, CLAIM_SHIFT, key);
        if (next == row->found + TSR_MVE_FOUND_COUNT) {
            next = finish_found(row, next);
        }
    }
    row->next = next;
    row->claims = claims;
    row->enter = end;
}

static __attribute__((noinline)) void slide_keys_at_border(struct row *row, unsigned end)
{
    slide_keys(row, end, true);
}

/* The same of 8-bit sums. */
static inline __attribute__((always_inline)) void slide_sums(struct row *row, unsigned end, bool border)
{
    struct tsr_mve_found *next = row->next;
    uint16_t *claims = row->claims;
    unsigned pixel = row->start + row->radius;
    for (unsigned enter = row->enter; enter < end; enter++) {
        unsigned sum;
        unsigned lanes = row->window.lanes;
        if (border) {
            set_border(row, enter);
            mve_move_clipped_sums(&row->window);
            if (enter < pixel) {
                continue;
            }
            lanes = least_of(enter - pixel + 1u, lanes);
            sum = mve_find_least_sum(row->window.even, lanes);
        } else {
            sum = mve_move_sums(&row->window);
        }
        *next++ = mve_search_sums(&row->uniqueness, row->window.even, lanes, claims++, CLAIM_SHIFT, sum);
        if (next == row->found + TSR_MVE_FOUND_COUNT) {
            next = finish_found(row, next);
        }
    }
    row->next = next;
    row->claims = claims;
    row->enter = end;
}

static __attribute__((noinline)) void slide_sums_at_border(struct row *row, unsigned end)
{
    slide_sums(row, end, true);
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    struct row row;
    tsr_mve_move_texture(match, y_new, y_old);
    begin_row(match, y_new, y_old, &row);
    unsigned width = match->config.width;
    unsigned inner = least_of(row.start + row.window.lanes + row.radius, width); /* all lanes are searched from here */
    if (match->config.mode == TSR_MATCH_SAD8) {
        row.shift = 0;
        begin_sums(&row);
        slide_sums_at_border(&row, inner);
        slide_sums(&row, width, false);
        slide_sums_at_border(&row, width + row.radius);
    } else {
        row.shift = MVE_KEY_SHIFT;
        begin_keys(&row);
        slide_keys_at_border(&row, inner);
        slide_keys(&row, width, false);
        slide_keys_at_border(&row, width + row.radius);
    }
    (void)finish_found(&row, row.next);
    tsr_mve_write_row(match, y);
}

const struct tsr_match_kernel tsr_match_kernel_mve = {
    .name = "mve",
    .prefilter_row = tsr_mve_prefilter_row,
    .add_row = tsr_mve_add_row,
    .match_row = match_row,
};

const struct tsr_match_census_kernel tsr_match_census_mve = {tsr_mve_describe_row, tsr_mve_add_census,
                                                             tsr_mve_census_row, tsr_mve_cost_row, tsr_mve_smooth_row};
#endif
