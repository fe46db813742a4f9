/*
 * An event of a depth rule as a site's operator reads it: in metres, by name.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_SITE_EVENT_H
#define TSR_SINK_SITE_EVENT_H

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "tsr/host/site.h"
#include "tsr/sink/store.h"

namespace tsr
{

struct SiteEvent {
    std::string_view zone;         /* its name, of the site given */
    std::string_view kind;         /* begun, ended, measured, vanished */
    double area_percent = 0;       /* of the zone: pixels that count */
    std::optional<double> depth_m; /* their mean disparity's, along the left camera's axis; none: no pixel counts */
    std::optional<std::array<double, 3>> position_m; /* at that depth behind the zone's middle, site axes */
};

/* event is one that the pair can have sent (the store has no others). */
SiteEvent describe_event(const SitePair &pair, const StoredEvent &event);

/* "begun in 'door': 34 % at 1.82 m" */
std::string event_text(const SiteEvent &event);

} // namespace tsr

#endif
