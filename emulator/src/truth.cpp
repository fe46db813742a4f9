/*
 * Error of a map against ground truth, in pixels and in depth.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/truth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

/* The lower median, of at least one; values are reordered. */
double median(std::vector<double> &values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double share(std::size_t part, std::size_t whole)
{
    return static_cast<double>(part) / static_cast<double>(whole);
}

} // namespace

std::optional<MapError> compare_with_truth(const FloatImage &map, const FloatImage &truth, const SitePair &pair,
                                           const std::filesystem::path &name)
{
    if (map.width != truth.width || map.height != truth.height) {
        throw InputError(name.string(), "size", "is not the map's");
    }
    MapError error;
    std::vector<double> errors_px;
    std::vector<double> errors_mm;
    std::vector<double> errors_percent;
    std::size_t within_half = 0;
    std::size_t within_one = 0;
    double sum_px = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        if (!std::isfinite(truth.pixels[i])) {
            continue;
        }
        ++error.truth_pixels;
        if (!std::isfinite(map.pixels[i])) {
            continue;
        }
        const double error_px = std::abs(static_cast<double>(map.pixels[i]) - static_cast<double>(truth.pixels[i]));
        errors_px.push_back(error_px);
        sum_px += error_px;
        within_half += error_px <= 0.5 ? 1 : 0;
        within_one += error_px <= 1.0 ? 1 : 0;
        const double map_divisor = static_cast<double>(map.pixels[i]) + pair.d0_px;
        const double truth_divisor = static_cast<double>(truth.pixels[i]) + pair.d0_px;
        if (map_divisor > 0 && truth_divisor > 0) {
            const double true_mm = pair.focal_px * pair.baseline_mm / truth_divisor;
            const double error_mm = std::abs(pair.focal_px * pair.baseline_mm / map_divisor - true_mm);
            errors_mm.push_back(error_mm);
            errors_percent.push_back(100 * error_mm / true_mm);
        }
    }
    if (error.truth_pixels == 0) {
        return std::nullopt;
    }
    error.matched_pixels = errors_px.size();
    error.correct = share(within_one, error.truth_pixels);
    if (errors_px.empty()) {
        return error;
    }
    error.bad_half = 1 - share(within_half, error.matched_pixels);
    error.bad_1 = 1 - share(within_one, error.matched_pixels);
    error.mean_px = sum_px / static_cast<double>(error.matched_pixels);
    error.median_px = median(errors_px);
    if (!errors_mm.empty()) {
        error.median_mm = median(errors_mm);
        error.median_depth_percent = median(errors_percent);
    }
    return error;
}

} // namespace tsr
