/*
 * Frame-change detection: does this frame differ from the watched background?
 *
 *   I = box mean of n x n pixels                     docs/math.md, eq. (6)
 *   g = median of I / M over the picture             eq. (26)
 *   E = g M,  M = E + clip(I - E, -s, s)             eqs. (27), (7)
 *   D = |I - M|,  V follows N D, V_min .. V_max      eqs. (7), (8)
 *   cell changed  <=>  D > V + C / 8                 eq. (9)
 *   frame changed <=>  min_cells changed cells touch one another
 *
 * Sigma-delta background estimation (Manzanera & Richefeu, Pattern Recognition
 * Letters 28(3), 2007) on a reduced image, so the state is small and sensor
 * noise is averaged before it is judged. Ours beside it: exposure, gain and
 * light that change the whole picture are taken out by g, their residue by s;
 * C, the contrast around a cell, makes edges less sensitive, since a trembling
 * camera moves them; only changed cells that touch, corners included, make a
 * change; and a changed cell's M follows eight times slower, so who stands
 * still stays a change and leaves no ghost.
 *
 * Light that changes less than half of the picture, a lamp's, is a change.
 *
 * Calling context: any, no call blocks. Cost of an update, Cortex-M4, n = 4:
 * 6.0 instructions per pixel of the frame, 9.1 when all of it has changed, 2.2
 * for a rebase (tools/bench work).
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

#define TSR_CHANGE_WATCHED_MAX 4

/* Zero in a field means the default named beside it. */
struct tsr_change_config {
    uint16_t width;        /* px, 8 .. TSR_IMAGE_WIDTH_MAX; no default */
    uint16_t height;       /* px, 8 .. TSR_IMAGE_HEIGHT_MAX; no default */
    uint8_t reduction;     /* n, pixels per cell side: 2, 4 or 8; default 4 */
    uint8_t amplification; /* N, 1 .. 8; default 4 */
    uint8_t deviation_min; /* V_min, gray levels, 1 .. 127; default 5 */
    uint8_t deviation_max; /* V_max, gray levels, V_min .. 127; default 64 */
    uint16_t min_cells;    /* touching changed cells that make a change, 1 .. cells; default: the watched
                              rectangles' pixels (the picture's if none) / (400 n^2), at least 2 */
    uint8_t settle_frames; /* first frames that only teach, 1 .. 255; default 4 */
    uint8_t watched_count; /* 0 .. TSR_CHANGE_WATCHED_MAX; 0: the whole picture is watched */
    /* Not empty and inside the picture. Cells that share no pixel with one of these never count as changed; they still
     * tell how bright it is. */
    struct tsr_rectangle watched[TSR_CHANGE_WATCHED_MAX];
};

struct tsr_change_result {
    bool changed;           /* min_cells changed cells touch one another, and not settling */
    bool settling;          /* one of the first settle_frames frames */
    uint16_t changed_cells; /* watched cells that changed, whether they touch or not; 0 while settling */
    uint16_t light_q8;      /* g, UQ8.8: how much brighter the frame is than the background, 0.5 .. 2 */
};

/* Content belongs to the module. */
struct tsr_change {
    struct tsr_change_config config; /* defaults filled in */
    uint8_t *state;                  /* I of every cell, then M, then V */
    uint16_t cells_x;
    uint16_t cells_y;
    uint8_t frames; /* frames seen, saturating at settle_frames */
    uint8_t beat;   /* updates, modulo 256 */
};

/* Bytes of state: I, M and V of floor(w / n) x floor(h / n) cells. Up to n - 1
 * last columns and rows are not watched. reduction is not 0 here. */
#define TSR_CHANGE_STATE_LEN(width, height, reduction)                                                                 \
    (3u * (size_t)((width) / (reduction)) * (size_t)((height) / (reduction)))

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
 *   frame   [height][width] in, gray, any stride >= width, any alignment, borrowed
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
