/*
 * Instructions of the ARMv7-M DSP extension as functions, unaligned words, and
 * what C and assembly of this kernel share. The flags GE pass from the
 * subtraction to SEL inside one statement, so that nothing can come between.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_DSP_H
#define TSR_VISION_MATCH_DSP_H

#include <stddef.h>

#include "match_census.h"

static inline uint32_t tsr_dsp_load(const uint8_t *at)
{
    uint32_t word;
    __builtin_memcpy(&word, at, sizeof word);
    return word;
}

static inline void tsr_dsp_store(uint8_t *at, uint32_t word)
{
    __builtin_memcpy(at, &word, sizeof word);
}

/* |a - b| of four bytes. */
static inline uint32_t tsr_dsp_difference(uint32_t a, uint32_t b)
{
    uint32_t swapped, result;
    __asm("usub8 %0, %2, %3\n\tusub8 %1, %3, %2\n\tsel %1, %1, %0" : "=&r"(swapped), "=&r"(result) : "r"(a), "r"(b));
    return result;
}

#define TSR_DSP_GROUP_LANES 8u
#define TSR_DSP_GROUPS_MAX 16u
#define TSR_DSP_LEAST_WORDS 4u /* groups are judged by so many at once */

/* Scratch in front of the columns: the right rows' ends, with the pixels that stand for those outside. */
#define TSR_DSP_EDGE_LEN(disparities) ((disparities) + 16u)
_Static_assert(2u * TSR_DSP_EDGE_LEN(TSR_MATCH_DISPARITIES_MIN) <= 4u * TSR_MATCH_DISPARITIES_MIN + TSR_MATCH_EDGE_ROOM,
               "two edges fit, and the more the larger D");

/* One row of the map: what does not change from pixel to pixel. Rows of the right picture are mirrored. */
struct tsr_dsp_row {
    const struct tsr_match_config *config;
    struct tsr_match_scratch scratch;
    const uint8_t *left_new;
    const uint8_t *left_old;
    const uint8_t *right_new;
    const uint8_t *right_old;
    uint8_t *edge_new;
    uint8_t *edge_old;
    uint32_t start; /* s */
    uint32_t radius;
};

/*
 * What the assembly works on, at its stack pointer. Column and pixel go on
 * together: pixel x takes the column x + radius into its window. Pointers to
 * columns are those of the columns before.
 *
 * A group of eight lanes has four words of window sums, of the lanes (0,2) (1,3)
 * (4,6) (5,7), low half first, as UXTB16 and its rotated form take bytes apart;
 * or, once the window sums are bytes, two words of the lanes in order.
 */
struct tsr_dsp_frame {
    const uint8_t *right_new; /* of lane 0, in mirrored rows */
    const uint8_t *right_old;
    uint8_t *enter;
    const uint8_t *leave;
    const uint8_t *left_new; /* [x] */
    const uint8_t *left_old;
    uint32_t ones;      /* 1 in every byte */
    const void *groups; /* where the first group is worked on */
    uint32_t stride;    /* D, from column to column */
    int32_t minus_two;  /* see match_dsp_window.c */
    uint32_t none;      /* above all sums */
    uint32_t x;
    int32_t texture;          /* less what it must be at least: eq. (13) */
    uint16_t *claims;         /* [x - d] */
    const uint8_t *tex_enter; /* [x] */
    const uint8_t *tex_leave;
    uint32_t unique_scale; /* limit + 1 of eq. (15) is (sum * scale + one) >> 20 */
    uint32_t unique_one;
    uint16_t *choices;       /* [x], 32 d + offset_q4, or TSR_MATCH_CHOICE_NONE */
    uint32_t stop;           /* the pixel that needs tsr_dsp_prepare() */
    const void *least_entry; /* where the least sums of all groups are judged */
    uint32_t lane_key;       /* see FIND_WINNER in match_dsp_window8.c */
    uint32_t ones_again;
    uint32_t change; /* the pixel from which more changes than that a lane can be chosen */
    const struct tsr_dsp_row *row;
    uint32_t sums[TSR_DSP_GROUPS_MAX * TSR_DSP_GROUP_LANES / 2u + 1u]; /* the last one's neighbour is out of reach */
    uint32_t least[TSR_DSP_GROUPS_MAX];                                /* of every group, two halves or four bytes */
    uint32_t align[2]; /* with nine registers pushed, a multiple of 8 bytes */
};

/* The assembly's offsets. */
#define TSR_DSP_AT_X 44
#define TSR_DSP_AT_STRIDE 32
#define TSR_DSP_AT_LEAST_ENTRY 80
#define TSR_DSP_AT_KEY 84
#define TSR_DSP_AT_SUMS 100
#define TSR_DSP_AT_LEAST 360
#define TSR_DSP_FRAME_LEN 432
#define TSR_DSP_TEXT(number) #number
#define TSR_DSP_EQUATE(name, value) ".equ " name ", " TSR_DSP_TEXT(value) "\n\t"
#define TSR_DSP_EQUATES                                                                                                \
    TSR_DSP_EQUATE("at_x", TSR_DSP_AT_X)                                                                               \
    TSR_DSP_EQUATE("at_stride", TSR_DSP_AT_STRIDE)                                                                     \
    TSR_DSP_EQUATE("at_least_entry", TSR_DSP_AT_LEAST_ENTRY)                                                           \
    TSR_DSP_EQUATE("at_key", TSR_DSP_AT_KEY)                                                                           \
    TSR_DSP_EQUATE("at_sums", TSR_DSP_AT_SUMS)                                                                         \
    TSR_DSP_EQUATE("at_least", TSR_DSP_AT_LEAST)                                                                       \
    TSR_DSP_EQUATE("frame_len", TSR_DSP_FRAME_LEN)

/* Matches the pixels of a row, from the one tsr_dsp_begin() chooses on. */
void tsr_dsp_match_pixels(const struct tsr_dsp_row *row);

/* Called by it: before the first pixel, and before every one that is not like the one before, until the row is done. */
void tsr_dsp_begin(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row);
uint32_t tsr_dsp_prepare(struct tsr_dsp_frame *frame);

/* Where to begin for 1 .. 16 groups, and where to judge 1 .. 4 times four, with sums of 16 bits and of 8. */
extern const void *const tsr_dsp_groups[TSR_DSP_GROUPS_MAX];
extern const void *const tsr_dsp_groups8[TSR_DSP_GROUPS_MAX];
extern const void *const tsr_dsp_least[TSR_DSP_GROUPS_MAX / TSR_DSP_LEAST_WORDS];
extern const void *const tsr_dsp_least8[TSR_DSP_GROUPS_MAX / TSR_DSP_LEAST_WORDS];

/* The end of a right row for the columns whose lanes reach beyond it, and lane 0's pixel of such a column (counted
 * from the search start). */
void tsr_dsp_fill_edge(const struct tsr_match_config *config, const uint8_t *right, uint8_t *edge);
static inline const uint8_t *tsr_dsp_at_edge(const struct tsr_match_config *config, const uint8_t *edge, int column)
{
    return edge + (config->disparities - 2 - column);
}

/* How many groups a column (counted from the search start) takes part in: those that a pixel near it can search. */
static inline unsigned tsr_dsp_count_groups(const struct tsr_match_config *config, int column)
{
    unsigned all = config->disparities / TSR_DSP_GROUP_LANES;
    unsigned groups = (unsigned)(column + config->window / 2) / TSR_DSP_GROUP_LANES + 1u;
    return groups < all ? groups : all;
}

/* Row y of the map: the choices that agree with the claims, eq. (17). */
void tsr_dsp_write_row(const struct tsr_match *match, unsigned y);

void tsr_dsp_prefilter_row(const struct tsr_match *match, unsigned y);
void tsr_dsp_add_row(const struct tsr_match *match, unsigned y, unsigned times);

/*
 * One path over the lanes of a pixel: docs/math.md, eq. (44).
 *
 *   source, cost   path costs of the pixel before, B of this pixel. Three bytes behind source are read and not used
 *   path           may be source
 *   jump, least    least of source with and without the penalty of a jump, in every byte
 *   last           source's last word
 *
 * tsr_dsp_walk returns the least of path in four lanes. tsr_dsp_walk_last also replaces cost by its sums with two other
 * paths, eq. (46), whose least in four lanes is the high word.
 */
struct tsr_dsp_walk {
    const uint32_t *source;
    uint32_t *cost;
    uint32_t *path;
    uint32_t jump;
    uint32_t least;
    const uint32_t *last;
};
uint32_t tsr_dsp_walk(const struct tsr_dsp_walk *walk);
uint64_t tsr_dsp_walk_last(const struct tsr_dsp_walk *walk, const uint32_t *first, const uint32_t *second);

void tsr_dsp_smooth_row(const struct tsr_match *match, unsigned y);

#endif
