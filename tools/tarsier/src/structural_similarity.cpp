/*
 * SSIM by five weighted means of each window; the Gaussian goes along rows
 * first, then down columns.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "structural_similarity.h"

#include <array>
#include <cmath>
#include <limits>

namespace tsr
{
namespace
{

constexpr std::size_t kRadius = 5; /* 11 x 11 */
constexpr double kSigma = 1.5;
constexpr double kK1 = 0.01;
constexpr double kK2 = 0.03;

/* Of valid pixels: 1, a, b, a^2, b^2, a b; of others 0. */
using Moments = std::array<double, 6>;

std::array<double, 2 * kRadius + 1> gaussian_window()
{
    std::array<double, 2 * kRadius + 1> window;
    for (std::size_t i = 0; i < window.size(); i++) {
        const double distance = static_cast<double>(i) - static_cast<double>(kRadius);
        window[i] = std::exp(-distance * distance / (2 * kSigma * kSigma));
    }
    return window;
}

/* Weighted sums of the 2 kRadius + 1 values around at, step apart. */
Moments sum_around(const std::vector<Moments> &values, std::size_t at, std::size_t step)
{
    static const auto kWindow = gaussian_window();
    Moments sums = {};
    for (std::size_t i = 0; i < kWindow.size(); i++) {
        const Moments &value = values[at + i * step - kRadius * step];
        for (std::size_t k = 0; k < sums.size(); k++) {
            sums[k] += kWindow[i] * value[k];
        }
    }
    return sums;
}

/* Eq. (13) of the paper from the sums of a window. */
double similarity_of(const Moments &sums, double range)
{
    const double mean_a = sums[1] / sums[0];
    const double mean_b = sums[2] / sums[0];
    const double variance_a = sums[3] / sums[0] - mean_a * mean_a;
    const double variance_b = sums[4] / sums[0] - mean_b * mean_b;
    const double covariance = sums[5] / sums[0] - mean_a * mean_b;
    const double c1 = kK1 * range * kK1 * range;
    const double c2 = kK2 * range * kK2 * range;
    return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
           ((mean_a * mean_a + mean_b * mean_b + c1) * (variance_a + variance_b + c2));
}

} // namespace

double structural_similarity(const FloatImage &a, const FloatImage &b, const std::vector<bool> &valid, double range)
{
    const auto width = static_cast<std::size_t>(a.width);
    const auto height = static_cast<std::size_t>(a.height);
    std::vector<Moments> moments(valid.size(), Moments{});
    for (std::size_t i = 0; i < valid.size(); i++) {
        if (valid[i]) {
            const double x = static_cast<double>(a.pixels[i]);
            const double y = static_cast<double>(b.pixels[i]);
            moments[i] = {1, x, y, x * x, y * y, x * y};
        }
    }
    std::vector<Moments> rows(valid.size(), Moments{});
    for (std::size_t y = 0; y < height; y++) {
        for (std::size_t x = kRadius; x + kRadius < width; x++) {
            rows[y * width + x] = sum_around(moments, y * width + x, 1);
        }
    }
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t y = kRadius; y + kRadius < height; y++) {
        for (std::size_t x = kRadius; x + kRadius < width; x++) {
            if (valid[y * width + x]) {
                sum += similarity_of(sum_around(rows, y * width + x, width), range);
                count++;
            }
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

} // namespace tsr
