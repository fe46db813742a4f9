/*
 * What a disparity map says of one part of the picture: how much of it is
 * nearer, or farther, than a limit, or lies on one surface, and at what
 * disparity.
 *
 *   C     = the pixels of the part that count                    docs/math.md, eq. (95)
 *   share = |C| / pixels of the part,  disparity = mean over C   eq. (96)
 *
 * The disparity of a plane is linear in x and y, so the mean over a rectangle
 * of its surface is that of the rectangle's middle, however it is tilted. The
 * median keeps mismatches out of it.
 *
 * Resumable by rows, on caller memory, any calling context. Cost: about 13
 * instructions per pixel visited (Cortex-M4, tools/bench work); a surface
 * visits its part three times.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_ZONE_H
#define TSR_VISION_ZONE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

/* Which pixels with a disparity d count. */
enum tsr_zone_kind {
    TSR_ZONE_NEARER = 1, /* d >= limit */
    TSR_ZONE_FARTHER,    /* d < limit */
    TSR_ZONE_SURFACE     /* d within 1 px of the part's lower median */
};

struct tsr_zone_config {
    struct tsr_rectangle part; /* of the map, px; not empty */
    uint8_t kind;              /* enum tsr_zone_kind */
    uint16_t limit_q4;         /* px, UQ12.4; a surface has none */
};

#define TSR_ZONE_NO_DISPARITY UINT16_C(0xffff)

struct tsr_zone_result {
    uint32_t valid;        /* pixels of the part that have a disparity */
    uint32_t counted;      /* of these, pixels that count */
    uint16_t disparity_q8; /* their mean, px, UQ8.8, to nearest; TSR_ZONE_NO_DISPARITY if none counts */
};

/* Content belongs to the module. */
struct tsr_zone {
    struct tsr_zone_config config;
    const uint16_t *map;
    uint16_t stride;
    uint8_t pass;
    uint16_t row;       /* next of this pass */
    uint16_t rows_done; /* of all passes */
    uint16_t low_q4;    /* low_q4 <= d <= high_q4 is what this pass looks for */
    uint16_t high_q4;
    uint32_t rank; /* of the median among them */
    uint32_t valid;
    uint32_t counted;
    uint32_t sum_q4;
    uint32_t histogram[TSR_DISPARITY_COUNT_MAX]; /* by whole pixels, then by sixteenths of one */
};

/*
 * Begin with a part.
 *
 *   zone  filled
 *   config  borrowed (copied)
 *   map     [height][width] in, px, UQ12.4, 0 .. 16 TSR_DISPARITY_COUNT_MAX - 1, or TSR_DISPARITY_INVALID; kept
 *           until run returns TSR_OK
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer, an unknown kind or a part
 * that is empty or not inside the map. On error nothing is written.
 */
enum tsr_status tsr_zone_start(struct tsr_zone *zone, const struct tsr_zone_config *config, const uint16_t *map,
                               uint16_t width, uint16_t height);

/*
 * Continue for at most rows rows of the part. The result does not depend on how
 * the rows are divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the part is measured (and
 * from then on, doing nothing); TSR_ERR_ARG for a null pointer or rows = 0.
 */
enum tsr_status tsr_zone_run(struct tsr_zone *zone, uint16_t rows);

/* Rows that all passes have visited so far. */
uint16_t tsr_zone_rows_done(const struct tsr_zone *zone);

/* Of a zone whose run has returned TSR_OK. */
struct tsr_zone_result tsr_zone_get_result(const struct tsr_zone *zone);

#endif
