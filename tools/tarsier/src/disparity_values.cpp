/*
 * Pixels to sixteenths, and sixteenths to steps.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/coding/disparity_values.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "tsr/host/input_error.h"

extern "C" {
#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/vision/quantise.h"
}

namespace tsr
{
namespace
{

constexpr long kValueMax = TSR_DISPARITY_COUNT_MAX * TSR_DISPARITY_ONE_Q4 - 1;
constexpr unsigned kDisparitiesMultiple = 8;

} // namespace

DisparityValues disparity_values(const FloatImage &map, const std::filesystem::path &file)
{
    if (map.width > TSR_IMAGE_WIDTH_MAX || map.height > TSR_IMAGE_HEIGHT_MAX) {
        throw InputError(file.string(), "size",
                         std::to_string(map.width) + "x" + std::to_string(map.height) + ", larger than " +
                             std::to_string(TSR_IMAGE_WIDTH_MAX) + "x" + std::to_string(TSR_IMAGE_HEIGHT_MAX));
    }
    DisparityValues result;
    result.width = static_cast<std::uint16_t>(map.width);
    result.height = static_cast<std::uint16_t>(map.height);
    result.values_q4.reserve(map.pixels.size());
    long largest = 0;
    for (std::size_t i = 0; i < map.pixels.size(); i++) {
        if (!std::isfinite(map.pixels[i])) {
            result.values_q4.push_back(TSR_DISPARITY_INVALID);
            continue;
        }
        const double sixteenths = static_cast<double>(map.pixels[i]) * TSR_DISPARITY_ONE_Q4;
        if (!(sixteenths > -0.5 && sixteenths < kValueMax + 0.5)) {
            throw InputError(file.string(), "disparity",
                             fmt::format("{:g} px at ({}, {}), outside 0 .. 127.9375", map.pixels[i], i % result.width,
                                         i / result.width));
        }
        const long value = std::lround(sixteenths);
        largest = std::max(largest, value);
        result.values_q4.push_back(static_cast<std::uint16_t>(value));
    }
    /* quantised() stays at or below disparities - 1, so one more than the largest, rounded up. */
    const unsigned needed = static_cast<unsigned>((largest + TSR_DISPARITY_ONE_Q4 - 1) / TSR_DISPARITY_ONE_Q4) + 1;
    const unsigned rounded = (needed + kDisparitiesMultiple - 1) / kDisparitiesMultiple * kDisparitiesMultiple;
    result.disparities = static_cast<std::uint16_t>(std::min(rounded, TSR_DISPARITY_COUNT_MAX));
    return result;
}

std::vector<std::uint16_t> quantised(const DisparityValues &values, std::uint8_t step_log2)
{
    std::vector<std::uint16_t> result = values.values_q4;
    (void)tsr_quantise(result.data(), result.size(), step_log2, values.disparities);
    return result;
}

} // namespace tsr
