/*
 * The modes of the matcher that compare census descriptors: TSR_MATCH_CENSUS
 * (window sums) and TSR_MATCH_SMOOTH (path costs). docs/math.md, eqs. (40) to (47).
 *
 *   rows_done   0 .. r - 1        warm-up: column sums one row above the image
 *               r .. H + r - 1    map rows 0 .. H - 1
 *
 * with r the radius of the box that is summed: window / 2, or 1 in smooth. The
 * frames are only read. Scratch, in this order:
 *
 *   sums        uint16_t [D]      S(x,y,.) of one pixel
 *   right_cost  uint16_t [W]      least sum of the left pixels that chose this right pixel
 *   right_d     uint8_t [W]       the disparity of that left pixel
 *   left_d      uint8_t [W]       d* of every left pixel of the row
 *   columns     uint8_t [W][D]    column sums of C over 2 r + 1 rows
 *   ring        2 r + 2 rows of descriptors, row y in y mod (2 r + 2), each
 *                 left   uint8_t [2][W]       planes 0 and 1
 *                 right  uint8_t [2][W + D]   mirrored, see below
 *   above       uint8_t [2][W][D] path costs of the row above: up, up-right   (smooth)
 *   least       uint8_t [2][W]    their minima over d                         (smooth)
 *   before      uint8_t [D]       path costs of the pixel to the left         (smooth)
 *   cost        uint8_t [D]       B(x,y,.) of one pixel                       (smooth)
 *
 * A right plane holds at W - 1 - x + d the descriptor that (x,d) is compared
 * with, so ascending d reads ascending addresses and no border is a case.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_SMOOTH_H
#define TSR_VISION_MATCH_SMOOTH_H

#include "tsr/vision/match.h"

#define TSR_MATCH_CENSUS_PLANES 2u

/* What the resolved window of smooth stands for: a pixel's own costs come from 7 rows. */
#define TSR_MATCH_SMOOTH_WINDOW 7u

struct tsr_match_smooth_scratch {
    uint16_t *sums;
    uint16_t *right_cost;
    uint8_t *right_d;
    uint8_t *left_d;
    uint8_t *columns;
    uint8_t *ring;
    uint8_t *above[2];
    uint8_t *least[2];
    uint8_t *before;
    uint8_t *cost;
};

/* Of a resolved configuration. */
size_t tsr_match_smooth_scratch_len(const struct tsr_match_config *config);
unsigned tsr_match_smooth_rows_total(const struct tsr_match_config *config);
unsigned tsr_match_smooth_radius(const struct tsr_match_config *config);

/* One row of work: 0 .. rows_total - 1, in this order. */
void tsr_match_smooth_step(const struct tsr_match *match, unsigned step);

struct tsr_match_smooth_scratch tsr_match_share_smooth(const struct tsr_match *match);

/* Descriptors of frame row y into the ring: eq. (40). */
void tsr_match_describe_row(const struct tsr_match *match, unsigned y);

/* columns += times C(.,y,.), and -= C(.,y,.), with the descriptors of row y: eq. (41). */
void tsr_match_add_census(const struct tsr_match *match, unsigned y, unsigned times);
void tsr_match_take_census(const struct tsr_match *match, unsigned y);

/* Path costs of the row above the image: none. */
void tsr_match_begin_paths(const struct tsr_match *match);

/* sums = S(x,y,.) from the columns and the paths: eqs. (42) to (46). Pixels in
 * ascending x, rows in ascending y, each once. */
void tsr_match_sum_paths(const struct tsr_match *match, unsigned x, unsigned y);

/* Winner, tests and offset: begin, every x in ascending order, finish. */
void tsr_match_begin_choice(const struct tsr_match *match);
void tsr_match_choose(const struct tsr_match *match, unsigned x, unsigned y);
void tsr_match_finish_choice(const struct tsr_match *match, unsigned y);

#endif
