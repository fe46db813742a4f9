/*
 * What is true of a zone.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_ZONE_TRUTH_H
#define TSR_SCENARIO_ZONE_TRUTH_H

#include <optional>

#include "tsr/host/pfm.h"
#include "tsr/host/site.h"

namespace tsr
{

struct ZoneTruth {
    /* Of the zone's pixels, those whose true depth is below or above its limit; of a surface, those within 1 px of the
     * median; 0 .. 1. */
    double share = 0;
    std::optional<double> depth_m; /* at the mean of their disparities, as a node has it; nothing if there are none */
};

/* truth: disparity of the pair's left view, px, kFloatInvalid: the sky. The zone is inside. */
ZoneTruth zone_truth(const SitePair &pair, const SiteZone &zone, const FloatImage &truth);

} // namespace tsr

#endif
