/*
 * Smooth a disparity map by a binomial kernel over the valid pixels, in place.
 *
 *   out(x,y) = round( sum of b(i) b(j) map(x + i, y + j)
 *                     / sum of b(i) b(j) )                docs/math.md, eq. (85)
 *
 * both sums over the valid neighbours inside the map, i, j = -r .. r, with
 * b = 1 2 1 for a window of 3 px and 1 4 6 4 1 for 5 px (the Gaussian of
 * variance r / 2). Normalised convolution: H. Knutsson, C.-F. Westin, CVPR 1993.
 *
 * To nearest, ties up. An invalid pixel stays invalid and weighs nothing. The
 * kernel does not stop at edges of depth: it mixes both sides.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_GAUSSIAN_H
#define TSR_VISION_GAUSSIAN_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_GAUSSIAN_WINDOW_MAX 5
#define TSR_GAUSSIAN_SCRATCH_ALIGN 2

/* Scratch bytes: window / 2 rows of the map before the filter. */
#define TSR_GAUSSIAN_SCRATCH_LEN(width, window) (2u * (size_t)(width) * ((size_t)(window) / 2u))

/* Content belongs to the module. */
struct tsr_gaussian {
    uint16_t *map;
    uint8_t *scratch;
    uint16_t width;
    uint16_t height;
    uint16_t rows_done;
    uint8_t radius;
};

/*
 * Begin.
 *
 *   gaussian     filled
 *   window       px, 3 or 5
 *   width,       px, 1 .. TSR_IMAGE_WIDTH_MAX, 1 .. TSR_IMAGE_HEIGHT_MAX
 *   height
 *   map          [height][width] in and out, px, UQ12.4 or
 *                TSR_DISPARITY_INVALID; kept until run returns TSR_OK
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the map; aligned to
 *                TSR_GAUSSIAN_SCRATCH_ALIGN, apart from the map
 *   scratch_cap  bytes, >= TSR_GAUSSIAN_SCRATCH_LEN(width, window)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer or a shape or
 * window out of range; TSR_ERR_NOBUF if a buffer is too small. On error nothing
 * is written.
 */
enum tsr_status tsr_gaussian_start(struct tsr_gaussian *gaussian, uint8_t window, uint16_t width, uint16_t height,
                                   uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap);

/*
 * Continue for at most rows rows, each about 115 instructions per pixel of 3x3
 * and 160 of 5x5 (Cortex-M4). The result does not depend on how the rows are
 * divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null gaussian or rows = 0.
 */
enum tsr_status tsr_gaussian_run(struct tsr_gaussian *gaussian, uint16_t rows);

uint16_t tsr_gaussian_rows_done(const struct tsr_gaussian *gaussian);

#endif
