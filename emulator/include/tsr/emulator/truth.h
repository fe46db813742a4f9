/*
 * Maps against ground truth.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_TRUTH_H
#define TSR_EMULATOR_TRUTH_H

#include <cstddef>
#include <filesystem>
#include <optional>

#include "tsr/host/pfm.h"
#include "tsr/host/site.h"

namespace tsr
{

struct MapError {
    std::size_t truth_pixels = 0;   /* with ground truth; above 0 */
    std::size_t matched_pixels = 0; /* of these, valid in the map */
    double correct = 0;             /* within 1 px, over all pixels with truth */
    /* Over matched pixels; none where there are none. */
    std::optional<double> bad_half;  /* more than 0.5 px wrong */
    std::optional<double> bad_1;     /* more than 1 px wrong */
    std::optional<double> median_px; /* median |disparity error| */
    std::optional<double> mean_px;
    /* Median |depth error|, Z = f B / (d + d0), and the same of the true depth; none where no pixel has both depths. */
    std::optional<double> median_mm;
    std::optional<double> median_depth_percent;
};

/* Nothing if no pixel has a truth. Throws InputError if the two differ in size. name stands for the
 * truth in errors. */
std::optional<MapError> compare_with_truth(const FloatImage &map, const FloatImage &truth, const SitePair &pair,
                                           const std::filesystem::path &name);

} // namespace tsr

#endif
