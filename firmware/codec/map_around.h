/*
 * What a pixel of the label model has around it, docs/codec.md, 2.3, and what
 * follows from that without a question.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_AROUND_H
#define TSR_CODEC_MAP_AROUND_H

#include "map_model.h"

/* The parallel arithmetic of Cortex-M4, M7, M33 (ARMv7-M ARM, A4.4.3), in Thumb state. */
#if defined(__ARM_FEATURE_SIMD32) && defined(__thumb2__)
#define TSR_MAP_HAS_DSP
#endif

/* The reference around a pixel, as labels. */
struct still {
    uint16_t here, w, e, n, nw, ne, s, se;
};

/* A row being coded. Pointers are to column x of the row and of the two above. */
struct around {
    uint16_t *here;
    const uint16_t *up;
    const uint16_t *up2;
    unsigned near;      /* 0 in a decoder */
    unsigned near_here; /* the same of this pixel; used if AGAINST_REFERENCE */
    unsigned run;       /* pixels before this one whose label was that of their own W */
    struct still still; /* set if AGAINST_REFERENCE */
};

/* What the questions beyond the first two need. */
struct asked {
    uint16_t label[6]; /* W, N, the reference's, NE, NW, NEE */
    unsigned count;
    unsigned gap; /* class of |W - N| */
};

static inline unsigned difference(unsigned a, unsigned b)
{
    return a > b ? a - b : b - a;
}

static inline unsigned class_of_gap(unsigned gap)
{
    return gap == 0 ? 0u : gap == 1 ? 1u : gap <= 3 ? 2u : gap <= 8 ? 3u : gap < TSR_MAP_DIFFERENCE_INVALID ? 4u : 5u;
}

static inline unsigned class_of_activity(unsigned sum)
{
    return sum == 0 ? 0u : sum <= 2 ? 1u : sum <= 5 ? 2u : sum <= 12 ? 3u : sum < TSR_MAP_DIFFERENCE_INVALID ? 4u : 5u;
}

/* Two labels side by side, the first in the lower half. */
static inline uint32_t pair_of(const uint16_t *labels)
{
    return labels[0] | (uint32_t)labels[1] << 16;
}

/* Both less the candidate, saturated to -4 .. 3, in 3 bits each. */
static inline unsigned pair_index(uint32_t pair, uint32_t candidate)
{
#if defined(TSR_MAP_HAS_DSP)
    uint32_t away;
    __asm__("ssub16 %0, %1, %2\n\tssat16 %0, #3, %0" : "=r"(away) : "r"(pair), "r"(candidate * 0x10001u) : "cc");
    return (away & 7u) | (away >> 16 & 7u) << 3;
#else
    const int first = (int)(pair & 0xffffu) - (int)candidate, second = (int)(pair >> 16) - (int)candidate;
    return ((unsigned)(first < -4  ? -4
                       : first > 3 ? 3
                                   : first) &
            7u) |
           ((unsigned)(second < -4  ? -4
                       : second > 3 ? 3
                                    : second) &
            7u) << 3;
#endif
}

static inline bool was_asked(const struct asked *asked, unsigned label)
{
    // cppcheck-suppress ctuuninitvar
    for (unsigned i = 0; i < asked->count; i++) {
        if (asked->label[i] == label) {
            return true;
        }
    }
    return false;
}

/* Would an encoder take this label for the pixel's? Whether there is a match is never changed. */
static inline bool is_near(const struct around *at, unsigned label)
{
    return difference(*at->here, label) <= (AGAINST_REFERENCE ? at->near_here : at->near);
}

/* What changed around the pixel: W, N, NE, NW, a bit each. */
static inline unsigned changes(const struct around *at)
{
    const struct still *const still = &at->still;
    return (unsigned)(at->here[-1] != still->w) | (unsigned)(at->up[0] != still->n) << 1 |
           (unsigned)(at->up[1] != still->ne) << 2 | (unsigned)(at->up[-1] != still->nw) << 3;
}

/* What the last tables look at. */
static inline void index_reference(const struct around *at, unsigned candidate, uint8_t index[3])
{
    const struct still *const still = &at->still;
    index[0] = (uint8_t)pair_index(still->here | (uint32_t)still->e << 16, candidate);
    index[1] = (uint8_t)pair_index(still->s | (uint32_t)still->se << 16, candidate);
    index[2] =
        (uint8_t)(changes(at) | (unsigned)(still->here == candidate) << 4 | (unsigned)(still->e == still->here) << 5);
}

#endif
