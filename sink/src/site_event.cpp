/* Events in metres. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/site_event.h"

#include <array>

#include <spdlog/fmt/fmt.h>

#include "tsr/sink/geometry.h"

extern "C" {
#include "tsr/wire/body.h"
}

namespace tsr
{
namespace
{

constexpr double kDisparityOne = 256; /* UQ8.8 */

std::string_view kind_name(std::uint8_t kind)
{
    constexpr std::array<std::string_view, 5> kNames = {"", "begun", "ended", "measured", "vanished"};
    return kNames.at(kind);
}

} // namespace

SiteEvent describe_event(const SitePair &pair, const StoredEvent &event)
{
    const SiteZone &zone = pair.zones.at(event.rule);
    SiteEvent described;
    described.zone = zone.name;
    described.kind = kind_name(event.kind);
    described.area_percent = 100.0 * event.share_q12 / TSR_EVENT_SHARE_ONE;
    if (event.disparity_q8 == TSR_EVENT_NO_DISPARITY) {
        return described;
    }
    const PairGeometry geometry(pair);
    const double disparity_px = event.disparity_q8 / kDisparityOne;
    described.depth_m = geometry.depth_m(disparity_px);
    const double middle_x = zone.part.x + (zone.part.width - 1) / 2.0;
    const double middle_y = zone.part.y + (zone.part.height - 1) / 2.0;
    if (const auto point = geometry.point_site(middle_x, middle_y, disparity_px)) {
        described.position_m = {point->x(), point->y(), point->z()};
    }
    return described;
}

std::string event_text(const SiteEvent &event)
{
    return fmt::format("{} in '{}': {:.0f} %{}", event.kind, event.zone, event.area_percent,
                       event.depth_m ? fmt::format(" at {:.2f} m", *event.depth_m) : "");
}

} // namespace tsr
