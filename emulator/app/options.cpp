/* What tarsier-emulator can be told. SPDX-License-Identifier: Apache-2.0 */
#include "options.h"

namespace tsr::app
{

namespace
{

constexpr std::uint64_t kSeedMax = 0x7fffffffffffffff; /* TOML integers are signed */

} // namespace

void declare(CLI::App &app, Options &options)
{
    app.add_option("SITE", options.site, "site.toml, or scenario.toml of a virtual scene");
    /* One word each: with extra arguments CLI11 also takes "[a,b]" for two words. */
    app.add_option("--set", options.settings, "of a scenario: TABLE.FIELD=VALUE in the place of what the file says")
        ->allow_extra_args(false);
    app.add_option("--sweep", options.sweeps,
                   "of a scenario: TABLE.FIELD=A,B,...: a run for each value, and one table; several: each combination")
        ->allow_extra_args(false);
    auto *pair = app.add_option("--pair", options.pair, "folders of left and right frames, instead of SITE");
    pair->expected(2);
    app.add_option("--focal-px", options.pair_options.focal_px, "focal length of the rectified pair, px")->needs(pair);
    app.add_option("--baseline-mm", options.pair_options.baseline_mm, "distance of the two cameras, mm")->needs(pair);
    app.add_option("--d0", options.pair_options.d0_px, "disparity offset, px: Z = f B / (d + d0)")->needs(pair);
    app.add_option("--disparities", options.pair_options.disparities, "disparities searched, 16..128, a multiple of 8")
        ->needs(pair)
        ->check(CLI::Range(16, 128));
    app.add_option("--seed", options.seed, "instead of the site's")->check(CLI::Range(kSeedMax));
    app.add_option("--speed", options.speed,
                   "realtime, or a factor of it: virtual time does not run ahead; by default as fast as it can");
    app.add_option(
           "--baseline", options.baseline,
           "nodes send both views as JPEG instead of maps: \"changes\" of each change, \"stream\" once a minute")
        ->check(CLI::IsMember({"changes", "stream"}));
    app.add_option("--out", options.out, "folder for the results")->required();
    app.add_option("--sink", options.sink, "the tarsier-sink program, by default the one beside this");
    app.add_option("--threads", options.threads, "that render a virtual scene, by default as many as the machine has")
        ->check(CLI::Range(1, 256));
    app.add_flag("--quiet", options.quiet, "no progress bar");
}

std::optional<Baseline> baseline_of(const Options &options)
{
    return options.baseline.empty() ? std::nullopt : std::optional(Baseline{.stream = options.baseline == "stream"});
}

} // namespace tsr::app
