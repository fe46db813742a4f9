/* What was true when a surface was measured. SPDX-License-Identifier: Apache-2.0 */
#include <algorithm>

#include "tsr/emulator/run_record.h"
#include "tsr/scenario/zone_truth.h"

namespace tsr
{

namespace
{

std::optional<double> true_depth_m(const Site &site, Pictures &pictures, const ReceivedEvent &event)
{
    const SitePair *pair = site.pair_of(event.node);
    if (pair == nullptr) {
        return std::nullopt;
    }
    const auto zone = std::find_if(pair->zones.begin(), pair->zones.end(),
                                   [&](const SiteZone &one) { return one.name == event.zone; });
    if (zone == pair->zones.end() || zone->kind != ZoneKind::changed) {
        return std::nullopt;
    }
    const auto truth = pictures.truth(*pair, event.capture_time_us);
    return truth ? zone_truth(*pair, *zone, truth->disparity_px).depth_m : std::nullopt;
}

} // namespace

void find_true_depths(const Site &site, Pictures &pictures, std::vector<ReceivedEvent> &events)
{
    const std::size_t step = (events.size() + kTrueDepthsMax - 1) / kTrueDepthsMax;
    for (std::size_t i = 0; i < events.size(); i += step) {
        if (events[i].depth_m) {
            events[i].true_depth_m = true_depth_m(site, pictures, events[i]);
        }
    }
}

} // namespace tsr
