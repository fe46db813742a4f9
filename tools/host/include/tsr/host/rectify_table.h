/*
 * The table that a node rectifies with (tsr/vision/rectify.h has its bytes).
 *
 * The control points are the least-squares fit of the spline to all positions
 * of a view, rounded to 1/64 px. The error is measured with the node's own
 * arithmetic over all pixels: distance of the position that the node reads from
 * the position of the calibration, both clipped to the frame.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_RECTIFY_TABLE_H
#define TSR_HOST_RECTIFY_TABLE_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tsr/host/rectification.h"

namespace tsr
{

inline constexpr double kRectifyErrorAimPx = 0.02; /* the widest step that reaches it is taken */
inline constexpr double kRectifyErrorMaxPx = 0.05; /* a table worse than that is refused */

struct RectifyTable {
    std::vector<std::uint8_t> bytes;
    int step = 0;                     /* px between control points */
    std::array<double, 2> error_px{}; /* largest, left and right */
    std::array<int, 2> rows_above{};  /* left and right; in place a node keeps one row more */
    std::array<double, 2> outside{};  /* part of the view's pixels that its frame does not show */
    std::size_t kept_len = 0;         /* bytes of kept rows, the larger of both sides; 0: not in place */
};

/* step: 8, 16, 32, or 0 to choose. Throws InputError naming file if no step
 * follows the map closely enough. */
RectifyTable make_rectify_table(const Rectification &rectification, int step, const std::string &file);

/* A C header that puts the table in flash as static const uint8_t NAME[]. */
std::string rectify_c_header(const RectifyTable &table, const Rectification &rectification, const std::string &name);

} // namespace tsr

#endif
