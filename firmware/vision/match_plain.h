/*
 * Plain block matching of gray values, as the thesis has it: TSR_MATCH_RAW (sums
 * of absolute differences) and TSR_MATCH_SSD (of squared ones). docs/math.md,
 * eqs. (23) to (25). No kernel but this portable one.
 *
 *   rows_done   0 .. r - 1        warm-up: column sums one row above the image
 *               r .. H + r - 1    map rows 0 .. H - 1
 *
 * The frames are only read. Of the scratch of match_stages.h, sums and offered
 * are one array of the mode's window sums [D], and columns is followed by
 *
 *   claims_wide   uint32_t [W]   claims with the whole least sum
 *
 * and texture by
 *
 *   met           uint8_t [2][W + D]   the right rows that enter and leave, mirrored: entry
 *                                      W - 1 - x + d is what pixel x meets at d
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_PLAIN_H
#define TSR_VISION_MATCH_PLAIN_H

#include "match_stages.h"

/* Bytes of a column sum: at most 15 * 255, and 15 * 255^2. */
#define TSR_MATCH_RAW_SUM_LEN 2u
#define TSR_MATCH_SSD_SUM_LEN 4u

struct tsr_match_plain_scratch {
    void *sums; /* of window_sum, match_plain_sums.h */
    uint32_t *claims_wide;
    uint16_t *claims;
    uint16_t *choices;
    uint8_t *met[2];
};

bool tsr_match_is_plain(uint8_t mode);
/* Bytes of columns and claims_wide, and of met. */
size_t tsr_match_plain_columns_len(const struct tsr_match_config *config);
size_t tsr_match_plain_met_len(const struct tsr_match_config *config);
struct tsr_match_plain_scratch tsr_match_share_plain(const struct tsr_match *match);

/* The right row y as entry which of met. */
void tsr_match_mirror_row(const struct tsr_match *match, unsigned y, unsigned which);

/* Column and window sums of one mode: columns += times the row in met[0]; row y of choices from columns that also lose
 * the row in met[1]. */
struct tsr_match_plain_sums {
    void (*add_row)(const struct tsr_match *match, unsigned y, unsigned times);
    void (*choose_row)(const struct tsr_match *match, unsigned y_new, unsigned y_old);
};
extern const struct tsr_match_plain_sums tsr_match_raw_sums;
extern const struct tsr_match_plain_sums tsr_match_ssd_sums;

#endif
