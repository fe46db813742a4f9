/*
 * Counting errors.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/stereo/map_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "structural_similarity.h"

namespace tsr
{
namespace
{

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

bool is_known(const FloatImage &truth, const std::vector<bool> &admitted, std::size_t i)
{
    return std::isfinite(truth.pixels[i]) && (admitted.empty() || admitted[i]);
}

/* Of an even number the mean of the middle two. */
double median_of_sorted(const std::vector<double> &values)
{
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 != 0 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

void measure_errors(MapQuality &quality, std::vector<double> errors)
{
    std::sort(errors.begin(), errors.end());
    for (std::size_t t = 0; t < kQualityThresholds.size(); t++) {
        const auto right =
            static_cast<double>(std::upper_bound(errors.begin(), errors.end(), kQualityThresholds[t]) - errors.begin());
        quality.correct[t] = right / static_cast<double>(quality.known);
        quality.bad[t] = errors.empty() ? kUndefined : 1 - right / static_cast<double>(errors.size());
    }
    double sum = 0;
    double squares = 0;
    for (const double error : errors) {
        sum += error;
        squares += error * error;
    }
    const auto count = static_cast<double>(errors.size());
    quality.median_error_px = errors.empty() ? kUndefined : median_of_sorted(errors);
    quality.mean_error_px = errors.empty() ? kUndefined : sum / count;
    quality.mse_px2 = errors.empty() ? kUndefined : squares / count;
}

} // namespace

std::size_t count_known(const FloatImage &truth, const std::vector<bool> &admitted)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); i++) {
        count += is_known(truth, admitted, i) ? 1 : 0;
    }
    return count;
}

MapQuality judge_map(const FloatImage &map, const FloatImage &truth, const std::vector<bool> &admitted,
                     std::optional<double> range_px)
{
    MapQuality quality;
    std::vector<double> errors;
    std::vector<bool> valid(map.pixels.size(), false);
    double largest = 0;
    for (std::size_t i = 0; i < map.pixels.size(); i++) {
        if (!is_known(truth, admitted, i)) {
            continue;
        }
        quality.known++;
        largest = std::max(largest, static_cast<double>(truth.pixels[i]));
        valid[i] = std::isfinite(map.pixels[i]);
        if (valid[i]) {
            errors.push_back(std::abs(static_cast<double>(map.pixels[i]) - static_cast<double>(truth.pixels[i])));
        }
    }
    quality.valid = errors.size();
    quality.range_px = range_px.value_or(largest);
    measure_errors(quality, std::move(errors));
    quality.psnr_db = 10 * std::log10(quality.range_px * quality.range_px / quality.mse_px2);
    quality.ssim = structural_similarity(map, truth, valid, quality.range_px);
    return quality;
}

} // namespace tsr
