/*
 * Instructions of the ARMv7-M DSP extension as functions, and unaligned words.
 * The flags GE pass from the subtraction to SEL inside one statement, so that
 * nothing can come between.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_DSP_H
#define TSR_VISION_MATCH_DSP_H

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

static inline uint32_t tsr_dsp_add(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("uadd8 %0, %1, %2" : "=r"(result) : "r"(a), "r"(b));
    return result;
}

static inline uint32_t tsr_dsp_subtract(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("usub8 %0, %1, %2" : "=r"(result) : "r"(a), "r"(b));
    return result;
}

/* max(a - b, 0) of two halves. */
static inline uint32_t tsr_dsp_subtract_halves(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("uqsub16 %0, %1, %2" : "=r"(result) : "r"(a), "r"(b));
    return result;
}

/*
 * The sliding window of a row. Before a step its pointers are those of the
 * column before; a step moves them by one column, and then
 *
 *   enter += |left_new - right_new| - |left_old - right_old|     column sums
 *   sums += enter - leave                                        window sums
 *
 * for the lanes 0 .. 8 groups - 1. right_new and right_old point to lane 0's
 * pixel of mirrored rows; lanes of sums lie as match_dsp.c says. The least of
 * every group, as two halves, is written downward in front of sums.
 */
struct tsr_dsp_window {
    const uint8_t *right_new;
    const uint8_t *right_old;
    uint8_t *enter;
    const uint8_t *leave;
    const uint8_t *left_new;
    const uint8_t *left_old;
    uint32_t *sums;
    uint32_t stride;   /* D, from column to column */
    const void *entry; /* tsr_dsp_entry(groups) */
};

/* Low word: the least sums of both halves; high word: the groups they are in, the lowest among equals. */
uint64_t tsr_dsp_move_window(struct tsr_dsp_window *window);
/* Where to begin for 1 .. 16 groups. */
const void *tsr_dsp_entry(unsigned groups);

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
    uint32_t reserved;
    uint32_t jump;
    uint32_t least;
    const uint32_t *last;
};
uint32_t tsr_dsp_walk(const struct tsr_dsp_walk *walk);
uint64_t tsr_dsp_walk_last(const struct tsr_dsp_walk *walk, const uint32_t *first, const uint32_t *second);

void tsr_dsp_describe_row(const struct tsr_match *match, unsigned y);
void tsr_dsp_add_census(const struct tsr_match *match, unsigned y, unsigned times);
void tsr_dsp_census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old);
void tsr_dsp_cost_row(const struct tsr_match *match, unsigned y);
void tsr_dsp_smooth_row(const struct tsr_match *match, unsigned y);
#define TSR_MATCH_DSP_CENSUS                                                                                           \
    .describe_row = tsr_dsp_describe_row, .add_census = tsr_dsp_add_census, .census_row = tsr_dsp_census_row,          \
    .cost_row = tsr_dsp_cost_row, .smooth_row = tsr_dsp_smooth_row

#endif
