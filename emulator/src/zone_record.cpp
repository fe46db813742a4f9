/* Events, zone by zone. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/zone_record.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace tsr
{

namespace
{

/* The first capture of each camera that the sink has anything of. */
std::map<std::uint16_t, std::uint64_t> first_looks(const RunRecord &run)
{
    std::map<std::uint16_t, std::uint64_t> firsts;
    const auto note = [&](std::uint16_t node, std::uint64_t time_us) {
        const auto [first, is_new] = firsts.try_emplace(node, time_us);
        first->second = std::min(first->second, time_us);
    };
    for (const ReceivedMap &map : run.maps) {
        note(map.node, map.capture_time_us);
    }
    for (const ReceivedEvent &event : run.zone_events) {
        note(event.node, event.capture_time_us);
    }
    return firsts;
}

struct Told {
    std::size_t events = 0;
    bool began_first = false;
    bool ended = false;
};

} // namespace

std::vector<ZoneRecord> zone_records(const RunRecord &run)
{
    const auto firsts = first_looks(run);
    std::map<std::pair<std::uint16_t, std::string>, Told> told;
    for (const ReceivedEvent &event : run.zone_events) {
        Told &zone = told[{event.node, event.zone}];
        ++zone.events;
        zone.began_first |= event.kind == "begun" && event.capture_time_us == firsts.at(event.node);
        zone.ended |= event.kind != "begun";
    }
    std::vector<ZoneRecord> records;
    for (const SitePair &pair : run.site->pairs) {
        for (const SiteZone &zone : pair.zones) {
            const Told &of = told[{pair.lead, zone.name}];
            records.push_back({&pair, &zone, of.events, of.began_first && !of.ended});
        }
    }
    return records;
}

} // namespace tsr
