/*
 * What the files of the MVE kernel share: rows are prefiltered, added and
 * written in match_mve_rows.c, match_mve.c slides the window of
 * match_mve_window.h along a row, match_mve_choose.c judges what it finds.
 * The census modes describe pixels in match_mve_describe.c and compare them in
 * match_mve_costs.c; match_mve_census.c sums over windows, match_mve_smooth.c
 * along paths, and both search as match_mve.c does (match_mve_search.h).
 *
 * Assembly statements that compare change VPR, for which GCC 12 has no name
 * among the clobbers: no function has both those and predicated intrinsics.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_MVE_H
#define TSR_VISION_MATCH_MVE_H

#include "match_census.h"

#define TSR_MVE_GROUP 16u /* lanes d of a vector */

void tsr_mve_prefilter_row(const struct tsr_match *match, unsigned y);
void tsr_mve_add_row(const struct tsr_match *match, unsigned y, unsigned times);

/* Moves the column sums of |P_left - cap| down; the choices then hold the texture of every pixel, eq. (13). */
void tsr_mve_move_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old);

/* What a pixel found: d* << 16 | least sum, or all ones if it is contested, eq. (15); sum at d* + 1 << 16 | sum at
 * d* - 1, a half above TSR_MVE_BESIDE_MAX if one of them cannot be searched. */
struct tsr_mve_found {
    uint32_t winner;
    uint32_t beside;
};
#define TSR_MVE_FOUND_COUNT 8u
#define TSR_MVE_BESIDE_MAX INT16_MAX

/* Choices of up to eight pixels by their texture, which is in their place, and eq. (16). Sums in found are those of the
 * equations << shift, with anything below. */
void tsr_mve_choose(const struct tsr_mve_found found[TSR_MVE_FOUND_COUNT], unsigned count, unsigned shift,
                    unsigned texture_least, uint16_t *choices);

/* tsr_match_write_row() for search_start_px >= 0. */
void tsr_mve_write_row(const struct tsr_match *match, unsigned y);

/* The census modes, as struct tsr_match_kernel says. */
void tsr_mve_describe_row(const struct tsr_match *match, unsigned y);
void tsr_mve_add_census(const struct tsr_match *match, unsigned y, unsigned times);
void tsr_mve_census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old);
/* As tsr_match_cost_row(), but each cost is a sum of three columns, those outside being the nearest inside: 0 .. 48. */
void tsr_mve_cost_row(const struct tsr_match *match, unsigned y);

/* docs/math.md, eq. (43), of a pixel's three paths; of no meaning where the path starts. */
struct tsr_mve_penalties {
    uint8_t left;
    uint8_t up;
    uint8_t right;
    uint8_t reserved;
};
void tsr_mve_find_penalties(const struct tsr_match *match, unsigned y, struct tsr_mve_penalties *penalties);
void tsr_mve_smooth_row(const struct tsr_match *match, unsigned y);

#endif
