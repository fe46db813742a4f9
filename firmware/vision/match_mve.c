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
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <arm_mve.h>
#include <string.h>

#include "match_mve.h"
#include "match_mve_window.h"

/* What one row works on. */
struct row {
    const uint8_t *left_new;
    const uint8_t *left_old;
    const uint8_t *right_new; /* mirrored: lane d of column x meets right_end - (x - s) + d */
    const uint8_t *right_old;
    uint8_t *columns;
    const uint8_t *texture;
    uint16_t *claims; /* of x - d */
    uint16_t *choices;
    uint16_t *even; /* 16-bit sums; 8-bit sums lie behind a pad at the same place */
    uint16_t *odd;
    uint8_t *sums;
    unsigned lanes; /* D */
    unsigned start; /* s */
    unsigned last;  /* W - 1 */
    unsigned radius;
    unsigned first; /* column */
    uint32_t unique_scale; /* ceil(2^20 uniqueness / 100) */
    bool unique_off;
};

static inline unsigned least_of(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

static inline uint32_t load_word(const void *at)
{
    uint32_t word;
    __builtin_memcpy(&word, at, sizeof word);
    return word;
}

static inline void store_word(void *at, uint32_t word)
{
    __builtin_memcpy(at, &word, sizeof word);
}

static inline void claim_right(uint16_t *claims, unsigned x, unsigned sum, unsigned d)
{
    unsigned claim = sum >> 2 << 7 | d;
    uint16_t *claimed = claims + x - d;
    if (claim < *claimed) {
        *claimed = (uint16_t)claim;
    }
}

/* docs/math.md, eq. (15): the most that a sum may be to contest the least one. */
static inline unsigned limit_of(const struct row *row, unsigned sum)
{
    return sum + (sum * row->unique_scale >> 20);
}

/* docs/math.md, eq. (16), of sums in any unit. */
static inline unsigned interpolate(unsigned d, unsigned sum, unsigned below, unsigned above)
{
    unsigned higher = below > above ? below : above;
    unsigned lower = below > above ? above : below;
    unsigned slope = higher - sum;
    unsigned offset_q4 = (16u * (higher - lower) + slope) / (2u * slope);
    unsigned centre = TSR_MATCH_CHOICE(d, 0);
    return below > above ? centre + offset_q4 : centre - offset_q4;
}

/* The choice of pixel x by the least key. */
static inline __attribute__((always_inline)) unsigned choose_by_key(const struct row *row, unsigned x, unsigned key,
                                                                    bool textured)
{
    unsigned group = key % (1u << MVE_KEY_SHIFT);
    unsigned sum = key >> MVE_KEY_SHIFT;
    unsigned d = MVE_GROUP * group + mve_find_lane(row->even + 8u * group, row->odd + 8u * group, key);
    claim_right(row->claims, x, sum, d);
    if (!textured) {
        return TSR_MATCH_CHOICE_NONE;
    }
    uint16_t *own = (d % 2u != 0 ? row->odd : row->even) + d / 2u;
    uint16_t *beside = d % 2u != 0 ? row->even + d / 2u : row->odd + d / 2u - 1;
    uint32_t pair = load_word(beside);
    if (!row->unique_off) {
        store_word(beside, UINT32_MAX);
        *own = UINT16_MAX;
        unsigned others = mve_find_least_key(row->even, row->odd, row->lanes);
        store_word(beside, pair);
        *own = (uint16_t)key;
        if (others >> MVE_KEY_SHIFT <= limit_of(row, sum)) {
            return TSR_MATCH_CHOICE_NONE;
        }
    }
    if ((pair & (MVE_KEY_BARRED << 16 | MVE_KEY_BARRED)) != 0) {
        return TSR_MATCH_CHOICE(d, 0);
    }
    return interpolate(d, sum, (uint16_t)pair >> MVE_KEY_SHIFT, pair >> (16 + MVE_KEY_SHIFT));
}

/* The choice of pixel x by the least of its 8-bit sums, of which it can search some lanes. */
static inline __attribute__((always_inline)) unsigned choose_by_sum(const struct row *row, unsigned x, unsigned sum,
                                                                    unsigned lanes, bool textured)
{
    unsigned d = mve_find_lane_of_sum(row->sums, sum);
    claim_right(row->claims, x, sum, d);
    if (!textured) {
        return TSR_MATCH_CHOICE_NONE;
    }
    uint8_t *below = row->sums + d - 1;
    uint32_t near = load_word(below);
    if (!row->unique_off) {
        store_word(below, near | 0xffffffu);
        unsigned others = mve_find_least_sum(row->sums, lanes);
        store_word(below, near);
        if (others <= limit_of(row, sum) && others < UINT8_MAX) {
            return TSR_MATCH_CHOICE_NONE;
        }
    }
    if (d - 1u >= lanes - 2u) {
        return TSR_MATCH_CHOICE(d, 0);
    }
    return interpolate(d, sum, (uint8_t)near, (uint8_t)(near >> 16));
}

/* Lays a row's working memory over the scratch. */
static struct row begin_row(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned radius = config->window / 2u;
    uint16_t *keys = (uint16_t *)(void *)match->scratch;
    struct row row = {.left_new = match->left.pixels + (size_t)y_new * match->left.stride,
                      .left_old = match->left.pixels + (size_t)y_old * match->left.stride,
                      .right_new = match->right.pixels + (size_t)y_new * match->right.stride,
                      .right_old = match->right.pixels + (size_t)y_old * match->right.stride,
                      .columns = scratch.columns,
                      .texture = scratch.texture,
                      .claims = scratch.claims - start,
                      .choices = scratch.choices,
                      .even = keys,
                      .odd = keys + config->disparities / 2u + MVE_PAD,
                      .sums = match->scratch + MVE_GROUP,
                      .lanes = config->disparities,
                      .start = start,
                      .last = config->width - 1u,
                      .radius = radius,
                      .first = start > radius ? start - radius : 0u,
                      .unique_scale = ((unsigned)config->uniqueness_percent << 20) / 100u + 1u,
                      .unique_off = config->uniqueness_percent == TSR_MATCH_TEST_OFF};
    memset(scratch.claims, 0xff, sizeof *scratch.claims * config->width);
    memset(scratch.choices, 0xff, sizeof *scratch.choices * start);
    return row;
}

/* A step to any column: left of the first pixels with all lanes, or right of the picture, whose last column is then
 * taken again, unmoved. */
static struct mve_step make_step(const struct row *row, unsigned enter, unsigned *limit)
{
    unsigned x = least_of(enter, row->last);
    unsigned leave = enter > row->first + 2u * row->radius ? enter - 2u * row->radius - 1u : row->first;
    unsigned lane_of_first = x > row->start ? x - row->start : 0u; /* the d whose right pixel is 0 */
    unsigned at = row->last - lane_of_first;
    struct mve_step step = {.right_new = row->right_new + at,
                            .right_old = row->right_old + at,
                            .column = row->columns + (size_t)x * row->lanes,
                            .leave = row->columns + (size_t)leave * row->lanes,
                            .left_new = row->left_new[x],
                            .left_old = row->left_old[x]};
    if (enter > row->last) {
        step.right_new = step.right_old;
        step.left_new = step.left_old;
    }
    *limit = least_of(lane_of_first, row->lanes - 1u);
    return step;
}

static struct mve_step make_inner_step(const struct row *row, unsigned enter)
{
    unsigned at = row->last + row->start - enter;
    uint8_t *column = row->columns + (size_t)enter * row->lanes;
    struct mve_step step = {.right_new = row->right_new + at,
                            .right_old = row->right_old + at,
                            .column = column,
                            .leave = column - (2u * row->radius + 1u) * row->lanes,
                            .left_new = row->left_new[enter],
                            .left_old = row->left_old[enter]};
    return step;
}

/* The texture of the pixel before the first, less what it must be: eq. (13). */
static int begin_texture(const struct tsr_match *match, const struct row *row)
{
    const struct tsr_match_config *config = &match->config;
    int last = (int)row->last;
    int radius = (int)row->radius;
    int before = (int)row->start - 1;
    int sum = config->texture_min == TSR_MATCH_TEST_OFF ? INT16_MAX : -(int)config->texture_min * config->window;
    for (int i = before - radius; i <= before + radius; i++) {
        sum += row->texture[i < 0 ? 0 : i < last ? i : last];
    }
    return sum;
}

/* Moves the texture to the pixel of the column that enters, wherever that is. */
static int move_texture(const struct row *row, unsigned enter, int sum)
{
    unsigned window = 2u * row->radius + 1u;
    return sum + row->texture[least_of(enter, row->last)] - row->texture[enter > window ? enter - window : 0u];
}

/* Moves the first column, and starts the keys with it; all are barred. */
static void begin_keys(const struct row *row)
{
    memset(row->even, 0xff, sizeof *row->even * (row->lanes + 2u * MVE_PAD));
    for (unsigned i = 0; i < row->lanes / 2u; i++) {
        row->even[i] = row->odd[i] = (uint16_t)(MVE_KEY_BARRED | i / (MVE_GROUP / 2u));
    }
    unsigned limit;
    struct mve_step step = make_step(row, row->first, &limit);
    (void)mve_move_clipped_keys(step, row->lanes, limit, row->even, row->odd);
    unsigned scale = (2u * row->radius + 1u) << MVE_KEY_SHIFT;
    for (unsigned i = 0; i < row->lanes / 2u; i++) {
        row->even[i] = (uint16_t)(row->even[i] + scale * step.leave[2u * i]);
        row->odd[i] = (uint16_t)(row->odd[i] + scale * step.leave[2u * i + 1u]);
    }
}

static __attribute__((noinline)) int step_keys_at_border(const struct row *row, unsigned enter, int texture)
{
    unsigned limit;
    unsigned pixel = row->start + row->radius; /* whose window is complete when this column has entered */
    if (enter >= pixel && enter - pixel < row->lanes) {
        unsigned d = enter - pixel;
        uint16_t *key = (d % 2u != 0 ? row->odd : row->even) + d / 2u;
        *key = (uint16_t)(*key ^ MVE_KEY_BARRED);
    }
    struct mve_step step = make_step(row, enter, &limit);
    unsigned key = mve_move_clipped_keys(step, row->lanes, limit, row->even, row->odd);
    if (enter >= pixel) {
        unsigned x = enter - row->radius;
        texture = move_texture(row, enter, texture);
        row->choices[x] = (uint16_t)choose_by_key(row, x, key, texture >= 0);
    }
    return texture;
}

static void match_by_keys(const struct row *row, int texture)
{
    unsigned enter = row->first + 1u;
    unsigned inner = least_of(row->start + row->lanes + row->radius, row->last + 1u);
    begin_keys(row);
    for (; enter < inner; enter++) {
        texture = step_keys_at_border(row, enter, texture);
    }
    for (; enter <= row->last; enter++) {
        unsigned key = mve_move_keys(make_inner_step(row, enter), row->lanes, row->even, row->odd);
        unsigned x = enter - row->radius;
        texture += row->texture[enter] - row->texture[x - row->radius - 1u];
        row->choices[x] = (uint16_t)choose_by_key(row, x, key, texture >= 0);
    }
    for (; enter <= row->last + row->radius; enter++) {
        texture = step_keys_at_border(row, enter, texture);
    }
}

/* As begin_keys, of 8-bit sums. */
static void begin_sums(const struct row *row)
{
    memset(row->sums - MVE_GROUP, 0xff, MVE_GROUP + row->lanes + MVE_GROUP);
    memset(row->sums, 0, row->lanes);
    unsigned limit;
    struct mve_step step = make_step(row, row->first, &limit);
    mve_move_clipped_sums(step, row->lanes, limit, row->sums);
    for (unsigned i = 0; i < row->lanes; i++) {
        row->sums[i] = (uint8_t)((2u * row->radius + 1u) * step.leave[i]);
    }
}

static __attribute__((noinline)) int step_sums_at_border(const struct row *row, unsigned enter, int texture)
{
    unsigned limit;
    struct mve_step step = make_step(row, enter, &limit);
    mve_move_clipped_sums(step, row->lanes, limit, row->sums);
    if (enter >= row->start + row->radius) {
        unsigned x = enter - row->radius;
        unsigned lanes = least_of(x - row->start + 1u, row->lanes);
        texture = move_texture(row, enter, texture);
        unsigned sum = mve_find_least_sum(row->sums, lanes);
        row->choices[x] = (uint16_t)choose_by_sum(row, x, sum, lanes, texture >= 0);
    }
    return texture;
}

static void match_by_sums(const struct row *row, int texture)
{
    unsigned enter = row->first + 1u;
    unsigned inner = least_of(row->start + row->lanes + row->radius, row->last + 1u);
    begin_sums(row);
    for (; enter < inner; enter++) {
        texture = step_sums_at_border(row, enter, texture);
    }
    for (; enter <= row->last; enter++) {
        unsigned sum = mve_move_sums(make_inner_step(row, enter), row->lanes, row->sums);
        unsigned x = enter - row->radius;
        texture += row->texture[enter] - row->texture[x - row->radius - 1u];
        row->choices[x] = (uint16_t)choose_by_sum(row, x, sum, row->lanes, texture >= 0);
    }
    for (; enter <= row->last + row->radius; enter++) {
        texture = step_sums_at_border(row, enter, texture);
    }
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    tsr_mve_move_texture(match, y_new, y_old);
    const struct row row = begin_row(match, y_new, y_old);
    int texture = begin_texture(match, &row);
    if (match->config.mode == TSR_MATCH_SAD8) {
        match_by_sums(&row, texture);
    } else {
        match_by_keys(&row, texture);
    }
    tsr_mve_write_row(match, y);
}

const struct tsr_match_kernel tsr_match_kernel_mve = {"mve", tsr_mve_prefilter_row, tsr_mve_add_row, match_row};
#endif
