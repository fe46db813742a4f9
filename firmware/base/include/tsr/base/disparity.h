/*
 * The disparity map's number format, shared by matcher, codec and sink.
 *
 * UQ12.4 pixels in 16 bits: disparity d px is stored as 16 d, 0 <= d < 128.
 * Left pixel (x, y) matches right pixel (x - d, y) of the rectified right view
 * shifted by the pair's search start; depth adds the pair's signed offset d0:
 * Z = f B / (d + d0), docs/math.md.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_DISPARITY_H
#define TSR_BASE_DISPARITY_H

#include <stdint.h>

#define TSR_DISPARITY_FRACTION_BITS 4
#define TSR_DISPARITY_ONE_Q4 (1u << TSR_DISPARITY_FRACTION_BITS)
#define TSR_DISPARITY_COUNT_MAX 128u /* disparities 0 .. 127 px */
/* Marks a pixel without a match; larger than every valid value. */
#define TSR_DISPARITY_INVALID UINT16_C(0xffff)

#endif
