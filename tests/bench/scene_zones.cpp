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
#include <cstdio>

#include "tsr/host/input_error.h"
#include "tsr/scenario/virtual_camera.h"
#include "tsr/scenario/zone_truth.h"

namespace
{

void print_look(const tsr::SitePair &pair, const tsr::SiteZone &zone, std::uint64_t time_us,
                const tsr::FloatImage &truth)
{
    const tsr::ZoneTruth known = tsr::zone_truth(pair, zone, truth);
    std::printf("%d,%s,%llu,%.4f,", pair.lead, zone.name.c_str(), static_cast<unsigned long long>(time_us),
                known.share);
    known.depth_m ? std::printf("%.4f\n", *known.depth_m) : std::printf("\n");
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
