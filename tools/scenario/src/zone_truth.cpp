/* Zones in the true disparity. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/scenario/zone_truth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace tsr
{

namespace
{

constexpr double kBandPx = 1;

/* Those that count are moved to the front. */
std::size_t count(const SitePair &pair, const SiteZone &zone, std::vector<double> &disparities)
{
    double low = -1e9, high = 1e9;
    if (zone.kind == ZoneKind::changed) {
        const auto middle = disparities.begin() + static_cast<std::ptrdiff_t>((disparities.size() - 1) / 2);
        std::nth_element(disparities.begin(), middle, disparities.end());
        low = *middle - kBandPx;
        high = *middle + kBandPx;
    } else {
        (zone.kind == ZoneKind::below ? low : high) = disparity_at(pair, zone.depth_m);
    }
    const auto end =
        std::partition(disparities.begin(), disparities.end(), [&](double d) { return d >= low && d <= high; });
    return static_cast<std::size_t>(end - disparities.begin());
}

} // namespace

ZoneTruth zone_truth(const SitePair &pair, const SiteZone &zone, const FloatImage &truth)
{
    std::vector<double> disparities;
    for (int y = zone.part.y; y < zone.part.y + zone.part.height; y++) {
        for (int x = zone.part.x; x < zone.part.x + zone.part.width; x++) {
            const double d = static_cast<double>(truth.pixels[static_cast<std::size_t>(y * truth.width + x)]);
            disparities.push_back(std::isfinite(d) ? d : -pair.d0_px); /* the sky is infinitely far */
        }
    }
    const std::size_t counted = count(pair, zone, disparities);
    const auto end = disparities.begin() + static_cast<std::ptrdiff_t>(counted);
    const double sum = std::accumulate(disparities.begin(), end, 0.0);
    ZoneTruth result;
    result.share = static_cast<double>(counted) / static_cast<double>(disparities.size());
    const double divisor = counted > 0 ? sum / static_cast<double>(counted) + pair.d0_px : 0;
    if (divisor > 0) {
        result.depth_m = pair.focal_px * pair.baseline_mm / 1000 / divisor;
    }
    return result;
}

} // namespace tsr
