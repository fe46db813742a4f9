/*
 * Quantise a disparity map in place to steps of 2^k sixteenths of a pixel.
 *
 *   out = min(2^k floor((v + 2^(k-1)) / 2^k), 16 (D - 1))   docs/math.md, eq. (19)
 *
 * To nearest, ties up; a coarser map codes smaller. A value never leaves the
 * coded range, and TSR_DISPARITY_INVALID stays.
 *
 *   map          [count] in and out, px, UQ12.4
 *   count        number of pixels (row order is not used)
 *   step_log2    k, 0 (1/16 px, changes nothing but values above the range) .. 4 (1 px)
 *   disparities  D of the matcher that made the map, 1 .. TSR_DISPARITY_COUNT_MAX
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null map or an argument out of range. On
 * error the map is untouched. Cost about 12 instructions per pixel (Cortex-M4):
 * call it on as many rows at a time as suits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_QUANTISE_H
#define TSR_VISION_QUANTISE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/status.h"

enum tsr_status tsr_quantise(uint16_t *map, size_t count, uint8_t step_log2, uint16_t disparities);

#endif
