/*
 * What is true of a scenario's zones at every look of their nodes:
 * scene_zones SCENARIO.toml [TABLE.FIELD=VALUE]...
 *
 * Prints CSV, one line per pair, zone and look:
 *
 *   share    of the zone's pixels, those whose true depth is below or above the zone's limit; of a surface,
 *            those within 1 px of the median
 *   depth_m  at the mean of their disparities, as a node has it; empty if there are none
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tsr/host/input_error.h"
#include "tsr/scenario/virtual_camera.h"

namespace
{

constexpr double kBandPx = 1;

/* Of all of the zone's pixels; those that count are moved to the front. */
std::size_t count(const tsr::SitePair &pair, const tsr::SiteZone &zone, std::vector<double> &disparities)
{
    double low = -1e9, high = 1e9;
    if (zone.kind == tsr::ZoneKind::changed) {
        const auto middle = disparities.begin() + static_cast<std::ptrdiff_t>((disparities.size() - 1) / 2);
        std::nth_element(disparities.begin(), middle, disparities.end());
        low = *middle - kBandPx;
        high = *middle + kBandPx;
    } else {
        (zone.kind == tsr::ZoneKind::below ? low : high) = tsr::disparity_at(pair, zone.depth_m);
    }
    const auto end =
        std::partition(disparities.begin(), disparities.end(), [&](double d) { return d >= low && d <= high; });
    return static_cast<std::size_t>(end - disparities.begin());
}

void print_look(const tsr::SitePair &pair, const tsr::SiteZone &zone, std::uint64_t time_us,
                const tsr::FloatImage &truth)
{
    std::vector<double> disparities;
    for (int y = zone.part.y; y < zone.part.y + zone.part.height; y++) {
        for (int x = zone.part.x; x < zone.part.x + zone.part.width; x++) {
            const double d = static_cast<double>(truth.pixels[static_cast<std::size_t>(y * truth.width + x)]);
            disparities.push_back(std::isfinite(d) ? d : -pair.d0_px); /* the sky is infinitely far */
        }
    }
    const std::size_t counted = count(pair, zone, disparities);
    double sum = 0;
    for (std::size_t i = 0; i < counted; i++) {
        sum += disparities[i];
    }
    std::printf("%d,%s,%llu,%.4f,", pair.lead, zone.name.c_str(), static_cast<unsigned long long>(time_us),
                static_cast<double>(counted) / static_cast<double>(disparities.size()));
    const double divisor = counted > 0 ? sum / static_cast<double>(counted) + pair.d0_px : 0;
    divisor > 0 ? std::printf("%.4f\n", pair.focal_px * pair.baseline_mm / 1000 / divisor) : std::printf("\n");
}

void watch(const tsr::Scenario &scenario, const tsr::Staging &staging, const tsr::StagedCamera &staged)
{
    const tsr::SitePair &pair = *staging.site.pair_of(staged.node);
    if (pair.zones.empty()) {
        return;
    }
    tsr::scene::RayCaster caster(*staging.geometry);
    const tsr::scene::View view(*staging.geometry, staged.camera);
    const std::uint64_t period_us = scenario.pairs.watch_period_ms * 1000u;
    for (std::uint64_t time_us = 0; static_cast<double>(time_us) <= scenario.scene.duration_s * 1e6;
         time_us += period_us) {
        const tsr::FloatImage truth = tsr::true_disparity(pair, view.truth(caster, time_us));
        for (const tsr::SiteZone &zone : pair.zones) {
            print_look(pair, zone, time_us, truth);
        }
    }
}

int run(int argc, char **argv)
{
    if (argc < 2) {
        throw tsr::InputError("command line", "SCENARIO", "is missing");
    }
    const tsr::Scenario scenario = tsr::load_scenario(argv[1], std::vector<std::string>(argv + 2, argv + argc));
    const tsr::Staging staging = tsr::stage_scenario(scenario);
    std::printf("node,zone,time_us,share,depth_m\n");
    for (const tsr::StagedCamera &staged : staging.cameras) {
        if (!staged.right) {
            watch(scenario, staging, staged);
        }
    }
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return tsr::run_program("scene_zones", [&] { return run(argc, argv); });
}
