/*
 * Frame-change detection: does this frame differ from the watched background?
 *
 *   I = box mean of n x n pixels                     docs/math.md, eq. (6)
 *   M += sgn(I - M),  D = |I - M|                    eq. (7)
 *   V += sgn(N D - V), V_min <= V <= V_max           eq. (8)
 *   cell changed  <=>  D > V                         eq. (9)
 *
 * Sigma-delta background estimation (Manzanera & Richefeu, Pattern Recognition
 * Letters 28(3), 2007) on a reduced image, so the state is small and sensor
 * noise is averaged before it is judged. M follows slow drifts by one gray
 * level a frame, V is N times the usual deviation of the cell.
 *
 * There is no compensation of global light: a lamp switched on is a change.
 *
 * Calling context: any, no call blocks. Cost of an update: about 9 instructions
 * per pixel (Cortex-M4, n = 4).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_CHANGE_H
#define TSR_VISION_CHANGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"

/* Zero in a field means the default named beside it. */
struct tsr_change_config {
    uint16_t width;        /* px, 8 .. TSR_IMAGE_WIDTH_MAX; no default */
    uint16_t height;       /* px, 8 .. TSR_IMAGE_HEIGHT_MAX; no default */
    uint8_t reduction;     /* n, pixels per cell side: 2, 4 or 8; default 4 */
    uint8_t amplification; /* N, 1 .. 8; default 4 */
    uint8_t deviation_min; /* V_min, gray levels, 1 .. 127; default 6 */
    uint8_t deviation_max; /* V_max, gray levels, V_min .. 255; default 64 */
    uint16_t min_cells;    /* changed cells that make a change, 1 .. cells; default cells / 200, at least 2 */
    uint8_t settle_frames; /* first frames that only teach, 1 .. 255; default 4 */
};

struct tsr_change_result {
    bool changed;           /* changed_cells >= min_cells, and not settling */
    bool settling;          /* one of the first settle_frames frames */
    uint16_t changed_cells; /* cells with D > V; 0 while settling */
};

/* Content belongs to the module. */
struct tsr_change {
    struct tsr_change_config config; /* defaults filled in */
    uint8_t *state;                  /* M of every cell, then V of every cell */
    uint16_t cells_x;
    uint16_t cells_y;
    uint8_t frames; /* frames seen, saturating at settle_frames */
};

/* Bytes of state: M and V of floor(w / n) x floor(h / n) cells. Up to n - 1
 * last columns and rows are not watched. reduction is not 0 here. */
#define TSR_CHANGE_STATE_LEN(width, height, reduction)                                                                 \
    (2u * (size_t)((width) / (reduction)) * (size_t)((height) / (reduction)))

/* The same from a configuration (defaults resolved); 0 if it does not check. */
size_t tsr_change_state_len(const struct tsr_change_config *config);

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field
 * ("config" for a null config). *field is a static string. */
enum tsr_status tsr_change_check(const struct tsr_change_config *config, const char **field);

/*
 * Begin to watch. The first frame given to update becomes the background.
 *
 *   change     filled
 *   config     borrowed (copied)
 *   state      [state_cap] kept as long as change is used; any alignment
 *   state_cap  >= tsr_change_state_len(config)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or a bad field;
 * TSR_ERR_NOBUF if state_cap is too small. On error nothing is written.
 */
enum tsr_status tsr_change_init(struct tsr_change *change, const struct tsr_change_config *config, uint8_t *state,
                                size_t state_cap);

/*
 * Compare a frame with the background, then let the background follow it.
 *
 *   frame   [height][width] in, gray, any stride >= width, borrowed
 *   result  filled
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer; TSR_ERR_SIZE if the frame's
 * width or height is not the configured one or its stride < width. On error
 * background and result are untouched.
 */
enum tsr_status tsr_change_update(struct tsr_change *change, const struct tsr_gray_view *frame,
                                  struct tsr_change_result *result);

/*
 * Make this frame the background: M = I, V is kept. For a scene whose change
 * has been dealt with (a map of it was sent), so that it wakes nobody again.
 * Counts as one frame of settling. Returns as update does.
 */
enum tsr_status tsr_change_rebase(struct tsr_change *change, const struct tsr_gray_view *frame);

#endif
