/*
 * The modes of the matcher that compare census descriptors: TSR_MATCH_CENSUS
 * (window sums) and TSR_MATCH_SMOOTH (path costs). docs/math.md, eqs. (40) to (47).
 *
 *   rows_done   0 .. r - 1        warm-up: descriptors and costs of the rows above
 *               r .. H + r - 1    map rows 0 .. H - 1
 *
 * with r the radius of the box that is summed: window / 2, or 1 in smooth. The
 * frames are only read. In smooth the columns of the scratch of match_stages.h are
 * followed by what is read in words, so that it is aligned as they are:
 *
 *   above       uint8_t [2][W][D] path costs of the row above: up, up-right
 *   before      uint8_t [D]       path costs of the pixel to the left
 *   cost        uint8_t [D]       B(x,y,.) of one pixel
 *
 * and behind the whole scratch are
 *
 *   planes      rows of descriptors, row y in y mod their number: 2 r + 2 in census, 1 in smooth; each
 *                 left   uint8_t [2][W]       planes 0 and 1
 *                 right  uint8_t [2][W + D]   mirrored, see below
 *   least       uint8_t [2][W]    the least of above over d                   (smooth)
 *
 * A right plane holds at W - 1 - x + d the descriptor that (x,d) is compared
 * with, so ascending d reads ascending addresses and no border is a case.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_CENSUS_H
#define TSR_VISION_MATCH_CENSUS_H

#include "match_stages.h"

#define TSR_MATCH_CENSUS_PLANES 2u

/* Rows of costs that smooth keeps. */
#define TSR_MATCH_SMOOTH_ROWS 3u
/* What the resolved window of smooth stands for: a pixel's own costs come from 7 rows. */
#define TSR_MATCH_SMOOTH_WINDOW 7u

#define TSR_MATCH_PATHS 3
#define TSR_MATCH_COST_MAX 36    /* (9 * 16) >> 2 */
#define TSR_MATCH_PENALTY_NEAR 8 /* for a disparity that differs by 1 */
#define TSR_MATCH_PENALTY_FAR 32 /* for any other, less the step of the gray value */

/* The descriptors of one row. */
struct tsr_match_planes {
    uint8_t *left[TSR_MATCH_CENSUS_PLANES];
    uint8_t *right[TSR_MATCH_CENSUS_PLANES];
};

struct tsr_match_paths {
    uint8_t *above[2];
    uint8_t *least[2];
    uint8_t *before;
    uint8_t *cost;
};

/* Bytes of columns and what follows them, and of what is behind the common scratch, of a resolved configuration. */
size_t tsr_match_census_columns_len(const struct tsr_match_config *config);
size_t tsr_match_census_planes_len(const struct tsr_match_config *config);
unsigned tsr_match_census_radius(const struct tsr_match_config *config);

/* What a kernel does in the census modes. */
struct tsr_match_census_kernel {
    /* Descriptors of frame row y into their place, eq. (40). */
    void (*describe_row)(const struct tsr_match *match, unsigned y);
    /* census: as add_row and match_row of struct tsr_match_kernel, with C of rows that are described: eqs. (41), (47).
     */
    void (*add_census)(const struct tsr_match *match, unsigned y, unsigned times);
    void (*census_row)(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old);
    /* smooth: costs of the row y that was described last, eq. (41), or what the kernel makes of them, and row y of the
     * map from those of rows y - 1 .. y + 1 and the paths, eqs. (42) to (46). Rows in ascending order. */
    void (*cost_row)(const struct tsr_match *match, unsigned y);
    void (*smooth_row)(const struct tsr_match *match, unsigned y);
};

/* That of the match's kernel; the portable one where it has none. */
const struct tsr_match_census_kernel *tsr_match_census_kernel_of(const struct tsr_match *match);

struct tsr_match_planes tsr_match_planes_at(const struct tsr_match *match, unsigned y);
struct tsr_match_paths tsr_match_share_paths(const struct tsr_match *match);

/* The costs of row y, [W][D]. */
uint8_t *tsr_match_costs_at(const struct tsr_match *match, unsigned y);

/* docs/math.md, eq. (43). */
static inline uint8_t tsr_match_penalty_far(unsigned gray, unsigned gray_before)
{
    unsigned step = gray > gray_before ? gray - gray_before : gray_before - gray;
    return (uint8_t)(step + TSR_MATCH_PENALTY_NEAR < TSR_MATCH_PENALTY_FAR ? TSR_MATCH_PENALTY_FAR - step
                                                                           : TSR_MATCH_PENALTY_NEAR);
}

/* The portable kernel in pieces. */
void tsr_match_describe_row(const struct tsr_match *match, unsigned y);
void tsr_match_add_census(const struct tsr_match *match, unsigned y, unsigned times);
void tsr_match_census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old);
void tsr_match_cost_row(const struct tsr_match *match, unsigned y);
void tsr_match_smooth_row(const struct tsr_match *match, unsigned y);

#endif
