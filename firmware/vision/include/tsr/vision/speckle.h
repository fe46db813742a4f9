/*
 * Remove small islands from a disparity map, in place.
 *
 *   p ~ q  <=>  p, q neighbours in a row or column, both valid,
 *               |map(p) - map(q)| <= max_difference        docs/math.md, eq. (81)
 *   out(p) = invalid if p's component of ~ has fewer than
 *            min_size pixels, else map(p)                  eq. (82)
 *
 * The components are those of OpenCV's filterSpeckles (H. Hirschmueller,
 * PAMI 30(2), 2008, section 2.5.1, names the peak filter), and so is the result
 * with maxSpeckleSize = min_size - 1.
 *
 * Rows are joined from the top by union-find over the pixels of two rows. A
 * component without a pixel in the next row is complete: if it is small, it is
 * erased by following its pixels, of which there are fewer than min_size.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_SPECKLE_H
#define TSR_VISION_SPECKLE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_SPECKLE_SIZE_MAX 4096
#define TSR_SPECKLE_SCRATCH_ALIGN 2

/* Zero in a field means the default named beside it. */
struct tsr_speckle_config {
    uint16_t min_size;          /* px, 2 .. TSR_SPECKLE_SIZE_MAX; default 50 */
    uint16_t max_difference_q4; /* px, UQ12.4, 1 .. 65535; default 16 (1 px) */
};

/* Content belongs to the module. */
struct tsr_speckle {
    struct tsr_speckle_config config; /* defaults filled in */
    uint16_t *map;
    uint8_t *scratch;
    uint16_t width;
    uint16_t height;
    uint16_t rows_done;
};

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field
 * ("config" for a null config). *field is a static string. */
enum tsr_status tsr_speckle_check(const struct tsr_speckle_config *config, const char **field);

/* Scratch bytes, from resolved values and from a configuration (0 if it does
 * not check): a link for each pixel of two rows, the list of an island's pixels. */
#define TSR_SPECKLE_SCRATCH_LEN(width, min_size) (4u * (size_t)(width) + 6u * ((size_t)(min_size)-1u))
size_t tsr_speckle_scratch_len(const struct tsr_speckle_config *config, uint16_t width);

/*
 * Begin.
 *
 *   speckle      filled
 *   config       borrowed (copied)
 *   width,       px, 1 .. TSR_IMAGE_WIDTH_MAX, 1 .. TSR_IMAGE_HEIGHT_MAX
 *   height
 *   map          [height][width] in and out, px, UQ12.4 or
 *                TSR_DISPARITY_INVALID; kept until run returns TSR_OK
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the map; aligned to
 *                TSR_SPECKLE_SCRATCH_ALIGN, apart from the map
 *   scratch_cap  bytes, >= tsr_speckle_scratch_len(config, width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer, a bad field or a
 * shape out of range; TSR_ERR_NOBUF if a buffer is too small. On error nothing
 * is written.
 */
enum tsr_status tsr_speckle_start(struct tsr_speckle *speckle, const struct tsr_speckle_config *config, uint16_t width,
                                  uint16_t height, uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap);

/*
 * Continue for at most rows rows. Row y of the map is final min_size - 1 rows
 * later at the latest. The result does not depend on how the rows are divided
 * among calls.
 *
 * About 120 instructions per pixel (Cortex-M4), with 90 more for each pixel that is
 * erased, which a row does in at most min(y + 1, min_size - 1) pixels per column.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null speckle or rows = 0.
 */
enum tsr_status tsr_speckle_run(struct tsr_speckle *speckle, uint16_t rows);

uint16_t tsr_speckle_rows_done(const struct tsr_speckle *speckle);

#endif
