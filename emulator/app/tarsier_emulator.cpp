/*
 * tarsier-emulator: runs a site on recorded frames, or a virtual scene, in virtual time.
 *
 *   tarsier-emulator site.toml --out out
 *   tarsier-emulator scenario.toml --set pairs.baseline_mm=100 --out out
 *   tarsier-emulator scenario.toml --sweep pairs.baseline_mm=60,100,150 --out out
 *   tarsier-emulator --pair LEFT_DIR RIGHT_DIR --focal-px F --baseline-mm B --out out
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "options.h"
#include "print_result.h"
#include "run_site.h"
#include "run_sweep.h"
#include "staged_scenario.h"
#include "tsr/emulator/pace.h"
#include "tsr/emulator/preflight.h"
#include "tsr/emulator/recorded_pictures.h"
#include "tsr/emulator/run_sink.h"
#include "tsr/host/input_error.h"

namespace tsr::app
{

namespace
{

namespace fs = std::filesystem;

Site choose_site(const Options &options)
{
    if (options.site.empty() == options.pair.empty()) {
        throw InputError("command line", "SITE or --pair", "give one of them");
    }
    if (!options.site.empty()) {
        Site site = load_site(options.site);
        site.seed = options.seed.value_or(site.seed);
        return site;
    }
    PairOptions pair = options.pair_options;
    pair.left = options.pair[0];
    pair.right = options.pair[1];
    pair.seed = options.seed.value_or(pair.seed);
    for (const auto &[name, value] : {std::pair{"--focal-px", pair.focal_px}, {"--baseline-mm", pair.baseline_mm}}) {
        if (!(value > 0)) {
            throw InputError("command line", name, "must be given with --pair, above 0");
        }
    }
    return make_pair_site(pair);
}

/* The same site with folders that are found from anywhere. */
Site with_absolute_folders(Site site)
{
    const auto absolute = [&site](fs::path &folder) {
        if (!folder.empty()) {
            folder = fs::absolute(site.resolve(folder));
        }
    };
    for (SiteNode &node : site.nodes) {
        absolute(node.frames);
        absolute(node.frames_right);
    }
    for (SitePair &pair : site.pairs) {
        absolute(pair.truth);
    }
    return site;
}

int run_alone(const Options &options, const Site &site, const KeyRing &keys, Pictures &pictures,
              const StagedScenario *scenario)
{
    print_result(options.out, run_site(options, options.out, "", site, keys, pictures, scenario));
    const auto has_zones = [](const SitePair &pair) { return !pair.zones.empty(); };
    print_left_out(options, std::ranges::any_of(site.pairs, has_zones));
    return exit_status();
}

int run_recorded(const Options &options)
{
    for (const auto &[name, given] : {std::pair{"--set", &options.settings}, {"--sweep", &options.sweeps}}) {
        if (!given->empty()) {
            throw InputError("command line", name, "is for scenarios, and this is a site");
        }
    }
    const Site site = with_absolute_folders(choose_site(options));
    const KeyRing keys = derive_test_keys(site.seed, site);
    check_memory(site, site.file, check_nodes(site, keys));
    check_recorded(site);
    RecordedPictures pictures(site);
    return run_alone(options, site, keys, pictures, nullptr);
}

int run_scenario(const Options &options)
{
    std::vector<std::string> settings = options.settings;
    if (options.seed) {
        settings.push_back("seed=" + std::to_string(*options.seed));
    }
    if (!options.sweeps.empty()) {
        return run_sweep(options, settings);
    }
    const StagedScenario staged(LoadedScenario(options.site, settings));
    return run_alone(options, staged.site(), staged.keys(), *staged.pictures(options.threads), &staged);
}

int run(const Options &options)
{
    if (!options.speed.empty()) {
        parse_speed(options.speed); /* refused before anything is read */
    }
    if (!baseline_of(options)) {
        check_program(options.sink);
    }
    const bool scenario = !options.site.empty() && options.pair.empty() && is_scenario_file(options.site);
    return scenario ? run_scenario(options) : run_recorded(options);
}

} // namespace

} // namespace tsr::app

int main(int argc, char **argv)
{
    tsr::app::Options options;
    options.sink = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "tarsier-sink";
    return tsr::run_command_line({"tarsier-emulator", "Runs a Tarsier site on recorded frames in virtual time.",
                                  [&](CLI::App &app) { tsr::app::declare(app, options); },
                                  [&] { return tsr::app::run(options); }},
                                 argc, argv);
}
