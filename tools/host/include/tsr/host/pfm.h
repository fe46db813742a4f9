/*
 * PFM, the float image format of the Middlebury stereo pages: disparities
 * in pixels or depths in metres, "no value" is +infinity.
 *
 *   Pf \n width height \n scale \n  then 32-bit floats, bottom row first;
 *   scale < 0 says little-endian. Paul Debevec's HDR Shop; Middlebury Stereo
 *   Evaluation, file formats.
 *
 * Written little-endian with scale -1. Read in either byte order; values that
 * are not finite become +infinity; the scale's magnitude is not applied.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_PFM_H
#define TSR_HOST_PFM_H

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <vector>

namespace tsr
{

inline constexpr float kFloatInvalid = std::numeric_limits<float>::infinity();

/* Row-major, top row first (the file's order is turned round). */
struct FloatImage {
    int width = 0;
    int height = 0;
    std::vector<float> pixels;
};

/* Throws InputError: colour PFM, truncated or oversized file, bad header. */
FloatImage read_pfm(const std::filesystem::path &file);
FloatImage decode_pfm(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);
void write_pfm(const std::filesystem::path &file, const FloatImage &image);

/* UQ12.4 disparities (tsr/base/disparity.h) as pixels; TSR_DISPARITY_INVALID as kFloatInvalid.
 * disparity_q4 holds width * height values, row-major. */
FloatImage float_disparity(std::span<const std::uint16_t> disparity_q4, int width, int height);

} // namespace tsr

#endif
