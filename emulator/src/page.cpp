/*
 * index.html: the page with the run's data put in.
 *
 * The page (emulator/page/) holds one mark for its data, which becomes a JSON object:
 *
 *   summary   summary.json without nodes, pairs, links and events of zones, and with zones that are always_begun alone
 *   played_s  how long there was something to see
 *   nodes, links, maps   {of, columns, rows}: the tables of table.h; of: rows before they were thinned
 *   timeline  {bin_s, looks, woken, committed, withheld, lost, failed}: numbers of each bin
 *   episodes  {of, rows: [[node, from s, until s, fate], ...]}
 *   phases    [[s, node, phase], ...] of work; empty if there are many
 *   messages  {of, rows: [[s, node, kind], ...]}: committed ones that are no maps
 *   events    [[s, what], ...] that the scene tells
 *   zone_events  {of, rows: [[s, node, zone, kind, depth m, area %, latency s, true depth m], ...], newest}: oldest
 *             first; newest: the last ones, of all
 *   faults_of, faults_by_kind  how many came, also by their kind: summary.faults is thinned
 *   gallery   [{pair, why, numbers, size, zones, left, right, reference, map, truth, error}, ...]: numbers as in
 *             summary.json; size [width, height] and zones [[name, x, y, width, height], ...] of the left picture, px;
 *             data URLs or "", left and right are a baseline's
 *   gallery_of  how many were chosen: the last ones may not fit
 *   cloud     {of, count, low, step, positions, colours}: base64 of count x 3 uint16 and count x 3 bytes;
 *             position = low + step * value, m
 *   last_pair_share  of the cloud's points, those of the last pair: they are the last
 *
 * Lists are thinned evenly to what the limits below say, so that the page stays below 5 MB whatever was run;
 * summary.json and the CSV tables have everything.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>
#include <span>

#include "page_data.h"
#include "page_template.h"
#include "tsr/emulator/record_json.h"
#include "tsr/emulator/report.h"
#include "tsr/emulator/table.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/read_file.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t kNodesMax = 2000;
constexpr std::size_t kLinksMax = 4000;
constexpr std::size_t kMapsMax = 3000;
constexpr std::size_t kEpisodesMax = 5000;
constexpr std::size_t kPhasesMax = 8000;
constexpr std::size_t kMessagesMax = 3000;
constexpr std::size_t kZoneEventsMax = 3000;
constexpr std::size_t kNewestMax = 300;
constexpr std::size_t kEventsMax = 500;
constexpr std::size_t kBinsMax = 240;
constexpr std::size_t kGalleryBytesMax = 1'600'000; /* as base64 */

double seconds(std::uint64_t time_us)
{
    return std::round(static_cast<double>(time_us) / 1e3) / 1e3;
}

/* Every n-th, so that at most as many are left. */
template <typename Rows, typename Print> Json thinned(const Rows &rows, std::size_t most, const Print &print)
{
    const std::size_t step = rows.size() > most ? (rows.size() + most - 1) / most : 1;
    Json json = Json::array();
    for (std::size_t i = 0; i < rows.size(); i += step) {
        json.push_back(print(rows[i]));
    }
    return json;
}

Json table_json(const Table &table, std::size_t most)
{
    return {{"of", table.rows.size()},
            {"columns", table.columns},
            {"rows", thinned(table.rows, most, [](const auto &row) { return Json(row); })}};
}

std::size_t bin_s(std::uint64_t end_us)
{
    std::size_t width_s = 1;
    for (const std::size_t factor : {2u, 5u, 10u, 15u, 30u, 60u, 120u, 300u, 600u, 900u, 1800u, 3600u}) {
        if (end_us / 1'000'000 / width_s >= kBinsMax) {
            width_s = factor;
        }
    }
    while (end_us / 1'000'000 / width_s >= kBinsMax) {
        width_s *= 2;
    }
    return width_s;
}

Json timeline_json(const RunRecord &run)
{
    const std::size_t width_s = bin_s(run.simulation->duration_us());
    const std::size_t count = run.simulation->duration_us() / 1'000'000 / width_s + 1;
    const auto bin_of = [&](std::uint64_t time_us) { return std::min(time_us / 1'000'000 / width_s, count - 1); };
    std::vector<std::uint64_t> looks(count);
    std::vector<std::uint64_t> woken(count);
    std::map<Fate, std::vector<std::uint64_t>> fates;
    for (const Fate fate : {Fate::committed, Fate::withheld, Fate::measured, Fate::lost, Fate::failed}) {
        fates[fate].resize(count);
    }
    for (std::size_t second = 0; second < run.simulation->looks_per_s().size(); ++second) {
        looks[bin_of(second * 1'000'000)] += run.simulation->looks_per_s()[second];
    }
    for (const Episode &episode : run.episodes) {
        woken[bin_of(episode.from_us)] += episode.fate == Fate::view ? 0 : 1;
        if (fates.contains(episode.fate)) {
            ++fates[episode.fate][bin_of(episode.until_us)];
        }
    }
    Json json{{"bin_s", width_s}, {"looks", looks}, {"woken", woken}};
    for (const auto &[fate, numbers] : fates) {
        json[fate_name(fate)] = numbers;
    }
    return json;
}

Json episodes_json(const RunRecord &run)
{
    const auto print = [](const Episode &episode) {
        return Json::array(
            {episode.node, seconds(episode.from_us), seconds(episode.until_us), fate_name(episode.fate)});
    };
    return {{"of", run.episodes.size()}, {"rows", thinned(run.episodes, kEpisodesMax, print)}};
}

/* What leads to a map or a view, with the rest that ends it. */
Json phases_json(const RunRecord &run)
{
    Json json = Json::array();
    for (const PhaseChange &change : run.simulation->timeline()) {
        if (std::max(change.phase, change.before) > TSR_PHASE_WATCHING) {
            json.push_back(Json::array({seconds(change.time_us), change.node, tsr_phase_name(change.phase)}));
        }
    }
    return json.size() <= kPhasesMax ? json : Json::array();
}

Json messages_json(const RunRecord &run)
{
    std::vector<Commit> others;
    for (const Commit &commit : run.simulation->traffic().commits()) {
        if (commit.kind != message_index(TSR_MESSAGE_MAP)) {
            others.push_back(commit);
        }
    }
    const auto print = [](const Commit &commit) {
        return Json::array({seconds(commit.time_us), commit.node, kMessageNames.at(commit.kind).name});
    };
    return {{"of", others.size()}, {"rows", thinned(others, kMessagesMax, print)}};
}

Json events_json(const RunRecord &run)
{
    return thinned(run.events, kEventsMax, [](const SceneEvent &event) {
        return Json::array({seconds(event.time_us), event.what});
    });
}

Json zone_events_json(const RunRecord &run)
{
    const auto print = [](const ReceivedEvent &event) {
        const Json json = json_of(event);
        Json row = Json::array();
        for (const char *key :
             {"capture_time_s", "node", "zone", "kind", "depth_m", "area_percent", "latency_s", "true_depth_m"}) {
            row.push_back(json.at(key));
        }
        return row;
    };
    const std::size_t newest = std::min(run.zone_events.size(), kNewestMax);
    const std::span<const ReceivedEvent> all(run.zone_events);
    return {{"of", run.zone_events.size()},
            {"rows", thinned(run.zone_events, kZoneEventsMax, print)},
            {"newest", thinned(all.last(newest), kNewestMax, print)}};
}

Json zones_json(const SitePair *pair)
{
    Json json = Json::array();
    for (const SiteZone &zone : pair != nullptr ? pair->zones : std::vector<SiteZone>{}) {
        json.push_back(Json::array({zone.name, zone.part.x, zone.part.y, zone.part.width, zone.part.height}));
    }
    return json;
}

std::string picture_url(const std::filesystem::path &file)
{
    const std::string type = file.extension() == ".jpg" ? "jpeg" : "png";
    return std::filesystem::exists(file) ? "data:image/" + type + ";base64," + base64(read_file(file)) : std::string();
}

/* As many as fit, in the order of the choice. */
Json gallery_json(const std::filesystem::path &out, const std::vector<GalleryMap> &gallery)
{
    Json json = Json::array();
    std::size_t bytes = 0;
    for (const GalleryMap &shown : gallery) {
        const std::string file = (out / shown.map->file).string();
        Json entry{{"pair", shown.pair != nullptr ? shown.pair->name : ""},
                   {"why", shown.why},
                   {"numbers", json_of(*shown.map)},
                   {"size", shown.pair != nullptr ? Json::array({shown.pair->width, shown.pair->height}) : Json()},
                   {"zones", zones_json(shown.pair)},
                   {"left", picture_url(file + "-left.jpg")},
                   {"right", picture_url(file + "-right.jpg")},
                   {"reference", picture_url(file + "-reference.png")},
                   {"map", picture_url(file + ".png")},
                   {"truth", picture_url(file + "-truth.png")},
                   {"error", picture_url(file + "-error.png")}};
        for (const char *key : {"left", "right", "reference", "map", "truth", "error"}) {
            bytes += entry.at(key).get_ref<const std::string &>().size();
        }
        if (bytes > kGalleryBytesMax) {
            break;
        }
        json.push_back(std::move(entry));
    }
    return json;
}

/* Where every pixel is a point, as in the demo. */
double last_pair_share(const Site &site)
{
    if (site.pairs.empty()) {
        return 0;
    }
    double all = 0;
    for (const SitePair &pair : site.pairs) {
        all += static_cast<double>(pair.width) * pair.height;
    }
    return static_cast<double>(site.pairs.back().width) * site.pairs.back().height / all;
}

Json faults_by_kind(const Json &faults)
{
    Json counts = Json::object();
    for (const Json &fault : faults) {
        Json &count = counts[fault.at("kind").get<std::string>()];
        count = count.is_null() ? 1 : count.get<int>() + 1;
    }
    return counts;
}

Json summary_head(Json summary)
{
    for (const char *key : {"nodes", "pairs", "links", "events"}) {
        summary.erase(key);
    }
    Json &zones = summary.at("zones");
    zones.erase(std::remove_if(zones.begin(), zones.end(),
                               [](const Json &zone) { return !zone.at("always_begun").get<bool>(); }),
                zones.end());
    Json &faults = summary.at("faults");
    faults = thinned(faults, kEventsMax, [](const Json &fault) { return fault; });
    return summary;
}

} // namespace

void write_page(const std::filesystem::path &out, const Json &summary, const RunRecord &run,
                const std::vector<GalleryMap> &gallery)
{
    const Json data{{"summary", summary_head(summary)},
                    {"played_s", seconds(run.simulation->played_us())},
                    {"nodes", table_json(nodes_table(run), kNodesMax)},
                    {"links", table_json(links_table(run), kLinksMax)},
                    {"maps", table_json(maps_table(run), kMapsMax)},
                    {"timeline", timeline_json(run)},
                    {"episodes", episodes_json(run)},
                    {"phases", phases_json(run)},
                    {"messages", messages_json(run)},
                    {"events", events_json(run)},
                    {"zone_events", zone_events_json(run)},
                    {"faults_of", summary.at("faults").size()},
                    {"faults_by_kind", faults_by_kind(summary.at("faults"))},
                    {"gallery", gallery_json(out, gallery)},
                    {"gallery_of", gallery.size()},
                    {"cloud", cloud_json(out / "cloud.ply")},
                    {"last_pair_share", last_pair_share(*run.site)}};
    write_file_atomically(out / "index.html", filled_page(kPageTemplate, data));
}

void write_tables(const std::filesystem::path &out, const RunRecord &run)
{
    write_file_atomically(out / "nodes.csv", csv_of(nodes_table(run)));
    write_file_atomically(out / "links.csv", csv_of(links_table(run)));
    write_file_atomically(out / "maps.csv", csv_of(maps_table(run)));
}

} // namespace tsr
