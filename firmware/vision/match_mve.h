/*
 * What the two halves of the MVE kernel share: rows in match_mve_rows.c, the
 * window that slides along a row in match_mve_window.h, the choice of a pixel
 * in match_mve.c.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_MVE_H
#define TSR_VISION_MATCH_MVE_H

#include "match_stages.h"

void tsr_mve_prefilter_row(const struct tsr_match *match, unsigned y);
void tsr_mve_add_row(const struct tsr_match *match, unsigned y, unsigned times);
/* The column sums of |P_left - cap|, moved down. */
void tsr_mve_move_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old);
/* tsr_match_write_row() for search_start_px >= 0. */
void tsr_mve_write_row(const struct tsr_match *match, unsigned y);

#endif
