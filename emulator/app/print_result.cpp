/* A run in a few lines. SPDX-License-Identifier: Apache-2.0 */
#include "print_result.h"

#include <cstdio>
#include <vector>

#include "tsr/emulator/run_record.h"

namespace tsr::app
{

namespace
{

constexpr std::size_t kPairsPrinted = 20; /* one by one; more are summed up */
constexpr std::size_t kZonesPrinted = 4;
constexpr double kLateToldS = 0.2; /* less is how exactly a machine sleeps and draws a frame */

void print_counts(const char *name, const nlohmann::ordered_json &counts)
{
    const auto count = [&](const char *key) { return counts.at(key).get<int>(); };
    std::printf(
        "%s: frames watched %d, woken %d; maps made %d, withheld %d, for zones alone %d, sent %d, given up %d; the "
        "sink has %d\n",
        name, count("frames_watched"), count("frames_woken"), count("maps_made"), count("maps_withheld"),
        count("maps_measured"), count("maps_sent"), count("maps_lost"), count("maps_received"));
}

/* Of one figure of the maps that were compared with truth. */
Quantiles errors_of(const nlohmann::ordered_json &maps, const char *figure)
{
    std::vector<double> values;
    for (const auto &map : maps) {
        if (map.at("error").is_object() && map.at("error").at(figure).is_number()) {
            values.push_back(map.at("error").at(figure).get<double>());
        }
    }
    return quantiles_of(values);
}

/* One line, however many there are. */
void print_errors(const nlohmann::ordered_json &maps)
{
    const Quantiles px = errors_of(maps, "median_px");
    if (px.count > 0) {
        std::printf("  %zu %s against truth: median error %.3f px, ", px.count, px.count == 1 ? "map" : "maps, medians",
                    px.median);
        if (const Quantiles mm = errors_of(maps, "median_mm"); mm.count > 0) {
            std::printf("%.1f mm; ", mm.median);
        }
        std::printf("%.1f %% of the pixels correct\n", 100 * errors_of(maps, "correct").median);
    }
}

/* They would never tell of anything, and nothing else shows it. */
void print_stuck_zones(const nlohmann::ordered_json &zones)
{
    std::size_t stuck = 0;
    for (const auto &zone : zones) {
        if (zone.at("always_begun").get<bool>() && ++stuck <= kZonesPrinted) {
            std::printf("zone '%s' of '%s' began at the first look and never ended: what always stands there is beyond "
                        "its limit\n",
                        zone.at("zone").get<std::string>().c_str(), zone.at("pair").get<std::string>().c_str());
        }
    }
    if (stuck > kZonesPrinted) {
        std::printf("and %zu zones more like these\n", stuck - kZonesPrinted);
    }
}

} // namespace

void print_result(const std::filesystem::path &out, const RunOutcome &outcome)
{
    const auto &summary = outcome.summary;
    const auto &pairs = summary.at("pairs");
    if (pairs.size() > kPairsPrinted) {
        print_counts((std::to_string(pairs.size()) + " pairs").c_str(), summary.at("totals"));
    } else {
        for (const auto &pair : pairs) {
            print_counts(pair.at("name").get<std::string>().c_str(), pair);
            print_errors(pair.at("maps"));
        }
    }
    print_stuck_zones(summary.at("zones"));
    if (const auto &baseline = summary.at("baseline"); !baseline.is_null()) {
        std::printf(
            "a baseline: in the place of maps both views, as JPEG of quality %d; %d captures failed, by their camera "
            "or for want of room in a message\n",
            baseline.at("jpeg_quality").get<int>(), summary.at("totals").at("captures_failed").get<int>());
    }
    std::printf("%.1f s of virtual time in %.1f s; results in %s, look at %s\n",
                summary.at("virtual_time_s").get<double>(), summary.at("wall_time_s").get<double>(), out.c_str(),
                (out / "index.html").c_str());
    print_lateness(outcome.late);
}

void print_left_out(const Options &options, bool has_zones)
{
    if (has_zones && baseline_of(options)) {
        std::printf("a baseline: zones are left out, for they are measured in maps\n");
    }
}

void print_lateness(const Lateness &late)
{
    if (late.worst_s > kLateToldS) {
        std::printf("the machine did not keep up with --speed: %.1f s late at worst, %.1f s at the end\n", late.worst_s,
                    late.end_s);
    }
}

} // namespace tsr::app
