/*
 * How good a disparity map is, given the truth. With e = map - truth in px,
 * "known" the pixels whose truth is known (and that the mask admits), "valid" those of
 * them that have a value in the map:
 *
 *   correct(t) = |{ valid: |e| <= t }| / |known|
 *   bad(t)     = |{ valid: |e| > t }| / |valid|
 *   MSE        = mean of e^2 over valid
 *   PSNR       = 10 log10(L^2 / MSE)                docs/math.md, eq. (88)
 *   SSIM       = mean structural similarity         eq. (89); Z. Wang, A. Bovik, H. Sheikh,
 *                E. Simoncelli, IEEE Trans. Image Processing 13(4), 2004, eq. (13): Gaussian
 *                window of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03
 *
 * L is the dynamic range in px; by default the largest known disparity of the
 * truth. The windows of SSIM lie inside the map, as in the authors' code, and their
 * centres are valid; of a window only valid pixels count, their weights
 * scaled to the sum 1. On dense maps that is the original.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STEREO_MAP_QUALITY_H
#define TSR_STEREO_MAP_QUALITY_H

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tsr/host/pfm.h"

namespace tsr
{

inline constexpr std::array<double, 3> kQualityThresholds = {0.5, 1, 2}; /* px */

/* What has no value (nothing valid, no window) is not a number. */
struct MapQuality {
    std::size_t known = 0;
    std::size_t valid = 0;
    std::array<double, kQualityThresholds.size()> correct = {};
    std::array<double, kQualityThresholds.size()> bad = {};
    double median_error_px = 0; /* of |e| */
    double mean_error_px = 0;   /* of |e| */
    double mse_px2 = 0;
    double range_px = 0; /* L */
    double psnr_db = 0;  /* infinite for equal maps */
    double ssim = 0;

    double density() const { return static_cast<double>(valid) / static_cast<double>(known); }
};

/* map, truth and admitted (a value for each pixel, true to judge it; empty
 * admits all) have one size; kFloatInvalid marks what is unknown. At least one
 * pixel is known. */
MapQuality judge_map(const FloatImage &map, const FloatImage &truth, const std::vector<bool> &admitted,
                     std::optional<double> range_px = std::nullopt);

/* Pixels that judge_map would count as known. */
std::size_t count_known(const FloatImage &truth, const std::vector<bool> &admitted);

} // namespace tsr

#endif
