/*
 * Restore what rounding took from a decoded map, in place: for receivers.
 *
 * A node rounds its map to steps before it codes it (tsr/vision/quantise.h), so a slope arrives as
 * stairs. Neighbours on one surface tell where within its step each pixel lay:
 *
 *   N(p)     = the valid q of the 5x5 pixels around p, p included, with |m(q) - m(p)| <= 2^k    docs/math.md, eq. (91)
 *   r_0      = the middle of V(p), the values that round to m(p)                                      eqs. (90), (92)
 *   r_(t+1)  = the mean of r_t over N(p), to nearest, ties up, limited to V(p)                        eq. (93)
 *   out      = r_8 to nearest, ties up                                                                eq. (94)
 *
 * with m the decoded map, step 2^k, all values of an iteration from the one before; m, V and out in UQ12.4, r in
 * UQ8.8. Ours; to decode a picture within the constraint that it was quantised to what arrived is A. Zakhor's
 * (*Iterative procedures for reduction of blocking effects in transform image coding*, IEEE TCSVT 2(1), 1992).
 *
 * Every pixel stays within its step, so quantising the result gives the decoded map again; surfaces more than
 * a step apart do not mix. An invalid pixel stays invalid and gives nothing, a map of step_log2 = 0 stays as it is, a
 * map of near > 0 stays within the steps it was decoded to. The result is any sixteenth of a pixel below 16 *
 * disparities: no longer a map to code, to compare with a coded one, or to refer to.
 *
 *   info         in; what the decoder gave; of it width, height, disparities and step_log2 are used
 *   map          [height][width] in and out, px, UQ12.4 or TSR_DISPARITY_INVALID
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] apart from the map; content of no meaning before and after
 *   scratch_cap  >= TSR_MAP_RESTORE_SCRATCH_COUNT(width, height)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer, an info field out of range, or a value of the map that is neither
 * invalid nor a multiple of 2^k below 16 * disparities; TSR_ERR_NOBUF if a buffer is too small. On error the map and
 * the scratch are untouched.
 *
 * Not resumable. The work depends on the shape alone: per pixel at most 200 comparisons and additions, 8 divisions.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_RESTORE_H
#define TSR_CODEC_MAP_RESTORE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"
#include "tsr/codec/map.h"

/* Elements of the uint16_t scratch: the decoded map, a second buffer of the iteration, a row of sums and one of counts.
 */
#define TSR_MAP_RESTORE_SCRATCH_COUNT(width, height) (2u * (size_t)(width) * ((size_t)(height) + 1u))

enum tsr_status tsr_map_restore(const struct tsr_map_info *info, uint16_t *map, size_t map_cap, uint16_t *scratch,
                                size_t scratch_cap);

#endif
