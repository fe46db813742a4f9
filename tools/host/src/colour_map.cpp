/* Colours for numbers. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/colour_map.h"

#include <cmath>
#include <stdexcept>

extern "C" {
#include "tsr/base/disparity.h"
}

namespace tsr
{
namespace
{

/* Coefficients of t^0 .. t^6 for red, green, blue: M. Zucker, shadertoy.com/view/WlfXRN. */
constexpr std::array<std::array<double, 7>, 3> kViridis{
    {{0.2777273272234177, 0.1050930431085774, -0.3308618287255563, -4.634230498983486, 6.228269936347081,
      4.776384997670288, -5.435455855934631},
     {0.005407344544966578, 1.404613529898575, 0.214847559468213, -5.799100973351585, 14.17993336680509,
      -13.74514537774601, 4.645852612178535},
     {0.3340998053353061, 1.384590162594685, 0.09509516302823659, -19.33244095627987, 56.69055260068105,
      -65.35303263337234, 26.3124352495832}}};

std::uint8_t polynomial(const std::array<double, 7> &coefficients, double t)
{
    double sum = 0.0;
    for (std::size_t i = coefficients.size(); i-- > 0;) {
        sum = sum * t + coefficients[i];
    }
    return static_cast<std::uint8_t>(std::lround(255.0 * std::fmin(std::fmax(sum, 0.0), 1.0)));
}

} // namespace

std::array<std::uint8_t, 3> viridis(double value)
{
    const double t = value > 0.0 ? std::fmin(value, 1.0) : 0.0;
    return {polynomial(kViridis[0], t), polynomial(kViridis[1], t), polynomial(kViridis[2], t)};
}

RgbImage colour_disparity(std::span<const std::uint16_t> disparity_q4, int width, int height, int disparities)
{
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (disparity_q4.size() != count) {
        throw std::invalid_argument("colour_disparity: the map does not hold width * height values");
    }
    const double span_q4 = TSR_DISPARITY_ONE_Q4 * std::fmax(disparities - 1, 1);
    RgbImage image{width, height, std::vector<std::uint8_t>(3 * count, 0)};
    for (std::size_t i = 0; i < count; i++) {
        if (disparity_q4[i] != TSR_DISPARITY_INVALID) {
            const auto colour = viridis(disparity_q4[i] / span_q4);
            image.pixels[3 * i] = colour[0];
            image.pixels[3 * i + 1] = colour[1];
            image.pixels[3 * i + 2] = colour[2];
        }
    }
    return image;
}

} // namespace tsr
