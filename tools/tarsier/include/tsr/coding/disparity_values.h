/*
 * From disparities in pixels, as files hold them, to what the map codec codes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODING_DISPARITY_VALUES_H
#define TSR_CODING_DISPARITY_VALUES_H

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tsr/host/pfm.h"

namespace tsr
{

struct DisparityValues {
    std::uint16_t width = 0;
    std::uint16_t height = 0;
    std::uint16_t disparities = 0;        /* the least multiple of 8 that is above every value, at least 8 */
    std::vector<std::uint16_t> values_q4; /* [height][width], px, UQ12.4, or TSR_DISPARITY_INVALID */
};

/* Rounded to the nearest sixteenth. Throws InputError naming the file for a map larger than 640x480 or a disparity
 * outside 0 .. 127 15/16 px. */
DisparityValues disparity_values(const FloatImage &map, const std::filesystem::path &file);

/* The multiples of 2^step_log2 sixteenths nearest to the values, as a node quantises. */
std::vector<std::uint16_t> quantised(const DisparityValues &values, std::uint8_t step_log2);

} // namespace tsr

#endif
