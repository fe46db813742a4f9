/*
 * Hamming distances of census descriptors with MVE, sixteen disparities at once,
 * and the penalties of a row, sixteen pixels at once.
 *
 * A group of lanes walks along the whole row before the next one does: what a
 * pixel takes over from the one beside it stays in registers.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <arm_mve.h>

#include "match_mve.h"

/* The even fields of 1 and of 2 bits. In registers, where compilers would make the vectors anew for every use. */
struct masks {
    uint8x16_t ones;
    uint8x16_t twos;
};

static inline struct masks load_masks(void)
{
    struct masks masks = {vdupq_n_u8(0x55), vdupq_n_u8(0x33)};
    __asm("" : "+w"(masks.ones), "+w"(masks.twos));
    return masks;
}

/* a - times b, modulo 256. */
static inline uint8x16_t subtract(uint8x16_t a, unsigned times, uint8x16_t b)
{
    return vmlaq_n_u8(a, b, (uint8_t)(0u - times));
}

/* Set bits of both bytes, 0 .. 16. VHADD adds the odd fields of two bytes without losing a carry, and moves the sums
 * one bit down; taken from the sum of all fields they leave that of the even ones. */
static inline uint8x16_t count_bits(const struct masks *masks, uint8x16_t a, uint8x16_t b)
{
    uint8x16_t odd = vhaddq_u8(vbicq_u8(a, masks->ones), vbicq_u8(b, masks->ones)); /* fields of 2 bits, 0 .. 2 */
    uint8x16_t even = subtract(vaddq_u8(a, b), 2, odd);
    uint8x16_t upper = vhaddq_u8(vbicq_u8(even, masks->twos), vbicq_u8(odd, masks->twos));
    upper = vshrq_n_u8(upper, 1);                                 /* of 4 bits, 0 .. 4 */
    uint8x16_t nibbles = subtract(vaddq_u8(even, odd), 3, upper); /* 0 .. 8 */
    return subtract(nibbles, 15, vshrq_n_u8(nibbles, 4));
}

/* The descriptors that a group of lanes meets: those of the next pixel lie one byte lower. */
struct lanes {
    const uint8_t *left[TSR_MATCH_CENSUS_PLANES];
    const uint8_t *right[TSR_MATCH_CENSUS_PLANES];
};

static inline struct lanes lanes_of(const struct tsr_match_planes *planes, unsigned width, unsigned d)
{
    struct lanes lanes = {{planes->left[0], planes->left[1]},
                          {planes->right[0] + width - 1u + d, planes->right[1] + width - 1u + d}};
    return lanes;
}

/* C(x,y,d) of a group, and on to the next pixel: docs/math.md, eq. (41). */
static inline uint8x16_t next_cost(const struct masks *masks, struct lanes *lanes)
{
    uint8x16_t cross = veorq_u8(vldrbq_u8(lanes->right[0]--), vdupq_n_u8(*lanes->left[0]++));
    uint8x16_t knight = veorq_u8(vldrbq_u8(lanes->right[1]--), vdupq_n_u8(*lanes->left[1]++));
    return count_bits(masks, cross, knight);
}

/* Where the group of lane d begins: the last one, if it would be half, sixteen lanes before the end, so that it does
 * some again. */
static inline unsigned group_at(unsigned d, unsigned disparities)
{
    return d + TSR_MVE_GROUP <= disparities ? d : disparities - TSR_MVE_GROUP;
}

void tsr_mve_cost_row(const struct tsr_match *match, unsigned y)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    const struct masks masks = load_masks();
    for (unsigned d = 0; d < disparities; d += TSR_MVE_GROUP) {
        unsigned first = group_at(d, disparities);
        uint8_t *sums = tsr_match_costs_at(match, y) + first;
        struct lanes lanes = lanes_of(&planes, width, first);
        uint8x16_t here = next_cost(&masks, &lanes);
        uint8x16_t both = vaddq_u8(here, here); /* this column and the one before */
#pragma GCC unroll 2
        for (unsigned x = 1; x < width; x++, sums += disparities) {
            uint8x16_t cost = next_cost(&masks, &lanes);
            vstrbq_u8(sums, vaddq_u8(both, cost));
            both = vaddq_u8(here, cost);
            here = cost;
        }
        vstrbq_u8(sums, vaddq_u8(both, here));
    }
}

/* A half group at the end keeps its lower lanes, which are another one's. */
void tsr_mve_add_census(const struct tsr_match *match, unsigned y, unsigned times)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    const struct masks masks = load_masks();
    for (unsigned d = 0; d < disparities; d += TSR_MVE_GROUP) {
        unsigned first = group_at(d, disparities);
        mve_pred16_t own = first == d ? 0xffffu : 0xff00u;
        uint8_t *column = tsr_match_share_scratch(match).columns + first;
        struct lanes lanes = lanes_of(&planes, width, first);
        for (unsigned x = 0; x < width; x++, column += disparities) {
            uint8x16_t sums = vmlaq_n_u8(vldrbq_u8(column), next_cost(&masks, &lanes), (uint8_t)times);
            vstrbq_p_u8(column, sums, own);
        }
    }
}

static inline uint8x16_t penalty_far(uint8x16_t gray, uint8x16_t gray_before)
{
    uint8x16_t less = vqsubq_u8(vdupq_n_u8(TSR_MATCH_PENALTY_FAR), vabdq_u8(gray, gray_before));
    return vmaxq_u8(less, vdupq_n_u8(TSR_MATCH_PENALTY_NEAR));
}

/* The last pixels may be done twice: widths are at least 16. */
void tsr_mve_find_penalties(const struct tsr_match *match, unsigned y, struct tsr_mve_penalties *penalties)
{
    unsigned width = match->config.width;
    const uint8_t *row = match->left.pixels + (size_t)y * match->left.stride;
    const uint8_t *row_above = y > 0 ? row - match->left.stride : row;
    for (unsigned x = 0; x < width; x += TSR_MVE_GROUP) {
        unsigned at = group_at(x, width);
        uint8x16_t gray = vldrbq_u8(row + at);
        uint32_t before = at > 0 ? row[at - 1u] : 0u;
        uint8x16_t left = vshlcq_u8(gray, &before, 8);
        uint8x16_t right = vldrbq_z_u8(row_above + at + 1, vctp8q(width - 1u - at));
        uint8x16x4_t found = {
            {penalty_far(gray, left), penalty_far(gray, vldrbq_u8(row_above + at)), penalty_far(gray, right), gray}};
        vst4q_u8((uint8_t *)(penalties + at), found);
    }
}
#endif
