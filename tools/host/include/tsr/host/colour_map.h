/*
 * Colours for numbers: disparity maps as pictures.
 *
 * viridis (S. van der Walt, N. Smith, matplotlib 1.5, CC0) by a polynomial of degree
 * six per channel (M. Zucker, shadertoy.com/view/WlfXRN, CC0): perceptually
 * uniform and readable without colour vision. Largest error of a channel
 * against matplotlib's table: about 4 of 255, at the ends.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_COLOUR_MAP_H
#define TSR_HOST_COLOUR_MAP_H

#include <array>
#include <cstdint>
#include <span>

#include "tsr/host/image_file.h"

namespace tsr
{

/* Red, green, blue of value in 0 .. 1 (clamped; not a number counts as 0). */
std::array<std::uint8_t, 3> viridis(double value);

/*
 * A disparity map (UQ12.4, width * height values) as a picture: 0 px dark
 * blue, disparities - 1 px yellow (near), TSR_DISPARITY_INVALID black.
 */
RgbImage colour_disparity(std::span<const std::uint16_t> disparity_q4, int width, int height, int disparities);

} // namespace tsr

#endif
