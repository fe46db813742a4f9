/*
 * What a pair reports by itself before it sends a map: [[zone]] of site.toml
 * and scenario.toml (docs/units.md has every field).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_ZONE_H
#define TSR_HOST_ZONE_H

#include <cstddef>
#include <cstdint>
#include <string>

extern "C" {
#include "tsr/wire/body.h"
}

namespace tsr
{

struct SitePair;

inline constexpr std::size_t kZonesMax = TSR_BODY_EVENTS_MAX; /* of a pair: what one EVENT can tell of */

struct SiteRectangle { /* px of the left camera's picture */
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

enum class ZoneKind {
    below,  /* a part of the zone is nearer than depth_m */
    above,  /* a part of the zone is farther than depth_m */
    changed /* the surface in the zone has moved by depth_m since the last report */
};

struct SiteZone {
    std::string name;
    std::string pair; /* as the file names it; a scenario: of every pair, if empty. Of a pair's own zones unused */
    SiteRectangle part;
    ZoneKind kind = ZoneKind::below;
    double depth_m = 0;       /* along the left camera's axis */
    double area_percent = 10; /* of the rectangle: what makes an event; a surface: what it takes to have a depth */
    double hysteresis_percent = 50; /* of area_percent: it ends when that much less is left; not of changed */
    double every_s = 0;             /* measured so often at least; 0: only when the picture changes */
    int line = 0;                   /* in its file; 0 = built in memory */
};

/* The field that gives depth_m: below_m, above_m or changed_by_m. */
const char *zone_field(ZoneKind kind);

/* Pixels of the rectangle with which it begins, and below which it ends; at least one. */
std::uint32_t begin_pixels(const SiteZone &zone);
std::uint32_t end_pixels(const SiteZone &zone);

/* The disparity that a pixel at depth_m has, px, not rounded and without d0: docs/math.md, eq. (4) solved for d. */
double disparity_at(const SitePair &pair, double depth_m);

} // namespace tsr

#endif
