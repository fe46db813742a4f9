/*
 * Median of a disparity map over window x window pixels, in place.
 *
 *   out(x,y) = lower median of the valid values      docs/math.md, eqs. (18), (80)
 *              among the neighbours inside the map
 *
 * A pixel is valid afterwards if enough of its neighbours, itself included, were
 * valid before: 4 of 3x3 (what a corner of the map has), more than half of those
 * of 5x5 that lie inside the map. Specks vanish, pinholes close. Of n values in
 * ascending order the lower median is the one at (n - 1) / 2.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MEDIAN_H
#define TSR_VISION_MEDIAN_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_MEDIAN_WINDOW 3 /* px, of tsr_median_start */
#define TSR_MEDIAN_WINDOW_MAX 5
#define TSR_MEDIAN_VALID_MIN 4 /* of TSR_MEDIAN_WINDOW */
#define TSR_MEDIAN_SCRATCH_ALIGN 2

/* Scratch bytes of either window: two rows of the map before the median. */
#define TSR_MEDIAN_SCRATCH_LEN(width) (4u * (size_t)(width))

/* Content belongs to the module. */
struct tsr_median {
    uint16_t *map;
    uint8_t *scratch;
    uint16_t width;
    uint16_t height;
    uint16_t rows_done;
    uint8_t window;
};

/*
 * Begin a median of 3x3 pixels, or of window x window.
 *
 *   median       filled
 *   window       px, TSR_MEDIAN_WINDOW or TSR_MEDIAN_WINDOW_MAX
 *   width,       px, 1 .. TSR_IMAGE_WIDTH_MAX, 1 .. TSR_IMAGE_HEIGHT_MAX
 *   height
 *   map          [height][width] in and out, px, UQ12.4 or
 *                TSR_DISPARITY_INVALID; kept until run returns TSR_OK
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the map; aligned to
 *                TSR_MEDIAN_SCRATCH_ALIGN, apart from the map
 *   scratch_cap  bytes, >= TSR_MEDIAN_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer or a shape or
 * window out of range; TSR_ERR_NOBUF if a buffer is too small. On error nothing
 * is written.
 */
enum tsr_status tsr_median_start(struct tsr_median *median, uint16_t width, uint16_t height, uint16_t *map,
                                 size_t map_cap, uint8_t *scratch, size_t scratch_cap);
enum tsr_status tsr_median_start_window(struct tsr_median *median, uint8_t window, uint16_t width, uint16_t height,
                                        uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap);

/*
 * Continue for at most rows rows, each about 80 instructions per pixel of 3x3 and
 * 600 of 5x5 (Cortex-M4). The result does not depend on how the rows are divided
 * among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null median or rows = 0.
 */
enum tsr_status tsr_median_run(struct tsr_median *median, uint16_t rows);

uint16_t tsr_median_rows_done(const struct tsr_median *median);

#endif
