/*
 * The choices of a row and its map with MVE, eight pixels at once: tests of
 * texture and left-right consistency, and the sub-pixel offset.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <arm_mve.h>

#include "match_mve.h"

#define BYTES 16u /* lanes of a vector */
#define HALVES 8u

/* floor((16 lean + slope) / (2 slope)) of lean <= slope, at most 8: bit by bit. 17 slope fits 16 bits. */
static inline uint16x8_t divide(uint16x8_t lean, uint16x8_t slope)
{
    uint16x8_t rest = vaddq_u16(vshlq_n_u16(lean, 4), slope);
    uint16x8_t divisor = vshlq_n_u16(slope, 4);
    uint16x8_t quotient = vdupq_n_u16(0);
    for (uint16_t bit = 8; bit != 0; bit = (uint16_t)(bit >> 1)) {
        mve_pred16_t fits = vcmpcsq_u16(rest, divisor);
        rest = vsubq_m_u16(rest, rest, divisor, fits);
        quotient = vaddq_m_n_u16(quotient, quotient, bit, fits);
        divisor = vshrq_n_u16(divisor, 1);
    }
    return quotient;
}

void tsr_mve_choose(const struct tsr_mve_found found[TSR_MVE_FOUND_COUNT], unsigned count, unsigned shift,
                    unsigned texture_least, uint16_t *choices)
{
    uint16x8x4_t all = vld4q_u16((const uint16_t *)(const void *)found);
    uint16x8_t disparities = all.val[1];
    mve_pred16_t lanes = vctp16q(count);
    mve_pred16_t inner = vcmpgeq_n_s16(vreinterpretq_s16_u16(vorrq_u16(all.val[2], all.val[3])), 0);
    uint16x8_t sums = vshlq_r_u16(all.val[0], -(int32_t)shift);
    uint16x8_t below = vshlq_r_u16(all.val[2], -(int32_t)shift);
    uint16x8_t above = vshlq_r_u16(all.val[3], -(int32_t)shift);
    uint16x8_t slope = vsubq_u16(vmaxq_u16(below, above), sums);
    uint16x8_t offset = divide(vabdq_u16(below, above), slope);
    uint16x8_t centre = vaddq_n_u16(vshlq_n_u16(disparities, 5), 8);
    uint16x8_t chosen = vaddq_m_u16(centre, centre, offset, vcmphiq_m_u16(below, above, inner));
    chosen = vsubq_m_u16(chosen, centre, offset, vcmpcsq_m_u16(above, below, inner));
    mve_pred16_t valid = vcmpcsq_m_n_u16(vldrhq_z_u16(choices, lanes), (uint16_t)texture_least, lanes);
    valid = vcmpneq_m_n_u16(disparities, UINT16_MAX, valid);
    vstrhq_p_u16(choices, vpselq_u16(chosen, vdupq_n_u16(TSR_MATCH_CHOICE_NONE), valid), lanes);
}

/* The choices hold the sums of `window` columns of texture, those outside being the nearest inside. */
static void sum_texture(const struct tsr_match *match)
{
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned window = match->config.window;
    int last = match->config.width - 1;
    for (int x = 0; x <= last; x += (int)HALVES) {
        uint16x8_t sum = vdupq_n_u16(0);
        int first = x - (int)window / 2;
        if (first >= 0 && first + (int)(window - 1u + HALVES) - 1 <= last) {
            for (unsigned i = 0; i < window; i++) {
                sum = vaddq_u16(sum, vldrbq_u16(scratch.texture + first + i));
            }
        } else {
            int16x8_t places = vaddq_n_s16(vreinterpretq_s16_u16(vidupq_n_u16(0, 1)), (int16_t)first);
            for (unsigned i = 0; i < window; i++) {
                int16x8_t inside = vmaxq_s16(vminq_s16(places, vdupq_n_s16((int16_t)last)), vdupq_n_s16(0));
                sum = vaddq_u16(sum, vldrbq_gather_offset_u16(scratch.texture, vreinterpretq_u16_s16(inside)));
                places = vaddq_n_s16(places, 1);
            }
        }
        vstrhq_p_u16(scratch.choices + x, sum, vctp16q((uint32_t)(last + 1 - x)));
    }
}

void tsr_mve_move_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    unsigned width = match->config.width;
    const uint8_t *new_row = match->left.pixels + (size_t)y_new * match->left.stride;
    const uint8_t *old_row = match->left.pixels + (size_t)y_old * match->left.stride;
    uint8_t *texture = tsr_match_share_scratch(match).texture;
    uint8x16_t cap = vdupq_n_u8(match->config.prefilter_cap);
    for (unsigned x = 0; x < width; x += BYTES) {
        mve_pred16_t lanes = vctp8q(width - x);
        uint8x16_t added = vabdq_u8(vldrbq_z_u8(new_row + x, lanes), cap);
        uint8x16_t taken = vabdq_u8(vldrbq_z_u8(old_row + x, lanes), cap);
        uint8x16_t sums = vsubq_u8(vaddq_u8(vldrbq_z_u8(texture + x, lanes), added), taken);
        vstrbq_p_u8(texture + x, sums, lanes);
    }
    sum_texture(match);
}

/* docs/math.md, eq. (17): the choices that agree with the claims. */
void tsr_mve_write_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    uint16_t *map_row = match->map + (size_t)y * config->width;
    bool off = config->lr_tolerance_px == TSR_MATCH_TEST_OFF;
    uint16_t tolerance = off ? TSR_DISPARITY_COUNT_MAX : config->lr_tolerance_px;
    uint16x8_t reach = vdupq_n_u16((uint16_t)(2u * tolerance));
    uint16x8_t places = vsubq_n_u16(vidupq_n_u16(0, 1), (uint16_t)config->search_start_px); /* of x - s */
    for (unsigned x = 0; x < config->width; x += HALVES) {
        mve_pred16_t lanes = vctp16q(config->width - x);
        uint16x8_t choices = vldrhq_z_u16(scratch.choices + x, lanes);
        mve_pred16_t valid = vcmpneq_m_n_u16(choices, TSR_MATCH_CHOICE_NONE, lanes);
        uint16x8_t disparities = vshrq_n_u16(choices, 5);
        uint16x8_t claims = vldrhq_gather_shifted_offset_z_u16(scratch.claims, vsubq_u16(places, disparities), valid);
        uint16x8_t claimed = vandq_u16(claims, vdupq_n_u16(TSR_MATCH_CLAIM_D(UINT16_MAX)));
        uint16x8_t apart = vaddq_n_u16(vsubq_u16(claimed, disparities), tolerance);
        valid = vcmpcsq_m_u16(reach, apart, valid);
        /* 32 d + offset + 8 becomes 16 d + offset */
        uint16x8_t values = vsubq_n_u16(vsubq_u16(choices, vshlq_n_u16(disparities, 4)), 8);
        vstrhq_p_u16(map_row + x, vpselq_u16(values, vdupq_n_u16(TSR_DISPARITY_INVALID), valid), lanes);
        places = vaddq_n_u16(places, HALVES);
    }
}
#endif
