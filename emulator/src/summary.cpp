/*
 * summary.json.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <array>
#include <cmath>
#include <map>

#include "tsr/emulator/record_json.h"
#include "tsr/emulator/report.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr int kSummaryFormat = 3;
constexpr std::array kCounts = {"frames_watched", "frames_woken", "captures_failed", "maps_made",    "maps_withheld",
                                "maps_measured",  "maps_sent",    "maps_lost",       "maps_received"};

Json quantiles_json(const Quantiles &quantiles, int digits)
{
    if (quantiles.count == 0) {
        return {{"count", 0}};
    }
    return {{"count", quantiles.count},
            {"median", rounded(quantiles.median, digits)},
            {"p95", rounded(quantiles.p95, digits)},
            {"max", rounded(quantiles.max, digits)}};
}

Json days_json(double days)
{
    return std::isfinite(days) ? Json(rounded(days, 2)) : Json();
}

Json traffic_json(const RunDigest &digest)
{
    Json traffic = Json::array();
    for (const auto &[key, tally] : digest.traffic) {
        const auto &[kind, hops] = key;
        traffic.push_back({{"kind", kind < kMessageNames.size() ? kMessageNames.at(kind).name : "acknowledgement"},
                           {"hops", hops},
                           {"frames", tally.frames},
                           {"bytes", tally.bytes}});
    }
    return traffic;
}

/* Sums over the nodes. */
Json lost_by_json(const Json &nodes)
{
    Json sums = Json::object();
    for (const Json &node : nodes) {
        for (const auto &[cause, frames] : node.at("air").at("lost_by").items()) {
            sums[cause] = sums.value(cause, std::uint64_t{0}) + frames.get<std::uint64_t>();
        }
    }
    return sums;
}

/* nodes: as JSON, in the order of the records. */
Json totals_json(const RunRecord &run, const Json &nodes)
{
    Json totals = Json::object();
    for (const char *key : kCounts) {
        std::uint64_t sum = 0;
        for (const Json &node : nodes) {
            sum += node.at(key).get<std::uint64_t>();
        }
        totals[key] = sum;
    }
    AirTally air;
    double energy_mj = 0;
    for (const NodeRecord &node : run.nodes) {
        air.frames += node.air.frames;
        air.bytes += node.air.bytes;
        air.lost += node.air.lost;
        energy_mj += node.energy.total();
    }
    totals["air_frames"] = air.frames;
    totals["air_bytes"] = air.bytes;
    totals["air_lost"] = air.lost;
    totals["air_lost_by"] = lost_by_json(nodes);
    totals["energy_mj"] = rounded(energy_mj, 3);
    totals["active_mj"] = rounded(run.digest.active_mj, 3);
    totals["active_mj_per_map"] =
        run.digest.active_mj_per_map > 0 ? Json(rounded(run.digest.active_mj_per_map, 4)) : Json();
    totals["latency_s"] = quantiles_json(run.digest.latency_s, 6);
    totals["error_median_px"] = quantiles_json(run.digest.error_px, 4);
    totals["error_median_mm"] = quantiles_json(run.digest.error_mm, 2);
    totals["correct_median"] = run.digest.correct ? Json(rounded(*run.digest.correct, 4)) : Json();
    totals["shortest_life_node"] = run.digest.shortest_life;
    totals["shortest_life_days"] = days_json(run.digest.shortest_life_days);
    totals["median_life_days"] = days_json(run.digest.median_life_days);
    totals["traffic"] = traffic_json(run.digest);
    return totals;
}

Json pairs_json(const RunRecord &run, const Json &nodes)
{
    std::map<std::uint16_t, const Json *> leads;
    for (const Json &node : nodes) {
        leads[node.at("id").get<std::uint16_t>()] = &node;
    }
    std::map<std::uint16_t, Json> maps;
    for (const ReceivedMap &map : run.maps) {
        Json entry = json_of(map);
        entry.erase("node");
        maps.try_emplace(map.node, Json::array()).first->second.push_back(std::move(entry));
    }
    Json pairs = Json::array();
    for (const SitePair &pair : run.site->pairs) {
        Json json{{"name", pair.name},   {"lead", pair.lead},     {"wing", pair.wing},
                  {"width", pair.width}, {"height", pair.height}, {"disparities", pair.disparities}};
        for (const char *key : kCounts) {
            json[key] = leads.at(pair.lead)->at(key);
        }
        json["maps"] = std::move(maps.try_emplace(pair.lead, Json::array()).first->second);
        pairs.push_back(std::move(json));
    }
    return pairs;
}

const char *views_name(const Baseline &baseline)
{
    return baseline.stream ? "stream" : "changes";
}

Json baseline_json(const std::optional<Baseline> &baseline)
{
    if (!baseline) {
        return {};
    }
    return {{"views", views_name(*baseline)}, {"jpeg_quality", baseline->quality}};
}

/* No folder of the machine: the same command gives the same bytes everywhere. */
Json settings_json(const RunRecord &run)
{
    const auto &baseline = run.simulation->baseline();
    return {{"scenario", run.settings.scenario.empty() ? Json() : Json(run.settings.scenario)},
            {"seed", run.site->seed},
            {"set", run.settings.set},
            {"baseline", baseline ? Json(views_name(*baseline)) : Json()}};
}

template <typename Records> Json array_of(const Records &records)
{
    Json json = Json::array();
    for (const auto &record : records) {
        json.push_back(json_of(record));
    }
    return json;
}

} // namespace

Json make_summary(const RunRecord &run)
{
    const Site &site = *run.site;
    Json nodes = array_of(run.nodes);
    return {{"format", kSummaryFormat},
            {"site", site.name},
            {"seed", site.seed},
            {"settings", settings_json(run)},
            {"baseline", baseline_json(run.simulation->baseline())},
            {"virtual_time_s", rounded(static_cast<double>(run.simulation->duration_us()) / 1e6, 6)},
            {"stopped", run.simulation->stopped()},
            {"settled", run.simulation->quiet()},
            {"sink_restarts", run.sink_restarts},
            {"usable_battery_j", rounded(battery_life(site.battery, 0).usable_mj / 1000, 1)},
            {"faults", array_of(run.simulation->faults().notes())},
            {"totals", totals_json(run, nodes)},
            {"zones", array_of(zone_records(run))},
            {"events", array_of(run.zone_events)},
            {"pairs", pairs_json(run, nodes)},
            {"links", array_of(run.links)},
            {"nodes", std::move(nodes)},
            {"wall_time_s", rounded(run.wall_time_s, 3)}};
}

std::string summary_text(const Json &summary)
{
    return summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace tsr
