/*
 * The stages of the matcher, and how they share the scratch buffer.
 *
 *   sums      int16_t [D]     S(x,y,.) of one pixel
 *   offered   int16_t [D]     the same with what the pixel cannot search masked
 *   columns   uint8_t [W][D]  column sums of A or C, see tsr_match_add_row(); in smooth the costs C of
 *                             three rows, [3][W][D], row y in y mod 3, and more
 *   claims    uint16_t [W]    of every right pixel the least claim of a left pixel, TSR_MATCH_CLAIM()
 *   choices   uint16_t [W]    what every left pixel of the row chose, TSR_MATCH_CHOICE()
 *   texture   uint8_t [W]     column sums of |P_left - cap|
 *
 * and what the census and plain modes have otherwise or more (match_census.h,
 * match_plain.h). The prefilter runs before
 * all this and uses the room of columns for the unfiltered rows above (left and
 * right) and a row of vertical sums.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_STAGES_H
#define TSR_VISION_MATCH_STAGES_H

#include <stdbool.h>

#include "tsr/vision/match.h"

/* Lanes handled at once in loops over d; D is a multiple of it. */
#define TSR_MATCH_LANES 8u

struct tsr_match_scratch {
    int16_t *sums;
    int16_t *offered;
    uint8_t *columns;
    uint16_t *claims;
    uint16_t *choices;
    uint8_t *texture;
};

/* Bytes between offered and columns; kernels lay what they need over all in front of columns. */
#define TSR_MATCH_EDGE_ROOM 8u

/* A claim orders by floor(m / 2^shift) and then by d: eq. (17). */
#define TSR_MATCH_CLAIM_OF(sum, shift, d) ((uint16_t)((unsigned)(sum) >> (shift) << 7 | (unsigned)(d)))
#define TSR_MATCH_CLAIM(sum, d) TSR_MATCH_CLAIM_OF(sum, 2, d) /* of the SAD modes */
#define TSR_MATCH_CLAIM_D(claim) ((claim)&127)

/* d* with its offset of -8 .. 8 sixteenths, before eq. (17). A row of the map takes the place of frame rows that are
 * still read while it is found out, so it is written at the end. */
#define TSR_MATCH_CHOICE(d, offset_q4) ((uint16_t)((unsigned)(d) << 5 | (unsigned)((int)(offset_q4) + 8)))
#define TSR_MATCH_CHOICE_NONE UINT16_MAX

struct tsr_match_scratch tsr_match_share_scratch(const struct tsr_match *match);
unsigned tsr_match_claim_shift(uint8_t mode);

/* What a kernel does. Its functions share nothing but the scratch. */
struct tsr_match_kernel {
    const char *name;
    /* Replace row y of both frames by eq. (10); the right one is stored mirrored,
     * so that ascending d reads ascending addresses (and only mirrored if it is
     * prefiltered already). Rows in ascending order. */
    void (*prefilter_row)(const struct tsr_match *match, unsigned y);
    /* Column sums times + one more row: columns[x][d] += times A(clip(x), y, d). */
    void (*add_row)(const struct tsr_match *match, unsigned y, unsigned times);
    /* Move the column sums down (add frame row y_new, take y_old away), and make
     * row y of the map of them: eqs. (12) to (17). */
    void (*match_row)(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old);

    bool any_start; /* or search_start_px >= 0 only, and the portable kernel does the others */
};

extern const struct tsr_match_kernel tsr_match_kernel_portable;

/* The rows of work of a mode: how many, and one of them, 0 .. rows_total - 1 in this order. What starts a match names
 * its method and nothing else does, so that an image holds only what it starts. */
struct tsr_match_method {
    unsigned (*rows_total)(const struct tsr_match_config *config);
    void (*step)(const struct tsr_match *match, unsigned row);
};
extern const struct tsr_match_method tsr_match_method_census;
extern const struct tsr_match_method tsr_match_method_plain;

/* The portable kernel in pieces. */
void tsr_match_prefilter_row(const struct tsr_match *match, unsigned y);
/* Row y of a right frame that is prefiltered already: mirrored, values above 2 cap cut to it. */
void tsr_match_take_filtered_row(const struct tsr_match *match, unsigned y);
void tsr_match_add_row(const struct tsr_match *match, unsigned y, unsigned times);
void tsr_match_move_columns(const struct tsr_match *match, unsigned y_new, unsigned y_old);
void tsr_match_finish_row(const struct tsr_match *match, unsigned y);

/* Choices of a row: begin, every x with its sums, and row y of the map from the choices that agree with the claims,
 * eqs. (14) to (17). */
void tsr_match_begin_choice(const struct tsr_match *match);
void tsr_match_choose(const struct tsr_match *match, unsigned x, bool textured);
void tsr_match_write_row(const struct tsr_match *match, unsigned y);

/* The least of the offered sums, the lowest d that has it, and how many are
 * within a limit. Sums lie in 0 .. TSR_MATCH_SUM_NONE. */
#define TSR_MATCH_SUM_NONE INT16_C(0x7fff)
struct tsr_match_winner {
    int16_t sum;
    uint8_t d;
};
struct tsr_match_winner tsr_match_find_winner(const int16_t *sums, unsigned disparities);
unsigned tsr_match_count_within(const int16_t *sums, unsigned disparities, int16_t limit);

#endif
