/*
 * Give every invalid pixel of a disparity map a value, in place.
 *
 * TSR_FILL_BACKGROUND: the farther of the nearest valid pixels of the row,
 * left and right, since what only one camera sees lies behind what hides it:
 *
 *   out(x,y) = min(map(x_l,y), map(x_r,y))           docs/math.md, eq. (83)
 *
 * or the only one of the two beside a border. A row without a valid pixel takes
 * the values of the nearest row with one, the upper of two equally near (84).
 * So the map is dense afterwards, unless it had no valid pixel at all: then it
 * stays as it is. Valid values do not change.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_FILL_H
#define TSR_VISION_FILL_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

enum tsr_fill_rule {
    TSR_FILL_BACKGROUND = 0,
    TSR_FILL_RULE_COUNT
};

#define TSR_FILL_SCRATCH_ALIGN 2
/* Rows of work. */
#define TSR_FILL_ROWS_TOTAL(height) (2u * (uint32_t)(height))

/* Content belongs to the module. */
struct tsr_fill {
    uint16_t *map;
    uint16_t width;
    uint16_t height;
    uint16_t rows_done;
    uint16_t row_above; /* nearest row that had a valid pixel, or none */
    uint8_t rule;
};

/* Scratch bytes of a rule; 0 if it needs none or does not exist. */
size_t tsr_fill_scratch_len(enum tsr_fill_rule rule, uint16_t width);

/*
 * Begin.
 *
 *   fill         filled
 *   width,       px, 1 .. TSR_IMAGE_WIDTH_MAX, 1 .. TSR_IMAGE_HEIGHT_MAX
 *   height
 *   map          [height][width] in and out, px, UQ12.4 or
 *                TSR_DISPARITY_INVALID; kept until run returns TSR_OK
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the map; aligned to
 *                TSR_FILL_SCRATCH_ALIGN, apart from the map; may be null if
 *                tsr_fill_scratch_len(rule, width) is 0
 *   scratch_cap  bytes, >= tsr_fill_scratch_len(rule, width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer or a rule or
 * shape out of range; TSR_ERR_NOBUF if a buffer is too small. On error nothing
 * is written.
 */
enum tsr_status tsr_fill_start(struct tsr_fill *fill, enum tsr_fill_rule rule, uint16_t width, uint16_t height,
                               uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap);

/*
 * Continue for at most rows rows of work, of TSR_FILL_ROWS_TOTAL(height) in all:
 * first every row from itself, about 15 instructions per pixel (Cortex-M4),
 * then the rows that are still empty. The result does not depend on how the rows are divided among
 * calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null fill or rows = 0.
 */
enum tsr_status tsr_fill_run(struct tsr_fill *fill, uint16_t rows);

uint16_t tsr_fill_rows_done(const struct tsr_fill *fill);

#endif
