/*
 * What a pixel of the MVE kernel finds among its sums: the winner, its claim,
 * and whether another lane contests it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_MVE_SEARCH_H
#define TSR_VISION_MATCH_MVE_SEARCH_H

#include <arm_acle.h>

#include "match_mve_window.h"

/* docs/math.md, eq. (15). The scale is ceil(2^19 (100 + uniqueness) / 100), too large by at most 1: with sums up to
 * 3600 the products fit 32 bits, and their excess is below 2^19 / 100. Both 0: off. */
struct mve_uniqueness {
    uint32_t scale;
    uint32_t one;
};
#define MVE_UNIQUENESS_SHIFT 19

static inline struct mve_uniqueness mve_uniqueness_of(const struct tsr_match_config *config)
{
    struct mve_uniqueness off = {0, 0};
    struct mve_uniqueness on = {((100u + config->uniqueness_percent) << MVE_UNIQUENESS_SHIFT) / 100u + 1u, 1};
    return config->uniqueness_percent == TSR_MATCH_TEST_OFF ? off : on;
}

/* The least that a sum beyond the neighbours must be. */
static inline unsigned mve_bound_others(const struct mve_uniqueness *uniqueness, unsigned sum)
{
    return (sum * uniqueness->scale >> MVE_UNIQUENESS_SHIFT) + uniqueness->one;
}

static inline uint32_t mve_load_word(const void *at)
{
    uint32_t word;
    __builtin_memcpy(&word, at, sizeof word);
    return word;
}

static inline void mve_store_word(void *at, uint32_t word)
{
    __builtin_memcpy(at, &word, sizeof word);
}

/* docs/math.md, eq. (17). claims: of the pixel's lane 0 */
static inline void mve_claim_right(uint16_t *claims, unsigned sum, unsigned shift, unsigned d)
{
    unsigned claim = sum >> shift << 7 | d;
    uint16_t *claimed = claims - d;
    if (claim < *claimed) {
        *claimed = (uint16_t)claim;
    }
}

/* What a pixel finds by its least key. */
static inline __attribute__((always_inline)) struct tsr_mve_found
mve_search_keys(const struct mve_uniqueness *uniqueness, const struct mve_window *window, uint16_t *claims,
                unsigned claim_shift, unsigned key)
{
    unsigned group = key % (1u << MVE_KEY_SHIFT);
    unsigned sum = key >> MVE_KEY_SHIFT;
    uint16_t *even = window->even;
    uint16_t *odd = window->odd;
    unsigned d = TSR_MVE_GROUP * group + mve_find_lane(even + 8u * group, odd + 8u * group, key);
    mve_claim_right(claims, sum, claim_shift, d);
    uint16_t *own = (d % 2u != 0 ? odd : even) + d / 2u;
    uint16_t *beside = d % 2u != 0 ? even + d / 2u : odd + d / 2u - 1;
    uint32_t pair = mve_load_word(beside);
    mve_store_word(beside, UINT32_MAX);
    *own = UINT16_MAX;
    unsigned others = mve_find_least_key(even, odd, window->lanes);
    mve_store_word(beside, pair);
    *own = (uint16_t)key;
    bool unique = others >> MVE_KEY_SHIFT >= mve_bound_others(uniqueness, sum);
    return (struct tsr_mve_found){unique ? key | d << 16 : UINT32_MAX, pair};
}

/* What a pixel that can search some lanes finds by the least of its 8-bit sums, which lie between pads of 255. */
static inline __attribute__((always_inline)) struct tsr_mve_found
mve_search_sums(const struct mve_uniqueness *uniqueness, uint8_t *sums, unsigned lanes, uint16_t *claims,
                unsigned claim_shift, unsigned sum)
{
    unsigned d = mve_find_lane_of_sum(sums, sum);
    mve_claim_right(claims, sum, claim_shift, d);
    uint8_t *below = sums + d - 1;
    uint32_t near = mve_load_word(below);
    mve_store_word(below, near | 0xffffffu);
    unsigned others = mve_find_least_sum(sums, lanes);
    mve_store_word(below, near);
    bool unique = others >= __usat((int32_t)mve_bound_others(uniqueness, sum), 8); /* 255: there are no others */
    uint32_t pair = d - 1u < lanes - 2u ? near & 0xff00ffu : UINT32_MAX;
    return (struct tsr_mve_found){unique ? sum | d << 16 : UINT32_MAX, pair};
}

#endif
