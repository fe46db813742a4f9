/*
 * Smooth a disparity map within its surfaces by anisotropic diffusion, in place
 * (P. Perona, J. Malik, PAMI 12(7), 1990, eqs. (7) and (8), with their second
 * conductance g(s) = 1 / (1 + (s / K)^2)).
 *
 *   c(s)   = round( 256 K^2 / (K^2 + s^2) )               docs/math.md, eq. (86)
 *   out(p) = map(p) + round( rate / 2^16 *
 *            sum of c(map(q) - map(p)) (map(q) - map(p)) )            eq. (87)
 *
 * over the valid q among the four neighbours of p, all values before the
 * iteration; iterations times. c to nearest, ties up; the change to nearest,
 * ties away from zero. No value leaves the range of its neighbourhood's, an
 * invalid pixel stays invalid and neither gives nor takes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_DIFFUSION_H
#define TSR_VISION_DIFFUSION_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_DIFFUSION_ITERATIONS_MAX 100
#define TSR_DIFFUSION_SCRATCH_ALIGN 2

/* Zero in a field means the default named beside it. */
struct tsr_diffusion_config {
    uint8_t iterations; /* 1 .. TSR_DIFFUSION_ITERATIONS_MAX; default 5 */
    uint8_t edge_q4;    /* K, px, UQ4.4: differences above it are edges; 1 .. 255; default 16 (1 px) */
    uint8_t rate_q8;    /* 1 .. 64: the four neighbours' greatest shares, of 256; default 64 */
};

/* Scratch bytes: a row of the map before the iteration. */
#define TSR_DIFFUSION_SCRATCH_LEN(width) (2u * (size_t)(width))

/* Content belongs to the module. */
struct tsr_diffusion {
    struct tsr_diffusion_config config; /* defaults filled in */
    uint16_t *map;
    uint8_t *scratch;
    uint16_t width;
    uint16_t height;
    uint16_t row; /* the next one of the iteration */
    uint16_t rows_done;
};

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field
 * ("config" for a null config). *field is a static string. */
enum tsr_status tsr_diffusion_check(const struct tsr_diffusion_config *config, const char **field);

/*
 * Begin.
 *
 *   diffusion    filled
 *   config       borrowed (copied)
 *   width,       px, 1 .. TSR_IMAGE_WIDTH_MAX, 1 .. TSR_IMAGE_HEIGHT_MAX
 *   height
 *   map          [height][width] in and out, px, UQ12.4 or
 *                TSR_DISPARITY_INVALID; kept until run returns TSR_OK
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the map; aligned to
 *                TSR_DIFFUSION_SCRATCH_ALIGN, apart from the map
 *   scratch_cap  bytes, >= TSR_DIFFUSION_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer, a bad field or a
 * shape out of range; TSR_ERR_NOBUF if a buffer is too small. On error nothing
 * is written.
 */
enum tsr_status tsr_diffusion_start(struct tsr_diffusion *diffusion, const struct tsr_diffusion_config *config,
                                    uint16_t width, uint16_t height, uint16_t *map, size_t map_cap, uint8_t *scratch,
                                    size_t scratch_cap);

/*
 * Continue for at most rows rows of work, of iterations * height in all, each
 * about 45 instructions per pixel (Cortex-M4). The result does not depend on
 * how the rows are divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null diffusion or rows = 0.
 */
enum tsr_status tsr_diffusion_run(struct tsr_diffusion *diffusion, uint16_t rows);

/* Rows of work done since start, and in all; config must check. */
uint16_t tsr_diffusion_rows_done(const struct tsr_diffusion *diffusion);
uint16_t tsr_diffusion_rows_total(const struct tsr_diffusion_config *config, uint16_t height);

#endif
