/*
 * summary.json.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>

#include "tsr/emulator/battery.h"
#include "tsr/emulator/report.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr int kSummaryFormat = 2;

/* Shorter numbers, and the same text for the same run. */
double rounded(double value, int digits)
{
    const double scale = std::pow(10.0, digits);
    return std::round(value * scale) / scale;
}

Json energy_json(const EnergyMj &energy)
{
    const auto [radio, cpu, camera, storage, board] = energy;
    return {{"radio",
             {{"transmit", rounded(radio.transmit, 3)},
              {"assess", rounded(radio.assess, 3)},
              {"acknowledge", rounded(radio.acknowledge, 3)},
              {"receive", rounded(radio.receive, 3)},
              {"sleep", rounded(radio.sleep, 3)}}},
            {"cpu", {{"run", rounded(cpu.run, 3)}, {"sleep", rounded(cpu.sleep, 3)}}},
            {"camera",
             {{"start", rounded(camera.start, 3)},
              {"expose", rounded(camera.expose, 3)},
              {"read", rounded(camera.read, 3)},
              {"standby", rounded(camera.standby, 3)}}},
            {"storage",
             {{"write", rounded(storage.write, 3)},
              {"read", rounded(storage.read, 3)},
              {"standby", rounded(storage.standby, 3)}}},
            {"board", {{"leakage", rounded(board, 3)}}},
            {"total", rounded(energy.total(), 3)}};
}

/* Life is null where nothing is drawn and nothing lost. */
Json battery_json(const SiteBattery &battery, const EnergyMj &energy, std::uint64_t duration_us)
{
    const double mean_uw = duration_us > 0 ? energy.total() / static_cast<double>(duration_us) * 1e9 : 0;
    const BatteryLife life = battery_life(battery, mean_uw);
    return {{"mean_power_uw", rounded(mean_uw, 3)},
            {"drawn_uw", rounded(life.drawn_uw, 3)},
            {"self_discharge_uw", rounded(life.self_discharge_uw, 3)},
            {"life_days", std::isfinite(life.days) ? Json(rounded(life.days, 2)) : Json()}};
}

Json error_json(const MapError &error)
{
    return {{"truth_pixels", error.truth_pixels},
            {"matched_pixels", error.matched_pixels},
            {"correct", rounded(error.correct, 4)},
            {"bad_half", rounded(error.bad_half, 4)},
            {"bad_1", rounded(error.bad_1, 4)},
            {"median_px", rounded(error.median_px, 4)},
            {"mean_px", rounded(error.mean_px, 4)},
            {"median_mm", rounded(error.median_mm, 2)},
            {"median_depth_percent", rounded(error.median_depth_percent, 3)}};
}

Json work_json(const EmulatedNode &node)
{
    Json work = Json::object();
    for (int kind = TSR_WORK_NONE + 1; kind < TSR_WORK_COUNT; ++kind) {
        const auto units = node.work_units().at(static_cast<std::size_t>(kind));
        if (units > 0) {
            const auto work_kind = static_cast<tsr_work_kind>(kind);
            work[tsr_work_name(work_kind)] = {
                {"units", units},
                {"instructions", std::llround(static_cast<double>(units) * instructions_per_unit(work_kind))}};
        }
    }
    return work;
}

Json drops_json(const EmulatedNode &node)
{
    const tsr_node_counters &counters = node.counters();
    const tsr_mac_counters &mac = node.mac_counters();
    return {{"route", counters.dropped_route},          {"format", counters.dropped_format},
            {"foreign", counters.dropped_foreign},      {"auth", counters.dropped_auth + mac.dropped_auth},
            {"replay", counters.dropped_replay},        {"frame_format", mac.dropped_format},
            {"frame_repeated", mac.dropped_replay},     {"frame_queue", mac.dropped_queue},
            {"frame_neighbour", mac.dropped_neighbour}, {"frame_unsealed", mac.unsealed},
            {"queue", counters.dropped_queue}};
}

Json node_json(const EmulatedNode &node, const AirTally &air, std::size_t maps_received, Json battery)
{
    const tsr_node_counters &counters = node.counters();
    const tsr_mac_counters &mac = node.mac_counters();
    const tsr_sender_counters &sender = node.sender_counters();
    return {{"id", node.id()},
            {"name", node.site_node().name},
            {"role", role_name(node.site_node().role)},
            {"parent", node.site_node().parent},
            {"lives", node.lives()},
            {"frames_watched", counters.frames_watched},
            {"frames_woken", counters.frames_woken},
            {"captures_failed", counters.captures_failed},
            {"wakes_sent", counters.wakes_sent},
            {"views_sent", counters.views_sent},
            {"views_lost", counters.views_lost},
            {"view_bytes", counters.view_bytes},
            {"maps_made", counters.maps_made},
            {"maps_withheld", counters.maps_withheld},
            {"maps_sent", counters.maps_sent},
            {"maps_lost", counters.maps_lost},
            {"maps_received", maps_received},
            {"map_bytes", counters.map_bytes},
            {"references_omitted", counters.references_omitted},
            {"fragments", sender.fragments},
            {"fragments_again", sender.fragments_again},
            {"forwarded", counters.forwarded},
            {"uplinks", counters.uplinks},
            {"mac",
             {{"sent", mac.sent},
              {"retries", mac.retries},
              {"unacknowledged", mac.unacknowledged},
              {"channel_busy", mac.channel_busy},
              {"received", mac.received}}},
            {"air", {{"frames", air.frames}, {"bytes", air.bytes}, {"lost", air.lost}}},
            {"dropped", drops_json(node)},
            {"energy_mj", energy_json(node.energy())},
            {"battery", std::move(battery)},
            {"work", work_json(node)},
            {"memory_bytes", node.arena_len()}};
}

std::size_t count_received(const std::vector<ReceivedMap> &maps, std::uint16_t node)
{
    return static_cast<std::size_t>(
        std::count_if(maps.begin(), maps.end(), [node](const ReceivedMap &map) { return map.node == node; }));
}

Json pair_json(const SitePair &pair, const Json &node, const std::vector<ReceivedMap> &maps)
{
    Json json{{"name", pair.name},   {"lead", pair.lead},     {"wing", pair.wing},
              {"width", pair.width}, {"height", pair.height}, {"disparities", pair.disparities}};
    for (const char *key :
         {"frames_watched", "frames_woken", "maps_made", "maps_withheld", "maps_sent", "maps_lost", "maps_received"}) {
        json[key] = node.at(key);
    }
    json["maps"] = Json::array();
    for (const ReceivedMap &map : maps) {
        if (map.node != pair.lead) {
            continue;
        }
        Json entry{{"counter", map.counter},
                   {"capture_time_s", rounded(static_cast<double>(map.capture_time_us) / 1e6, 6)},
                   {"kept", map.kept},
                   {"map_bytes", map.map_bytes},
                   {"reference_bytes", map.reference_bytes},
                   {"file", map.file + ".pfm"}};
        if (map.error) {
            entry["error"] = error_json(*map.error);
        }
        json["maps"].push_back(std::move(entry));
    }
    return json;
}

Json totals_json(const Json &nodes)
{
    Json totals = Json::object();
    for (const char *key :
         {"frames_watched", "frames_woken", "maps_made", "maps_withheld", "maps_sent", "maps_lost", "maps_received"}) {
        totals[key] = 0;
    }
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;
    double energy = 0;
    for (const Json &node : nodes) {
        for (auto &[key, value] : totals.items()) {
            value = value.get<std::uint64_t>() + node.at(key).get<std::uint64_t>();
        }
        frames += node.at("air").at("frames").get<std::uint64_t>();
        bytes += node.at("air").at("bytes").get<std::uint64_t>();
        energy += node.at("energy_mj").at("total").get<double>();
    }
    totals["air_frames"] = frames;
    totals["air_bytes"] = bytes;
    totals["energy_mj"] = rounded(energy, 3);
    return totals;
}

} // namespace

Json make_summary(const Site &site, const Simulation &simulation, const std::vector<ReceivedMap> &maps,
                  unsigned sink_restarts, double wall_time_s)
{
    Json nodes = Json::array();
    Json pairs = Json::array();
    for (std::size_t i = 0; i < simulation.nodes().size(); ++i) {
        const EmulatedNode &node = *simulation.nodes()[i];
        nodes.push_back(node_json(node, simulation.air_tally(i), count_received(maps, node.id()),
                                  battery_json(site.battery, node.energy(), simulation.duration_us())));
    }
    for (const SitePair &pair : site.pairs) {
        const auto lead = std::find_if(nodes.begin(), nodes.end(),
                                       [&](const Json &node) { return node.at("id").get<int>() == pair.lead; });
        pairs.push_back(pair_json(pair, *lead, maps));
    }
    return {{"format", kSummaryFormat},
            {"site", site.name},
            {"seed", site.seed},
            {"virtual_time_s", rounded(static_cast<double>(simulation.duration_us()) / 1e6, 6)},
            {"settled", simulation.quiet()},
            {"sink_restarts", sink_restarts},
            {"usable_battery_j", rounded(battery_life(site.battery, 0).usable_mj / 1000, 1)},
            {"faults", faults_json(simulation)},
            {"totals", totals_json(nodes)},
            {"pairs", std::move(pairs)},
            {"nodes", std::move(nodes)},
            {"wall_time_s", rounded(wall_time_s, 3)}};
}

} // namespace tsr
