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

/* From the first waking of each camera to its rest. */
std::map<std::uint16_t, Episode> first_looks(const RunRecord &run)
{
    std::map<std::uint16_t, Episode> firsts;
    for (const Episode &episode : run.episodes) {
        const auto [first, is_new] = firsts.try_emplace(episode.node, episode);
        if (episode.from_us < first->second.from_us) {
            first->second = episode;
        }
    }
    return firsts;
}

bool is_within(const ReceivedEvent &event, const std::map<std::uint16_t, Episode> &looks)
{
    const auto look = looks.find(event.node);
    return look != looks.end() && event.capture_time_us <= look->second.until_us;
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
        zone.began_first |= event.kind == "begun" && is_within(event, firsts);
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
