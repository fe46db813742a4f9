/* [[zone]] tables. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/zone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "site_faults.h"
#include "tsr/host/site_fields.h"

namespace tsr
{
namespace
{

constexpr int kSideMax = 640; /* the widest picture; the pair's own is checked later */
constexpr double kDepthMaxM = 1e5;
constexpr double kEveryMaxS = 3600;
constexpr double kChangeMaxM = 65.535;     /* mm in 16 bits */
constexpr double kScaleMax = 16'777'215.0; /* f B, px mm, with 8 fraction bits in 32 */

struct Kind {
    ZoneKind kind;
    const char *field;
    double maximum;
};

constexpr std::array kKinds = {Kind{ZoneKind::below, "below_m", kDepthMaxM},
                               Kind{ZoneKind::above, "above_m", kDepthMaxM},
                               Kind{ZoneKind::changed, "changed_by_m", kChangeMaxM}};

void read_kind(TomlFields &fields, SiteZone &zone)
{
    const auto given =
        std::count_if(kKinds.begin(), kKinds.end(), [&](const Kind &kind) { return fields.has(kind.field); });
    if (given != 1) {
        fields.refuse("below_m",
                      given == 0
                          ? "is missing, and so are above_m and changed_by_m"
                          : "stands with above_m or changed_by_m, or these two together: a zone has one of them");
    }
    for (const Kind &kind : kKinds) {
        if (fields.has(kind.field)) {
            zone.kind = kind.kind;
            zone.depth_m = fields.number(kind.field, 0.001, kind.maximum);
        }
    }
}

SiteZone read_zone(TomlFields &fields, bool of_any_pair)
{
    SiteZone zone;
    zone.line = fields.line();
    zone.name = fields.string("name");
    fields.set_prefix("zone '" + zone.name + "'");
    zone.pair = of_any_pair ? fields.string("pair", "") : fields.string("pair");
    std::array<double, 4> part{};
    fields.numbers("rectangle", part.data(), part.size(), true);
    for (const double value : part) {
        if (!(value >= 0 && value <= kSideMax) || value != std::floor(value)) {
            fields.refuse("rectangle", "is not x, y, width, height in whole px");
        }
    }
    zone.part = {static_cast<int>(part[0]), static_cast<int>(part[1]), static_cast<int>(part[2]),
                 static_cast<int>(part[3])};
    read_kind(fields, zone);
    zone.area_percent = fields.number("area_percent", 0.01, 100, zone.area_percent);
    if (zone.kind != ZoneKind::changed) {
        zone.hysteresis_percent = fields.number("hysteresis_percent", 0, 99, zone.hysteresis_percent);
    } else if (fields.has("hysteresis_percent")) {
        fields.refuse("hysteresis_percent", "does not belong to changed_by_m: it counts from the last report");
    }
    zone.every_s = fields.number("every_s", 0, kEveryMaxS, zone.every_s);
    fields.refuse_unknown();
    return zone;
}

[[noreturn]] void refuse_zone(const Site &site, const SiteZone &zone, const std::string &field,
                              const std::string &reason)
{
    refuse_site(site, zone.line, "zone '" + zone.name + "': " + field, reason);
}

/* Limits that no disparity of the pair reaches would never make an event. */
void check_depth(const Site &site, const SitePair &pair, const SiteZone &zone)
{
    const double scale = pair.focal_px * pair.baseline_mm;
    if (zone.kind == ZoneKind::changed) {
        if (!(zone.depth_m >= 0.001 && zone.depth_m <= kChangeMaxM)) {
            refuse_zone(site, zone, "changed_by_m", "is outside 0.001..65.535");
        }
        if (scale > kScaleMax) {
            refuse_zone(site, zone, "pair",
                        "focal_px times baseline_mm is above 16777215, more than a node reckons with");
        }
        return;
    }
    const double disparity_px = disparity_at(pair, zone.depth_m);
    if (zone.kind == ZoneKind::below && !(disparity_px <= pair.disparities - 1)) {
        refuse_zone(site, zone, "below_m",
                    "is nearer than the pair's " + std::to_string(pair.disparities) + " disparities reach");
    }
    if (zone.kind == ZoneKind::above && !(disparity_px > 0)) {
        refuse_zone(site, zone, "above_m", "is farther than the pair's first disparity");
    }
}

void check_zone(const Site &site, const SitePair &pair, const SiteZone &zone)
{
    if (const std::string fault = fault_in_rectangle(zone.part, pair); !fault.empty()) {
        refuse_zone(site, zone, "rectangle", fault);
    }
    if (!(zone.area_percent > 0 && zone.area_percent <= 100)) {
        refuse_zone(site, zone, "area_percent", "is outside 0..100");
    }
    if (!(zone.hysteresis_percent >= 0 && zone.hysteresis_percent < 100)) {
        refuse_zone(site, zone, "hysteresis_percent", "is outside 0..99");
    }
    if (!(zone.every_s >= 0 && zone.every_s <= kEveryMaxS)) {
        refuse_zone(site, zone, "every_s", "is outside 0..3600");
    }
    check_depth(site, pair, zone);
}

std::uint32_t pixels_of(const SiteZone &zone, double percent)
{
    const double pixels = std::ceil(zone.part.width * zone.part.height * percent / 100);
    return static_cast<std::uint32_t>(std::max(1.0, pixels));
}

} // namespace

std::vector<SiteZone> read_zones(TomlFields &top, bool of_any_pair)
{
    std::vector<SiteZone> zones;
    for (TomlFields &fields : top.tables("zone")) {
        zones.push_back(read_zone(fields, of_any_pair));
    }
    return zones;
}

void place_zones(Site &site, const std::vector<SiteZone> &zones)
{
    for (const SiteZone &zone : zones) {
        bool placed = false;
        for (SitePair &pair : site.pairs) {
            if (zone.pair.empty() || zone.pair == pair.name) {
                pair.zones.push_back(zone);
                placed = true;
            }
        }
        if (!placed) {
            refuse_zone(site, zone, "pair", "there is no pair '" + zone.pair + "'");
        }
    }
}

void check_zones(const Site &site)
{
    for (const SitePair &pair : site.pairs) {
        if (pair.zones.size() > kZonesMax) {
            refuse_zone(site, pair.zones[kZonesMax], "pair",
                        "'" + pair.name + "' has " + std::to_string(pair.zones.size()) + " zones, not at most " +
                            std::to_string(kZonesMax));
        }
        for (std::size_t i = 0; i < pair.zones.size(); i++) {
            const SiteZone &zone = pair.zones[i];
            if (const std::string fault = fault_in_name(zone.name); !fault.empty()) {
                refuse_zone(site, zone, "name", fault);
            }
            if (std::any_of(pair.zones.begin(), pair.zones.begin() + static_cast<std::ptrdiff_t>(i),
                            [&](const SiteZone &other) { return other.name == zone.name; })) {
                refuse_zone(site, zone, "name", "is used twice for pair '" + pair.name + "'");
            }
            check_zone(site, pair, zone);
        }
    }
}

const char *zone_field(ZoneKind kind)
{
    return std::find_if(kKinds.begin(), kKinds.end(), [kind](const Kind &known) { return known.kind == kind; })->field;
}

std::uint32_t begin_pixels(const SiteZone &zone)
{
    return pixels_of(zone, zone.area_percent);
}

std::uint32_t end_pixels(const SiteZone &zone)
{
    return pixels_of(zone, zone.area_percent * (100 - zone.hysteresis_percent) / 100);
}

double disparity_at(const SitePair &pair, double depth_m)
{
    return pair.focal_px * pair.baseline_mm / (1000 * depth_m) - pair.d0_px;
}

} // namespace tsr
