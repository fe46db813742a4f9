/*
 * The row of the map from what is known of its pixels, in vectors over x: tests
 * of texture (13) and uniqueness (15), offset (16), left-right consistency (17).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_CHOOSE_H
#define TSR_VISION_MATCH_VECTOR_CHOOSE_H

#include "match_vector.h"

#define UNROLLED 4u /* loops of so few instructions per pixel that counting would be half of them */

/* Lanes of ones where a test is passed. */
struct verdicts {
    _Alignas(32) int16_t textured[PIXELS_MAX];
};

struct choices {
    _Alignas(32) int16_t values[PIXELS_MAX]; /* what the map holds unless eq. (17) fails */
    uint16_t claims[PIXELS_MAX];             /* all ones where there is no d* */
    uint16_t rights[PIXELS_MAX];             /* the right pixel, or any where there is no d* */
};

/* Column sums of |P_left - cap| moved down, padded with the ends repeated. */
static void move_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old, uint8_t *padded)
{
    unsigned width = match->config.width;
    uint8_t *columns = tsr_match_share_scratch(match).texture;
    _Alignas(32) uint8_t added[PIXELS_MAX];
    _Alignas(32) uint8_t taken[PIXELS_MAX];
    memcpy(added, match->left.pixels + (size_t)y_new * match->left.stride, width);
    memcpy(taken, match->left.pixels + (size_t)y_old * match->left.stride, width);
    memcpy(padded + TSR_MATCH_WINDOW_MAX, columns, width);
    vec8 cap = splat8(match->config.prefilter_cap);
    for (unsigned x = 0; x < width; x += VECTOR_LEN) {
        uint8_t *at = padded + TSR_MATCH_WINDOW_MAX + x;
        vec8 sums = add8(load8(at), difference8(load8(added + x), cap));
        store8(at, subtract8(sums, difference8(load8(taken + x), cap)));
    }
    memcpy(columns, padded + TSR_MATCH_WINDOW_MAX, width);
    memset(padded, columns[0], TSR_MATCH_WINDOW_MAX);
    memset(padded + TSR_MATCH_WINDOW_MAX + width, columns[width - 1u], TSR_MATCH_WINDOW_MAX);
}

/* Eq. (13). */
static void judge_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old, struct verdicts *verdicts)
{
    const struct tsr_match_config *config = &match->config;
    if (config->texture_min == TSR_MATCH_TEST_OFF) {
        memset(verdicts->textured, 0xff, sizeof verdicts->textured);
        return;
    }
    uint8_t padded[PIXELS_MAX + VECTOR_LEN + 2u * TSR_MATCH_WINDOW_MAX];
    move_texture(match, y_new, y_old, padded);
    const uint8_t *first = padded + TSR_MATCH_WINDOW_MAX - config->window / 2u;
    uint8_t pairs[PIXELS_MAX + VECTOR_LEN]; /* a column sum is at most 126 */
    for (unsigned x = 0; x < config->width + (unsigned)TSR_MATCH_WINDOW_MAX; x += VECTOR_LEN) {
        store8(pairs + x, add8(load8(first + x), load8(first + x + 1u)));
    }
    vec16 least = splat16((int16_t)(config->texture_min * config->window - 1));
    for (unsigned x = 0; x < config->width; x += LANES16) {
        vec16 sums = load_wide(first + x + config->window - 1u);
        for (unsigned i = 0; i + 1u < config->window; i += 2) {
            sums = add16(sums, load_wide(pairs + x + i));
        }
        store16(verdicts->textured + x, above16(sums, least));
    }
}

/* Eq. (16). 16 |offset| is how often (2 k - 1) slope fits into 16 lean, k = 1 .. 8. */
INLINE vec16 find_offset_q4(vec16 sum, vec16 below, vec16 above)
{
    vec16 slope = subtract16(max16(below, above), sum);
    vec16 lean = subtract16(below, above);
    vec16 is_negative = SHIFT_RIGHT16(lean, 15);
    vec16 lean_q4 = SHIFT_LEFT16(subtract16(xor16(lean, is_negative), is_negative), 4);
    vec16 offset_q4 = splat16(8);
    vec16 multiple = slope;
    for (unsigned k = 1; k <= 8; k++) {
        offset_q4 = add16(offset_q4, above16(multiple, lean_q4));
        multiple = add16(multiple, add16(slope, slope));
    }
    return subtract16(xor16(offset_q4, is_negative), is_negative);
}

/* Eqs. (15) and (16), and the claims of eq. (17). */
static void choose(const struct tsr_match_config *config, const struct winners *winners,
                   const struct verdicts *verdicts, struct choices *choices)
{
    bool unique_off = config->uniqueness_percent == TSR_MATCH_TEST_OFF;
    bool whole_claims = tsr_match_claim_shift(config->mode) == 0;
    vec16 one = splat16(1);
    static const _Alignas(32) int16_t counting[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    vec16 right = subtract16(load16(counting), splat16(config->search_start_px)); /* of d = 0 */
    vec16 end = splat16((int16_t)(config->width - config->search_start_px));      /* of pixels; vectors may pass it */
    for (unsigned x = 0; x < config->width; x += LANES16) {
        vec16 d = load16(winners->d + x);
        vec16 found = load16(winners->sum + x);
        vec16 sum = SHIFT_RIGHT16(found, 4);
        vec16 below_key = load16(winners->below + x);
        vec16 above_key = load16(winners->above + x);
        vec16 bias = splat16(-2048);
        vec16 offset_q4 = find_offset_q4(add16(sum, bias), SHIFT_RIGHT16(below_key, 4), SHIFT_RIGHT16(above_key, 4));
        vec16 inside = SHIFT_RIGHT16(and16(below_key, above_key), 15); /* both neighbours are candidates */
        vec16 value = add16(SHIFT_LEFT16(d, 4), and16(offset_q4, inside));
        vec16 bound = load16(winners->bound + x);
        vec16 own = subtract16(subtract16(one, above16(bound, below_key)), above16(bound, above_key));
        vec16 valid = unique_off ? splat16(-1) : equal16(find_counts16(winners->counts + (size_t)x * KEPT_COUNTS), own);
        valid = and16(valid, load16(verdicts->textured + x));
        vec16 has_winner = and16(above16(found, splat16(-1)), above16(end, right));
        valid = and16(valid, has_winner);
        store16(choices->values + x, or16(value, xor16(valid, splat16(-1))));
        vec16 level = whole_claims ? sum : SHIFT_RIGHT16(sum, 2);
        vec16 claim = or16(SHIFT_LEFT16(level, 7), d);
        store16_anywhere((int16_t *)choices->claims + x, or16(claim, xor16(has_winner, splat16(-1))));
        store16_anywhere((int16_t *)choices->rights + x, and16(subtract16(right, d), has_winner));
        right = add16(right, splat16(LANES16));
    }
}

/* Of every right pixel the claim that holds: eq. (17). */
static void hold_claims(const struct choices *choices, unsigned width, uint16_t *held)
{
    memset(held, 0xff, width * sizeof *held);
    for (size_t x = 0; x < width; x += UNROLLED) {
        for (unsigned i = 0; i < UNROLLED; i++) {
            uint16_t right = choices->rights[x + i];
            uint16_t claim = choices->claims[x + i];
            held[right] = claim < held[right] ? claim : held[right];
        }
    }
}

static void write_row(const struct tsr_match *match, unsigned y, const struct winners *winners, struct choices *choices)
{
    const struct tsr_match_config *config = &match->config;
    if (config->lr_tolerance_px != TSR_MATCH_TEST_OFF) {
        uint16_t held[TSR_IMAGE_WIDTH_MAX];
        hold_claims(choices, config->width, held);
        vec16 tolerance = splat16(config->lr_tolerance_px);
        for (unsigned x = 0; x < config->width; x += LANES16) {
            vec16 apart = subtract16(and16(gather16(held, choices->rights + x), splat16(127)), load16(winners->d + x));
            apart = max16(apart, subtract16(splat16(0), apart));
            store16(choices->values + x, or16(load16(choices->values + x), above16(apart, tolerance)));
        }
    }
    memcpy(match->map + (size_t)y * config->width, choices->values, config->width * sizeof *match->map);
}

#endif
