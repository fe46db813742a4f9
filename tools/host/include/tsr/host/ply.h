/*
 * Point clouds as binary little-endian PLY (Greg Turk, Stanford, 1994):
 * float x y z in metres, uchar red green blue.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_PLY_H
#define TSR_HOST_PLY_H

#include <cstdint>
#include <filesystem>
#include <span>

namespace tsr
{

struct CloudPoint {
    float x_m = 0;
    float y_m = 0;
    float z_m = 0;
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;
};

/* The order of the points is kept. Throws InputError if file cannot be written. */
void write_ply(const std::filesystem::path &file, std::span<const CloudPoint> points);

} // namespace tsr

#endif
