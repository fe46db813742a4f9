/*
 * The matcher's rows in vectors over disparities, for any instruction set that
 * gives the operations named below. Included once by each such kernel, after
 * them:
 *
 *   VECTOR_LANES                   lanes of a vec8
 *   vec8, vec16                    bytes; half as many int16_t
 *   load8 store8 splat8 store16 splat16
 *   difference8(a, b)              |a - b| of unsigned bytes
 *   add8 subtract8 add16 min16
 *   even16(a), odd16(a)            bytes with a sign, widened
 *   least16(a, &sum)               the least lane, in every lane and as a number
 *   mask_equal(e, o, a), mask_above(e, o, a)   bit i: lane i of bytes e, o were
 *                                  widened from is equal to / greater than a
 *   select_above(index, x, a, b), select_equal(index, x, a, b)
 *
 * Window sums stay in registers, even and odd lanes apart, so the count of
 * vectors is a constant wherever vector_row() is used. The last vector ends with
 * the last disparity and may share lanes with the one before it: what both
 * compute is the same.
 *
 * A lane d starts at pixel x = d, as in match_dsp.c; columns left of it do not
 * have the lane and hold anything there.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#define NOT_STARTED 0x4000
#define VECTORS_MAX (TSR_DISPARITY_COUNT_MAX / VECTOR_LANES)

/* What the first pass over a row finds out about its pixels. */
struct winners {
    int16_t sum[TSR_IMAGE_WIDTH_MAX];
    int16_t below[TSR_IMAGE_WIDTH_MAX]; /* the sum at d - 1, at d + 1; anything where there is none */
    int16_t above[TSR_IMAGE_WIDTH_MAX];
    uint8_t d[TSR_IMAGE_WIDTH_MAX];
    uint8_t unique[TSR_IMAGE_WIDTH_MAX];
};

struct window {
    vec16 even[VECTORS_MAX];
    vec16 odd[VECTORS_MAX];
};

static inline __attribute__((always_inline)) unsigned first_lane(unsigned vector, unsigned vectors,
                                                                 unsigned disparities)
{
    return vector + 1u < vectors ? vector * VECTOR_LANES : disparities - VECTOR_LANES;
}

/* Column sums take the new difference and lose the old one; window sums take what enter has more than leave. */
static inline __attribute__((always_inline)) void move_window(struct window *window, unsigned vectors,
                                                              unsigned disparities, const uint8_t *right_new,
                                                              const uint8_t *right_old, uint8_t *enter,
                                                              const uint8_t *leave, uint8_t left_new, uint8_t left_old)
{
    vec8 columns[VECTORS_MAX];
    for (unsigned i = 0; i < vectors; i++) {
        columns[i] = load8(enter + first_lane(i, vectors, disparities));
    }
    for (unsigned i = 0; i < vectors; i++) {
        unsigned at = first_lane(i, vectors, disparities);
        vec8 added = difference8(splat8(left_new), load8(right_new + at));
        vec8 taken = difference8(splat8(left_old), load8(right_old + at));
        vec8 column = subtract8(add8(columns[i], added), taken);
        store8(enter + at, column);
        vec8 change = subtract8(column, load8(leave + at));
        window->even[i] = add16(window->even[i], even16(change));
        window->odd[i] = add16(window->odd[i], odd16(change));
    }
}

/* Lane x starts with this sum; columns before it that will leave get its first column's. */
static int16_t start_lane(uint8_t *columns, unsigned count, unsigned disparities, unsigned x, unsigned radius)
{
    uint8_t *column = columns + (size_t)x * disparities + x;
    unsigned sum = (radius + 1u) * *column;
    for (unsigned i = 1; i <= radius; i++) {
        unsigned to_last = count - 1u - x;
        sum += column[(size_t)(i < to_last ? i : to_last) * disparities];
    }
    for (unsigned i = 1; i <= radius && i <= x; i++) {
        column[-(ptrdiff_t)(i * disparities)] = *column;
    }
    return (int16_t)sum;
}

/* Lanes that have not started do not take part; lane x starts with the sum. */
static inline __attribute__((always_inline)) void set_border(struct window *window, unsigned vectors,
                                                             unsigned disparities, int x, int16_t sum)
{
    for (unsigned i = 0; i < vectors; i++) {
        int at = (int)first_lane(i, vectors, disparities);
        window->even[i] = select_equal(at, x, splat16(sum), select_above(at, x, splat16(NOT_STARTED), window->even[i]));
        window->odd[i] =
            select_equal(at + 1, x, splat16(sum), select_above(at + 1, x, splat16(NOT_STARTED), window->odd[i]));
    }
}

/* Sets bits from .. from + VECTOR_LANES - 1 of the 128. */
static inline __attribute__((always_inline)) void place_bits(uint64_t bits[2], unsigned from, uint64_t lanes)
{
    bits[from / 64u] |= lanes << from % 64u;
    if (from % 64u + VECTOR_LANES > 64u) {
        bits[1] |= lanes >> (64u - from % 64u);
    }
}

/* The lanes beside d and d itself. */
static inline __attribute__((always_inline)) uint64_t own_bits(unsigned d)
{
    return UINT64_C(3) << d | UINT64_C(1) << d >> 1;
}

/* The winner of a pixel and eq. (15), without a look at what is textured. */
static inline __attribute__((always_inline)) void choose(const struct window *window, unsigned vectors,
                                                         unsigned disparities, uint32_t scale, struct winners *winners,
                                                         unsigned x)
{
    vec16 least = min16(window->even[0], window->odd[0]);
    for (unsigned i = 1; i < vectors; i++) {
        least = min16(least, min16(window->even[i], window->odd[i]));
    }
    unsigned sum;
    vec16 sums = least16(least, &sum);
    vec16 limits = splat16((int16_t)(sum + (sum * scale >> 20)));
    uint64_t equal[2] = {0, 0};
    uint64_t above[2] = {0, 0};
    int16_t lanes[2][VECTORS_MAX * VECTOR_LANES / 2u + 2u]; /* even and odd, from lane -2 on */
    for (unsigned i = 0; i < vectors; i++) {
        unsigned at = first_lane(i, vectors, disparities);
        place_bits(equal, at, mask_equal(window->even[i], window->odd[i], sums));
        place_bits(above, at, mask_above(window->even[i], window->odd[i], limits));
        store16(lanes[0] + at / 2u + 1u, window->even[i]);
        store16(lanes[1] + at / 2u + 1u, window->odd[i]);
    }
    unsigned d;
    uint64_t others;
    if (vectors * VECTOR_LANES <= 64u) {
        uint64_t all = disparities < 64u ? (UINT64_C(1) << disparities) - 1u : UINT64_MAX;
        d = (unsigned)__builtin_ctzll(equal[0]);
        others = ~above[0] & all & ~own_bits(d);
    } else {
        uint64_t all_high = disparities < 128u ? (UINT64_C(1) << (disparities - 64u)) - 1u : UINT64_MAX;
        bool is_high = equal[0] == 0;
        unsigned at = (unsigned)__builtin_ctzll(is_high ? equal[1] : equal[0]);
        d = is_high ? 64u + at : at;
        uint64_t own_low = is_high ? (uint64_t)(at == 0) << 63 : own_bits(at);
        uint64_t own_high = is_high ? own_bits(at) : (uint64_t)(at == 63u);
        others = (~above[0] & ~own_low) | (~above[1] & all_high & ~own_high);
    }
    winners->sum[x] = (int16_t)sum;
    /* The analyser does not see what vectors store. Lanes -1 and D are read and not used. */
    winners->below[x] = lanes[(d + 1u) & 1u][(d + 1u) / 2u]; // NOLINT(clang-analyzer-core.uninitialized.Assign)
    winners->above[x] = lanes[(d + 3u) & 1u][(d + 3u) / 2u]; // NOLINT(clang-analyzer-core.uninitialized.Assign)
    winners->d[x] = (uint8_t)d;
    winners->unique[x] = others == 0;
}

static inline __attribute__((always_inline)) void find_winners(const struct tsr_match *match, unsigned y_new,
                                                               unsigned y_old, unsigned vectors, unsigned disparities,
                                                               struct winners *winners)
{
    const struct tsr_match_config *config = &match->config;
    unsigned start = (unsigned)config->search_start_px;
    unsigned radius = config->window / 2u;
    unsigned count = config->width - start;
    uint32_t scale = ((uint32_t)config->uniqueness_percent << 20) / 100u + 1u;
    uint8_t *columns = tsr_match_share_scratch(match).columns + (size_t)start * disparities;
    const uint8_t *left_new = match->left.pixels + (size_t)y_new * match->left.stride + start;
    const uint8_t *left_old = match->left.pixels + (size_t)y_old * match->left.stride + start;
    const uint8_t *right_new = match->right.pixels + (size_t)y_new * match->right.stride + (config->width - 1u);
    const uint8_t *right_old = match->right.pixels + (size_t)y_old * match->right.stride + (config->width - 1u);
    /* Lanes that have not started read beyond the mirrored row's end: of the last row, a copy stands in for it. */
    uint8_t edge[2u * TSR_DISPARITY_COUNT_MAX] = {0};
    memcpy(edge, right_new - (disparities - 1u), disparities);

    struct window window;
    for (unsigned i = 0; i < vectors; i++) {
        window.even[i] = window.odd[i] = splat16(NOT_STARTED);
    }
    for (unsigned enter = 0; enter < count + radius; enter++) {
        int x = (int)enter - (int)radius;
        const uint8_t *leave = columns + (size_t)(x > (int)radius ? (unsigned)x - radius - 1u : 0u) * disparities;
        if (enter < count) {
            const uint8_t *new_lanes = enter < disparities ? edge + (disparities - 1u - enter) : right_new - enter;
            move_window(&window, vectors, disparities, new_lanes, right_old - enter,
                        columns + (size_t)enter * disparities, leave, left_new[enter], left_old[enter]);
        } else { /* the last column is taken again, unmoved */
            move_window(&window, vectors, disparities, right_old - (count - 1u), right_old - (count - 1u),
                        columns + (size_t)(count - 1u) * disparities, leave, 0, 0);
        }
        if (x < (int)disparities) {
            int16_t sum = x >= 0 ? start_lane(columns, count, disparities, (unsigned)x, radius) : 0;
            set_border(&window, vectors, disparities, x, sum);
        }
        if (x >= 0) {
            choose(&window, vectors, disparities, scale, winners, (unsigned)x);
        }
    }
}

/* With the count of vectors a constant, and that of disparities if they fill them. */
static inline __attribute__((always_inline)) void find_winners_of(const struct tsr_match *match, unsigned y_new,
                                                                  unsigned y_old, unsigned vectors,
                                                                  struct winners *winners)
{
    unsigned disparities = match->config.disparities;
    if (disparities == vectors * VECTOR_LANES) {
        find_winners(match, y_new, y_old, vectors, vectors * VECTOR_LANES, winners);
    } else {
        find_winners(match, y_new, y_old, vectors, disparities, winners);
    }
}

/* Texture column sums moved, and which pixels have enough: eq. (13). */
static void judge_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old, uint8_t *textured)
{
    const struct tsr_match_config *config = &match->config;
    unsigned width = config->width;
    unsigned radius = config->window / 2u;
    uint8_t cap = config->prefilter_cap;
    const uint8_t *restrict new_row = match->left.pixels + (size_t)y_new * match->left.stride;
    const uint8_t *restrict old_row = match->left.pixels + (size_t)y_old * match->left.stride;
    uint8_t *restrict columns = tsr_match_share_scratch(match).texture;
    for (unsigned x = 0; x < width; x++) {
        uint8_t added = (uint8_t)(new_row[x] > cap ? new_row[x] - cap : cap - new_row[x]);
        uint8_t taken = (uint8_t)(old_row[x] > cap ? old_row[x] - cap : cap - old_row[x]);
        columns[x] = (uint8_t)(columns[x] + added - taken);
    }
    unsigned least = config->texture_min == TSR_MATCH_TEST_OFF ? 0u : (unsigned)config->texture_min * config->window;
    uint8_t padded[TSR_IMAGE_WIDTH_MAX + TSR_MATCH_WINDOW_MAX];
    memset(padded, columns[0], radius);
    memcpy(padded + radius, columns, width);
    memset(padded + radius + width, columns[width - 1u], radius);
    uint16_t sums[TSR_IMAGE_WIDTH_MAX] = {0};
    for (unsigned i = 0; i < config->window; i++) {
        for (unsigned x = 0; x < width; x++) {
            sums[x] = (uint16_t)(sums[x] + padded[x + i]);
        }
    }
    for (unsigned x = 0; x < width; x++) {
        textured[x] = sums[x] >= least;
    }
}

/* Eq. (16). 16 |offset| is how often (2 k - 1) slope fits into 16 lean, k = 1 .. 8. */
static void write_choices(const struct winners *restrict winners, const uint8_t *restrict textured, unsigned count,
                          const struct tsr_match_config *config, uint16_t *restrict choices)
{
    int16_t highest = (int16_t)(config->disparities - 1);
    uint8_t unique_off = config->uniqueness_percent == TSR_MATCH_TEST_OFF;
    for (unsigned x = 0; x < count; x++) {
        int16_t d = winners->d[x]; // NOLINT(clang-analyzer-core.uninitialized.Assign): every pixel has a winner
        int16_t below = winners->below[x];
        int16_t above = winners->above[x];
        int16_t slope = (int16_t)((below > above ? below : above) - winners->sum[x]);
        int16_t lean = (int16_t)(below - above);
        int16_t lean_q4 = (int16_t)(16 * (lean > 0 ? lean : -lean));
        int16_t offset_q4 = 0;
        for (int16_t k = 1; k <= 15; k = (int16_t)(k + 2)) {
            offset_q4 = (int16_t)(offset_q4 + (lean_q4 >= (int16_t)(k * slope) ? 1 : 0));
        }
        offset_q4 = lean > 0 ? offset_q4 : (int16_t)-offset_q4;
        bool inside = (d > 0) & (d < highest) & (d < (int16_t)x); /* both neighbours are candidates */
        int16_t choice = (int16_t)TSR_MATCH_CHOICE(d, inside ? offset_q4 : 0);
        bool valid = (winners->unique[x] | unique_off) & textured[x];
        choices[x] = (uint16_t)(valid ? choice : -1);
    }
}

static void claim_right(const struct winners *winners, unsigned count, uint16_t *claims)
{
    for (unsigned x = 0; x < count; x++) {
        uint16_t claim = TSR_MATCH_CLAIM(winners->sum[x], winners->d[x]);
        uint16_t *held = claims + (x - winners->d[x]);
        *held = claim < *held ? claim : *held;
    }
}

static void finish_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old,
                       const struct winners *winners)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned count = config->width - start;
    uint8_t textured[TSR_IMAGE_WIDTH_MAX];
    judge_texture(match, y_new, y_old, textured);
    for (unsigned x = 0; x < start; x++) {
        scratch.choices[x] = TSR_MATCH_CHOICE_NONE;
    }
    write_choices(winners, textured + start, count, config, scratch.choices + start);
    memset(scratch.claims, 0xff, sizeof *scratch.claims * config->width);
    claim_right(winners, count, scratch.claims);
    tsr_match_write_row(match, y);
}
