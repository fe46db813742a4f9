/* Records as JSON. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/record_json.h"

#include <cmath>
#include <numbers>

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

double seconds(std::uint64_t time_us)
{
    return static_cast<double>(time_us) / 1e6;
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
Json battery_json(const NodeRecord &node)
{
    return {{"mean_power_uw", rounded(node.mean_uw, 3)},
            {"drawn_uw", rounded(node.life.drawn_uw, 3)},
            {"self_discharge_uw", rounded(node.life.self_discharge_uw, 3)},
            {"life_days", std::isfinite(node.life.days) ? Json(rounded(node.life.days, 2)) : Json()}};
}

Json rounded_or_null(const std::optional<double> &value, int digits)
{
    return value ? Json(rounded(*value, digits)) : Json();
}

Json error_json(const MapError &error)
{
    return {{"truth_pixels", error.truth_pixels},
            {"matched_pixels", error.matched_pixels},
            {"correct", rounded(error.correct, 4)},
            {"bad_half", rounded_or_null(error.bad_half, 4)},
            {"bad_1", rounded_or_null(error.bad_1, 4)},
            {"median_px", rounded_or_null(error.median_px, 4)},
            {"mean_px", rounded_or_null(error.mean_px, 4)},
            {"median_mm", rounded_or_null(error.median_mm, 2)},
            {"median_depth_percent", rounded_or_null(error.median_depth_percent, 3)}};
}

Json work_json(const NodeRecord &node)
{
    Json work = Json::object();
    for (int kind = TSR_WORK_NONE + 1; kind < TSR_WORK_COUNT; ++kind) {
        const auto units = node.work_units.at(static_cast<std::size_t>(kind));
        if (units > 0) {
            const auto work_kind = static_cast<tsr_work_kind>(kind);
            work[tsr_work_name(work_kind)] = {
                {"units", units},
                {"instructions", std::llround(static_cast<double>(units) * instructions_per_unit(work_kind))}};
        }
    }
    return work;
}

Json losses_json(const air::LossTally &tally)
{
    Json json = Json::object();
    for (std::size_t cause = 1; cause < tally.size(); ++cause) {
        json[air::kLossNames.at(cause)] = tally.at(cause);
    }
    return json;
}

Json drops_json(const tsr_node_counters &counters, const tsr_mac_counters &mac)
{
    return {{"route", counters.dropped_route},          {"format", counters.dropped_format},
            {"foreign", counters.dropped_foreign},      {"auth", counters.dropped_auth + mac.dropped_auth},
            {"replay", counters.dropped_replay},        {"frame_format", mac.dropped_format},
            {"frame_repeated", mac.dropped_replay},     {"frame_queue", mac.dropped_queue},
            {"frame_neighbour", mac.dropped_neighbour}, {"frame_unsealed", mac.unsealed},
            {"queue", counters.dropped_queue}};
}

Json place_json(const SiteNode &node)
{
    return {{"x_m", rounded(node.position_m[0], 3)},
            {"y_m", rounded(node.position_m[1], 3)},
            {"z_m", rounded(node.position_m[2], 3)}};
}

/* Where the pair's left camera looks: its z axis, the third column of its rotation. Null without a camera. */
Json view_json(const SitePair *pair)
{
    if (pair == nullptr) {
        return {{"azimuth_deg", Json()}, {"elevation_deg", Json()}, {"fov_deg", Json()}};
    }
    constexpr double kDegrees = 180 / std::numbers::pi;
    const auto &rotation = pair->left.rotation;
    return {{"azimuth_deg", rounded(std::atan2(rotation[5], rotation[2]) * kDegrees, 2)},
            {"elevation_deg", rounded(std::atan2(rotation[8], std::hypot(rotation[2], rotation[5])) * kDegrees, 2)},
            {"fov_deg", rounded(2 * std::atan2(pair->width / 2.0, pair->focal_px) * kDegrees, 2)}};
}

} // namespace

/* Shorter numbers, and the same text for the same run. */
double rounded(double value, int digits)
{
    const double scale = std::pow(10.0, digits);
    return std::round(value * scale) / scale + 0.0; /* -0 is 0 */
}

Json json_of(const NodeRecord &node)
{
    static const SiteNode kUnknown;
    const SiteNode &site = node.site != nullptr ? *node.site : kUnknown;
    const tsr_node_counters &counters = node.counters;
    return {{"id", site.id},
            {"name", site.name},
            {"role", role_name(site.role)},
            {"pair", node.pair != nullptr ? Json(node.pair->name) : Json()},
            {"parent", site.parent},
            {"hops", node.hops},
            {"place", place_json(site)},
            {"view", view_json(node.pair)},
            {"lives", node.lives},
            {"frames_watched", counters.frames_watched},
            {"frames_woken", counters.frames_woken},
            {"captures_failed", counters.captures_failed},
            {"wakes_sent", counters.wakes_sent},
            {"views_sent", counters.views_sent},
            {"views_lost", counters.views_lost},
            {"view_bytes", counters.view_bytes},
            {"maps_made", counters.maps_made},
            {"maps_withheld", counters.maps_withheld},
            {"maps_measured", counters.maps_measured},
            {"maps_sent", counters.maps_sent},
            {"maps_lost", counters.maps_lost},
            {"maps_received", node.maps_received},
            {"map_bytes", counters.map_bytes},
            {"references_omitted", counters.references_omitted},
            {"events_sent", counters.events_sent},
            {"events_lost", counters.events_lost},
            {"fragments", node.sender.fragments},
            {"fragments_again", node.sender.fragments_again},
            {"forwarded", counters.forwarded},
            {"uplinks", counters.uplinks},
            {"mac",
             {{"sent", node.mac.sent},
              {"retries", node.mac.retries},
              {"unacknowledged", node.mac.unacknowledged},
              {"channel_busy", node.mac.channel_busy},
              {"received", node.mac.received}}},
            {"air",
             {{"frames", node.air.frames},
              {"bytes", node.air.bytes},
              {"lost", node.air.lost},
              {"lost_by", losses_json(node.air.lost_by)}}},
            {"dropped", drops_json(counters, node.mac)},
            {"energy_mj", energy_json(node.energy)},
            {"active_mj", rounded(node.active_mj, 3)},
            {"battery", battery_json(node)},
            {"work", work_json(node)},
            {"memory_bytes", node.arena_len}};
}

Json json_of(const LinkRecord &link)
{
    const FrameTally data = link.tally.data();
    Json bytes = Json::object();
    for (std::size_t kind = 0; kind < kMessageNames.size(); ++kind) {
        bytes[kMessageNames.at(kind).name] = link.tally.kinds.at(kind).bytes;
    }
    const auto success = static_cast<double>(link.tally.received) / static_cast<double>(data.frames);
    return {{"from", link.from},
            {"to", link.to},
            {"hops", link.hops},
            {"frames", data.frames},
            {"received", link.tally.received},
            {"received_bytes", link.tally.received_bytes},
            {"lost_by", losses_json(link.tally.lost)},
            {"acknowledged", link.tally.acknowledged},
            {"acknowledgements", link.tally.acknowledgements.frames},
            {"success", data.frames > 0 ? Json(rounded(success, 4)) : Json()},
            {"bytes", data.bytes},
            {"message_bytes", std::move(bytes)},
            {"rssi_dbm", link.rssi_dbm},
            {"snr_db", link.snr_db}};
}

Json json_of(const ReceivedMap &map)
{
    const auto latency_s = map.latency_s();
    return {{"node", map.node},
            {"counter", map.counter},
            {"capture_time_s", rounded(seconds(map.capture_time_us), 6)},
            {"commit_time_s", map.commit_time_us ? Json(rounded(seconds(*map.commit_time_us), 6)) : Json()},
            {"latency_s", rounded_or_null(latency_s, 6)},
            {"kept", map.kept},
            {"map_bytes", map.map_bytes},
            {"reference_bytes", map.reference_bytes},
            {"file", map.file + map.ending},
            {"error", map.error ? error_json(*map.error) : Json()}};
}

Json json_of(const ReceivedEvent &event)
{
    const auto latency = [&] { return seconds(*event.commit_time_us) - seconds(event.capture_time_us); };
    return {{"node", event.node},
            {"zone", event.zone},
            {"kind", event.kind},
            {"capture_time_s", rounded(seconds(event.capture_time_us), 6)},
            {"latency_s", event.commit_time_us ? Json(rounded(latency(), 6)) : Json()},
            {"area_percent", rounded(event.area_percent, 2)},
            {"depth_m", event.depth_m ? Json(rounded(*event.depth_m, 4)) : Json()},
            {"true_depth_m", event.true_depth_m ? Json(rounded(*event.true_depth_m, 4)) : Json()}};
}

Json json_of(const ZoneRecord &record)
{
    const auto &[pair, zone, events, always_begun] = record;
    return {{"pair", pair->name}, {"node", pair->lead},
            {"zone", zone->name}, {zone_field(zone->kind), zone->depth_m},
            {"events", events},   {"always_begun", always_begun}};
}

Json json_of(const FaultNote &note)
{
    const SiteFault &fault = note.fault;
    Json entry{{"at_s", seconds(note.time_us)}, {"kind", fault_name(fault.kind)}};
    if (fault.node != kNodeNone) {
        entry["node"] = fault.node;
    }
    if (fault.other != kNodeNone) {
        entry["other"] = fault.other;
    }
    if (fault.for_us != 0) {
        entry["for_s"] = seconds(fault.for_us);
    }
    if (fault.kind == SiteFaultKind::clock_drift) {
        entry["ppm"] = fault.ppm;
    }
    if (fault.kind == SiteFaultKind::link_loss) {
        entry["loss_db"] = fault.loss_db;
        entry["frame_loss"] = fault.frame_loss;
    }
    if (fault.counter_start != 0) {
        entry["counter_start"] = fault.counter_start;
    }
    if (note.without_effect) {
        entry["without_effect"] = true;
    }
    return entry;
}

} // namespace tsr
