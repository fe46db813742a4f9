/*
 * What is done to the cells of a picture: reduction, light, background, regions.
 * State of n cells: I [n], M [n], V [n]; bit 7 of V marks a cell that changed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_CHANGE_CELLS_H
#define TSR_VISION_CHANGE_CELLS_H

#include "tsr/vision/change.h"

#define TSR_CHANGE_LIGHT_ONE_Q8 256u
#define TSR_CHANGE_MARK 0x80

static inline unsigned tsr_change_cells(const struct tsr_change *change)
{
    return (unsigned)change->cells_x * change->cells_y;
}

static inline int tsr_change_distance(int a, int b)
{
    return a > b ? a - b : b - a;
}

static inline int tsr_change_larger(int a, int b)
{
    return a > b ? a : b;
}

/* I of every cell, into means [cells]. docs/math.md, eq. (6). */
void tsr_change_reduce(const struct tsr_change *change, const struct tsr_gray_view *frame, uint8_t *means);

/* How much brighter I is than M, UQ8.8. Eq. (26). */
unsigned tsr_change_measure_light(const struct tsr_change *change);

/* M and V follow I; cells that changed and are watched are marked, and counted. Eqs. (27), (7) to (9), (28). */
unsigned tsr_change_follow(struct tsr_change *change, unsigned light_q8);

/* Whether a cell whose D exceeds V by excess > 0 changed: C of eq. (9), and the watched rectangles. */
bool tsr_change_counts(const struct tsr_change *change, unsigned x, unsigned y, int excess);

/* Whether so many marked cells touch one another. Consumes I and marks. */
bool tsr_change_has_region(struct tsr_change *change, unsigned min_cells);

#endif
