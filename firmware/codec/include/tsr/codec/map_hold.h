/*
 * Hold a map to an earlier one of the same camera where nothing changed.
 *
 * A matcher's noise moves the edges of a static scene from map to map, and a
 * map coded against its reference would spend most of its bytes on them. What
 * really changed is at least as large as the matcher's window. So a pixel that
 * differs keeps its new value only if it lies in a window of 7x7 pixels of
 * which at least 25 differ; all others take the reference's. Strips of 4 pixels
 * and blocks of 5x5 come through, lines of 3 do not. Errors do not add up: the
 * reference is what the other side holds, not the map held last.
 *
 *   reference ─┐
 *   map ───────┴► tsr_map_hold ─► tsr_map_encode_start_against ...
 *
 * "Conditional replenishment": Mounts, Bell Syst. Tech. J. 48, 1969; the vote of
 * a window is the majority filter of binary morphology. What it costs and saves:
 * docs/codec.md, 2.10.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_HOLD_H
#define TSR_CODEC_MAP_HOLD_H

#include "tsr/base/status.h"
#include "tsr/codec/map.h"

/* Pixels from a window's centre to its side, and how many of the window must differ. */
#define TSR_MAP_HOLD_RADIUS 3
#define TSR_MAP_HOLD_COUNT 25

/* Elements of the uint16_t scratch row. */
#define TSR_MAP_HOLD_SCRATCH_COUNT(width) ((size_t)(width))

/*
 * Change the pixels of the map that are held, in place.
 *
 *   info        width and height
 *   reference   .map of that shape; its values are taken as they are, so they must be ones that info admits, or
 *               tsr_map_encode_rows refuses the held map
 *   map         [height * stride], in and out
 *   scratch     [scratch_cap] >= TSR_MAP_HOLD_SCRATCH_COUNT(width), used meanwhile
 *   changed     out: pixels that differ from the reference still; NULL if nobody asks
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or a width or height of 0 or above the codec's; TSR_ERR_SIZE for a
 * stride < width; TSR_ERR_NOBUF for a smaller scratch_cap. On error nothing is written.
 */
enum tsr_status tsr_map_hold(const struct tsr_map_info *info, const struct tsr_map_reference *reference, uint16_t *map,
                             size_t stride, uint16_t *scratch, size_t scratch_cap, uint32_t *changed);

#endif
