/*
 * sweep.csv and the page of a sweep.
 *
 * The page (emulator/page/sweep.html) holds one mark for its data, which becomes a JSON object:
 *
 *   scenario        its name
 *   planned         runs that were asked for
 *   swept           how many of the columns, the first ones, are swept values
 *   columns, rows   the table
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/sweep_report.h"

#include "page_data.h"
#include "page_template.h"
#include "tsr/emulator/record_json.h"
#include "tsr/emulator/run_record.h"
#include "tsr/host/atomic_file.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

/* Of {count, median, p95, max}; null where nothing was counted. */
Json quantile(const Json &quantiles, const char *key)
{
    return quantiles.contains(key) ? quantiles.at(key) : Json();
}

Json mean(double sum, std::size_t count, int digits)
{
    return count > 0 ? Json(rounded(sum / static_cast<double>(count), digits)) : Json();
}

void add_events(const Json &summary, Json &figures)
{
    std::vector<double> latencies;
    for (const Json &event : summary.at("events")) {
        if (!event.at("latency_s").is_null()) {
            latencies.push_back(event.at("latency_s").get<double>());
        }
    }
    std::uint64_t lost = 0;
    for (const Json &node : summary.at("nodes")) {
        lost += node.at("events_lost").get<std::uint64_t>();
    }
    figures["events_received"] = summary.at("events").size();
    figures["events_lost"] = lost;
    figures["event_latency_s_median"] = latencies.empty() ? Json() : Json(rounded(quantiles_of(latencies).median, 6));
}

/* Means over nodes, the gateway's included. */
void add_energy(const Json &summary, Json &figures)
{
    const Json &nodes = summary.at("nodes");
    double active_mj = 0;
    double total_mj = 0;
    double power_uw = 0;
    for (const Json &node : nodes) {
        active_mj += node.at("active_mj").get<double>();
        total_mj += node.at("energy_mj").at("total").get<double>();
        power_uw += node.at("battery").at("mean_power_uw").get<double>();
    }
    figures["active_mj_per_map"] = summary.at("totals").at("active_mj_per_map");
    figures["node_active_mj"] = mean(active_mj, nodes.size(), 3);
    figures["node_energy_mj_total"] = mean(total_mj, nodes.size(), 3);
    figures["node_mean_power_uw"] = mean(power_uw, nodes.size(), 3);
    for (const char *key : {"shortest_life_days", "median_life_days"}) {
        figures[key] = summary.at("totals").at(key);
    }
}

/* Against ground truth; null without. */
void add_errors(const Json &summary, Json &figures)
{
    std::size_t maps = 0;
    std::size_t truth_pixels = 0;
    std::size_t matched_pixels = 0;
    double sum_px = 0;
    for (const Json &pair : summary.at("pairs")) {
        for (const Json &map : pair.at("maps")) {
            if (const Json &error = map.at("error"); !error.is_null()) {
                if (const Json &mean_px = error.at("mean_px"); !mean_px.is_null()) {
                    ++maps;
                    sum_px += mean_px.get<double>();
                }
                truth_pixels += error.at("truth_pixels").get<std::size_t>();
                matched_pixels += error.at("matched_pixels").get<std::size_t>();
            }
        }
    }
    const Json &totals = summary.at("totals");
    figures["error_mean_px"] = mean(sum_px, maps, 4);
    figures["error_median_px"] = quantile(totals.at("error_median_px"), "median");
    figures["error_median_mm"] = quantile(totals.at("error_median_mm"), "median");
    figures["matched"] = mean(static_cast<double>(matched_pixels), truth_pixels, 4);
    figures["correct"] = totals.at("correct_median");
}

Json figures_of(const Json &summary)
{
    const Json &totals = summary.at("totals");
    Json figures{{"stopped", summary.at("stopped")},
                 {"virtual_time_s", summary.at("virtual_time_s")},
                 {"nodes", summary.at("nodes").size()}};
    for (const char *key :
         {"frames_watched", "frames_woken", "maps_made", "maps_withheld", "maps_lost", "maps_received"}) {
        figures[key] = totals.at(key);
    }
    figures["latency_s_median"] = quantile(totals.at("latency_s"), "median");
    figures["latency_s_p95"] = quantile(totals.at("latency_s"), "p95");
    add_events(summary, figures);
    figures["air_bytes"] = totals.at("air_bytes");
    figures["air_lost"] = totals.at("air_lost");
    add_energy(summary, figures);
    add_errors(summary, figures);
    return figures;
}

/* A table's cell is a number, a word or nothing. */
Json cell_of(const Json &value)
{
    return value.is_array() ? Json(value.dump()) : value;
}

} // namespace

void add_run(SweepReport &report, const SweepPoint &point, const Json &summary, const std::string &folder)
{
    const Json figures = figures_of(summary);
    Table &table = report.table;
    if (table.columns.empty()) {
        for (const SweepAxis &axis : report.axes) {
            table.columns.push_back(axis.key);
        }
        for (const auto &[name, value] : figures.items()) {
            table.columns.push_back(name);
        }
        table.columns.push_back("folder");
    }
    std::vector<Json> &row = table.rows.emplace_back();
    for (const Json &value : point) {
        row.push_back(cell_of(value));
    }
    for (const auto &[name, value] : figures.items()) {
        row.push_back(value);
    }
    row.push_back(folder);
}

void write_sweep(const std::filesystem::path &out, const SweepReport &report)
{
    const Json data{{"scenario", report.scenario},
                    {"planned", report.planned},
                    {"swept", report.axes.size()},
                    {"columns", report.table.columns},
                    {"rows", report.table.rows}};
    write_file_atomically(out / "sweep.csv", csv_of(report.table));
    write_file_atomically(out / "index.html", filled_page(kSweepPageTemplate, data));
}

} // namespace tsr
