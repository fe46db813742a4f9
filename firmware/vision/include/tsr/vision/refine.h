/*
 * What is done to a disparity map after matching: up to TSR_REFINE_STEPS_MAX
 * filters, one after another, in place and in one scratch buffer.
 *
 *   median.h  speckle.h  fill.h  gaussian.h  diffusion.h
 *
 * The result is that of the filters' own functions in the same order.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_REFINE_H
#define TSR_VISION_REFINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"
#include "tsr/vision/diffusion.h"
#include "tsr/vision/fill.h"
#include "tsr/vision/gaussian.h"
#include "tsr/vision/median.h"
#include "tsr/vision/speckle.h"

#define TSR_REFINE_STEPS_MAX 8
#define TSR_REFINE_SCRATCH_ALIGN 2

enum tsr_refine_step {
    TSR_REFINE_END = 0, /* no more steps */
    TSR_REFINE_MEDIAN3,
    TSR_REFINE_MEDIAN5,
    TSR_REFINE_SPECKLE,
    TSR_REFINE_FILL,
    TSR_REFINE_GAUSSIAN3,
    TSR_REFINE_GAUSSIAN5,
    TSR_REFINE_DIFFUSION,
    TSR_REFINE_STEP_COUNT
};

struct tsr_refine_config {
    uint16_t width;                      /* px, 1 .. TSR_IMAGE_WIDTH_MAX; no default */
    uint16_t height;                     /* px, 1 .. TSR_IMAGE_HEIGHT_MAX; no default */
    uint8_t steps[TSR_REFINE_STEPS_MAX]; /* enum tsr_refine_step in order, up to the first TSR_REFINE_END */
    struct tsr_speckle_config speckle;
    struct tsr_diffusion_config diffusion;
    uint8_t fill_rule; /* enum tsr_fill_rule */
};

/* Content belongs to the module. */
struct tsr_refine {
    struct tsr_refine_config config;
    uint16_t *map;
    uint8_t *scratch;
    size_t scratch_cap;
    union {
        struct tsr_median median;
        struct tsr_speckle speckle;
        struct tsr_fill fill;
        struct tsr_gaussian gaussian;
        struct tsr_diffusion diffusion;
    } work;
    uint32_t rows_done;
    uint8_t step; /* index in config.steps */
    bool is_started;
};

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field:
 * of this struct, of the two it holds, or "config" for a null config. *field is
 * a static string. */
enum tsr_status tsr_refine_check(const struct tsr_refine_config *config, const char **field);

/* Scratch bytes: the most that a step needs; 0 if config does not check. */
size_t tsr_refine_scratch_len(const struct tsr_refine_config *config);

/*
 * Begin.
 *
 *   refine       filled
 *   config       borrowed (copied)
 *   map          [height][width] in and out, px, UQ12.4 or
 *                TSR_DISPARITY_INVALID; kept until run returns TSR_OK
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the map; aligned to
 *                TSR_REFINE_SCRATCH_ALIGN, apart from the map; may be null if
 *                tsr_refine_scratch_len(config) is 0
 *   scratch_cap  bytes, >= tsr_refine_scratch_len(config)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null or misaligned pointer or a bad field;
 * TSR_ERR_NOBUF if a buffer is too small. On error nothing is written.
 */
enum tsr_status tsr_refine_start(struct tsr_refine *refine, const struct tsr_refine_config *config, uint16_t *map,
                                 size_t map_cap, uint8_t *scratch, size_t scratch_cap);

/*
 * Continue for at most rows rows of work, of tsr_refine_rows_total() in all; the
 * steps' headers have the cost of a row. The result does not depend on how the
 * rows are divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null refine or rows = 0.
 */
enum tsr_status tsr_refine_run(struct tsr_refine *refine, uint16_t rows);

uint32_t tsr_refine_rows_done(const struct tsr_refine *refine);
uint32_t tsr_refine_rows_total(const struct tsr_refine *refine);

#endif
