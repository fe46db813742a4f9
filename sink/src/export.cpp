/* Cloud, pictures and numbers. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/export.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tsr/host/atomic_file.h"
#include "tsr/host/colour_map.h"
#include "tsr/host/csv.h"
#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/pfm.h"
#include "tsr/host/ply.h"
#include "tsr/sink/geometry.h"
#include "tsr/sink/site_event.h"

namespace tsr
{
namespace
{

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kJsonFormat = 1;

struct NodeNumbers {
    std::uint64_t kept = 0;
    std::uint64_t dropped = 0;
    std::uint64_t map_bytes = 0;
    std::uint64_t reference_bytes = 0;
};

void make_folder(const fs::path &folder)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw InputError(folder.string(), "create", error.message());
    }
}

std::string map_name(const StoredMap &stored)
{
    return fmt::format("{:05}-{:010}", stored.node, stored.counter);
}

void export_map(const StoredMap &stored, const DecodedMap &map, const fs::path &folder)
{
    const std::string name = map_name(stored);
    const int width = map.info.width;
    const int height = map.info.height;
    write_pfm(folder / (name + ".pfm"), float_disparity(map.disparity_q4, width, height));
    write_png(folder / (name + ".png"), colour_disparity(map.disparity_q4, width, height, map.info.disparities));
    if (const auto reference = decode_reference(stored.coded_reference)) {
        write_png(folder / (name + "-reference.png"), reference->view());
    }
}

/* Points of each kept map, by node and counter. */
using PointCounts = std::map<std::pair<std::uint16_t, std::uint32_t>, std::size_t>;

struct CloudPart {
    const SitePair *pair;
    StoredMap stored;
};

/* The latest kept map of each pair, and the points of all; one that has come since the others were counted is too. */
std::pair<std::vector<CloudPart>, std::size_t> cloud_parts(const Site &site, const Store &store, PointCounts &counts)
{
    std::vector<CloudPart> parts;
    std::size_t total = 0;
    for (const SitePair &pair : site.pairs) {
        auto stored = store.last_kept(pair.lead);
        if (!stored) {
            continue;
        }
        const auto [count, is_new] = counts.try_emplace({stored->node, stored->counter}, 0);
        const auto map = is_new ? decode_map(stored->coded_map) : std::nullopt;
        count->second = map ? count_points(PairGeometry(pair), restored(*map)) : count->second;
        total += count->second;
        parts.push_back({&pair, std::move(*stored)});
    }
    return {std::move(parts), total};
}

/* One pair's points at a time: those of a thousand take more memory than all else. */
void write_cloud(const std::vector<CloudPart> &parts, std::size_t total, const fs::path &file)
{
    PlyWriter cloud(file, total);
    for (const auto &[pair, stored] : parts) {
        const auto map = decode_map(stored.coded_map);
        if (!map) {
            continue;
        }
        const auto reference = decode_reference(stored.coded_reference);
        const bool fits = reference && reference->size() == ImageSize{map->info.width, map->info.height};
        cloud.add(triangulate(PairGeometry(*pair), restored(*map), fits ? &*reference : nullptr));
    }
    cloud.complete();
}

Json node_json(const SiteNode &node, const NodeNumbers &numbers)
{
    return {{"id", node.id},
            {"name", node.name},
            {"role", role_name(node.role)},
            {"maps_received", numbers.kept + numbers.dropped},
            {"maps_kept", numbers.kept},
            {"maps_dropped", numbers.dropped},
            {"map_bytes", numbers.map_bytes},
            {"reference_bytes", numbers.reference_bytes}};
}

Json map_json(const StoredMap &stored)
{
    return {{"node", stored.node},
            {"counter", stored.counter},
            {"capture_time_us", stored.capture_time_us},
            {"kept", stored.kept},
            {"map_bytes", stored.coded_map.size()},
            {"reference_bytes", stored.coded_reference.size()},
            {"file", "maps/" + map_name(stored)}};
}

/* Written side by side: what one has, the other has. */
struct EventTables {
    Json json = Json::array();
    std::string csv = "node,pair,counter,capture_time_us,zone,kind,area_percent,depth_m,x_m,y_m,z_m\n";
};

void add_event(EventTables &tables, const SitePair &pair, const StoredEvents &message, const StoredEvent &stored)
{
    const SiteEvent event = describe_event(pair, stored);
    Json json{{"node", message.node}, {"counter", message.counter}, {"capture_time_us", message.capture_time_us},
              {"zone", event.zone},   {"kind", event.kind},         {"area_percent", event.area_percent},
              {"depth_m", nullptr},   {"position_m", nullptr}};
    std::string place = ",,,";
    if (event.depth_m && event.position_m) {
        const auto &[x, y, z] = *event.position_m;
        json["depth_m"] = *event.depth_m;
        json["position_m"] = {x, y, z};
        place = fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}", *event.depth_m, x, y, z);
    }
    tables.json.push_back(std::move(json));
    tables.csv += fmt::format("{},{},{},{},{},{},{:.2f},{}\n", message.node, csv_field(pair.name), message.counter,
                              message.capture_time_us, csv_field(event.zone), event.kind, event.area_percent, place);
}

/* Those whose zone site.toml still has. */
EventTables event_tables(const Site &site, const Store &store)
{
    EventTables tables;
    store.for_each_events([&](const StoredEvents &message) {
        const SitePair *pair = site.pair_of(message.node);
        for (const StoredEvent &event : message.events) {
            if (pair != nullptr && event.rule < pair->zones.size()) {
                add_event(tables, *pair, message, event);
            }
        }
    });
    return tables;
}

Json session_json(const SessionNumbers &session)
{
    Json refused = Json::object();
    for (std::size_t i = 0; i < static_cast<std::size_t>(Cause::cause_count); i++) {
        const auto cause = static_cast<Cause>(i);
        refused[std::string(cause_name(cause))] = session.tally.count(cause);
    }
    return {{"link",
             {{"bytes_in", session.link.bytes_in},
              {"bytes_out", session.link.bytes_out},
              {"hellos", session.link.hellos},
              {"uplinks", session.link.uplinks},
              {"repeated_uplinks", session.link.repeated_uplinks}}},
            {"repeated_messages", session.repeated_messages},
            {"refused", refused}};
}

} // namespace

ExportResult export_site(const Site &site, const Store &store, const SessionNumbers &session, const fs::path &out)
{
    const fs::path folder = out / "maps";
    make_folder(folder);
    std::map<std::uint16_t, NodeNumbers> numbers;
    NodeNumbers total;
    PointCounts counts;
    Json received = Json::array();
    store.for_each([&](const StoredMap &stored) {
        for (NodeNumbers *sum : {&numbers[stored.node], &total}) {
            (stored.kept ? sum->kept : sum->dropped)++;
            sum->map_bytes += stored.coded_map.size();
            sum->reference_bytes += stored.coded_reference.size();
        }
        if (const auto coded = decode_map(stored.coded_map)) {
            const DecodedMap map = restored(*coded);
            export_map(stored, map, folder);
            const SitePair *pair = stored.kept ? site.pair_of(stored.node) : nullptr;
            if (pair != nullptr) {
                counts[{stored.node, stored.counter}] = count_points(PairGeometry(*pair), map);
            }
        }
        received.push_back(map_json(stored));
    });
    EventTables events = event_tables(site, store);
    ExportResult result;
    result.events = events.json.size();
    result.maps = total.kept + total.dropped;
    const auto [parts, points] = cloud_parts(site, store, counts);
    result.points = points;
    write_cloud(parts, points, out / "cloud.ply");
    Json json{{"format", kJsonFormat},
              {"site", site.name},
              {"maps",
               {{"received", result.maps},
                {"kept", total.kept},
                {"dropped", total.dropped},
                {"map_bytes", total.map_bytes},
                {"reference_bytes", total.reference_bytes}}},
              {"cloud_points", result.points},
              {"received", std::move(received)},
              {"events", std::move(events.json)},
              {"nodes", Json::array()},
              {"session", session_json(session)}};
    for (const SiteNode &node : site.nodes) {
        json["nodes"].push_back(node_json(node, numbers[node.id]));
    }
    write_file_atomically(out / "events.csv", events.csv);
    write_file_atomically(out / "sink.json", json.dump(2) + "\n");
    return result;
}

} // namespace tsr
