/*
 * tarsier-emulator: runs a site on recorded frames, or a virtual scene, in virtual time.
 *
 *   tarsier-emulator site.toml --out out
 *   tarsier-emulator scenario.toml --set pairs.baseline_mm=100 --out out
 *   tarsier-emulator --pair LEFT_DIR RIGHT_DIR --focal-px F --baseline-mm B --out out
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "tsr/emulator/baseline.h"
#include "tsr/emulator/crowd_pictures.h"
#include "tsr/emulator/out_folder.h"
#include "tsr/emulator/pair_site.h"
#include "tsr/emulator/preflight.h"
#include "tsr/emulator/recorded_pictures.h"
#include "tsr/emulator/report.h"
#include "tsr/emulator/run_sink.h"
#include "tsr/emulator/scene_pictures.h"
#include "tsr/emulator/simulation.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/command_line.h"
#include "tsr/host/input_error.h"
#include "tsr/host/keys.h"

namespace
{

namespace fs = std::filesystem;

constexpr std::size_t kPairsPrinted = 20;              /* one by one; more are summed up */
constexpr std::uint64_t kSeedMax = 0x7fffffffffffffff; /* TOML integers are signed */

struct Options {
    fs::path site;
    std::vector<fs::path> pair;
    tsr::PairOptions pair_options;
    std::vector<std::string> settings;
    std::optional<std::uint64_t> seed;
    std::string baseline; /* empty: none */
    fs::path out;
    fs::path sink; /* tarsier-sink; beside this program by default */
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    bool quiet = false;
};

void declare(CLI::App &app, Options &options)
{
    app.add_option("SITE", options.site, "site.toml, or scenario.toml of a virtual scene");
    app.add_option("--set", options.settings, "of a scenario: TABLE.FIELD=VALUE in the place of what the file says");
    auto *pair = app.add_option("--pair", options.pair, "folders of left and right frames, instead of SITE");
    pair->expected(2);
    app.add_option("--focal-px", options.pair_options.focal_px, "focal length of the rectified pair, px")->needs(pair);
    app.add_option("--baseline-mm", options.pair_options.baseline_mm, "distance of the two cameras, mm")->needs(pair);
    app.add_option("--d0", options.pair_options.d0_px, "disparity offset, px: Z = f B / (d + d0)")->needs(pair);
    app.add_option("--disparities", options.pair_options.disparities, "disparities searched, 16..128, a multiple of 8")
        ->needs(pair)
        ->check(CLI::Range(16, 128));
    app.add_option("--seed", options.seed, "instead of the site's")->check(CLI::Range(kSeedMax));
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

/* One line on a terminal, rewritten ten times a second at most. */
class ProgressBar
{
  public:
    explicit ProgressBar(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) != 0) {}

    void operator()(std::uint64_t now_us, std::uint64_t end_us)
    {
        if (!shown_ || ++calls_ % kCallsPerLook != 0) {
            return;
        }
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(100)) {
            return;
        }
        last_ = now;
        draw(std::min(now_us, end_us), end_us, std::chrono::duration<double>(now - start_).count());
    }

    void finish() const
    {
        if (shown_) {
            std::fputs("\r\x1b[K", stderr);
        }
    }

  private:
    static constexpr unsigned kCallsPerLook = 64; /* an event takes less time than a look at the clock */

    static void draw(std::uint64_t now_us, std::uint64_t end_us, double wall_s)
    {
        constexpr std::size_t kWidth = 40;
        const double share = end_us > 0 ? static_cast<double>(now_us) / static_cast<double>(end_us) : 1;
        const auto filled = static_cast<std::size_t>(share * kWidth);
        const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
        const double virtual_s = static_cast<double>(now_us) / 1e6;
        std::fprintf(stderr, "\r[%s] %5.1f s of %.1f s, %.0f x real time, %.0f s left \x1b[K", bar.c_str(), virtual_s,
                     static_cast<double>(end_us) / 1e6, wall_s > 0 ? virtual_s / wall_s : 0,
                     share > 0 ? wall_s / share - wall_s : 0);
        std::fflush(stderr);
    }

    bool shown_;
    unsigned calls_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_{};
};

/* A signal asks for an end; the run then reports what it has. */
volatile std::sig_atomic_t stop_signal = 0;

void take_signals()
{
    struct sigaction action {
    };
    action.sa_handler = [](int number) { stop_signal = number; };
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        sigaction(number, &action, nullptr);
    }
}

tsr::Site choose_site(const Options &options)
{
    if (options.site.empty() == options.pair.empty()) {
        throw tsr::InputError("command line", "SITE or --pair", "give one of them");
    }
    if (!options.site.empty()) {
        tsr::Site site = tsr::load_site(options.site);
        site.seed = options.seed.value_or(site.seed);
        return site;
    }
    tsr::PairOptions pair = options.pair_options;
    pair.left = options.pair[0];
    pair.right = options.pair[1];
    pair.seed = options.seed.value_or(pair.seed);
    for (const auto &[name, value] : {std::pair{"--focal-px", pair.focal_px}, {"--baseline-mm", pair.baseline_mm}}) {
        if (!(value > 0)) {
            throw tsr::InputError("command line", name, "must be given with --pair, above 0");
        }
    }
    return tsr::make_pair_site(pair);
}

/* The same site with folders that are found from anywhere. */
tsr::Site with_absolute_folders(tsr::Site site)
{
    const auto absolute = [&site](fs::path &folder) {
        if (!folder.empty()) {
            folder = fs::absolute(site.resolve(folder));
        }
    };
    for (tsr::SiteNode &node : site.nodes) {
        absolute(node.frames);
        absolute(node.frames_right);
    }
    for (tsr::SitePair &pair : site.pairs) {
        absolute(pair.truth);
    }
    return site;
}

void print_counts(const char *name, const nlohmann::ordered_json &counts)
{
    std::printf("%s: %d frames watched, %d woken, %d maps made, %d withheld, %d sent, %d received, %d lost\n", name,
                counts.at("frames_watched").get<int>(), counts.at("frames_woken").get<int>(),
                counts.at("maps_made").get<int>(), counts.at("maps_withheld").get<int>(),
                counts.at("maps_sent").get<int>(), counts.at("maps_received").get<int>(),
                counts.at("maps_lost").get<int>());
}

void print_result(const fs::path &out, const nlohmann::ordered_json &summary)
{
    const auto &pairs = summary.at("pairs");
    if (pairs.size() > kPairsPrinted) {
        print_counts((std::to_string(pairs.size()) + " pairs").c_str(), summary.at("totals"));
    } else {
        for (const auto &pair : pairs) {
            print_counts(pair.at("name").get<std::string>().c_str(), pair);
            for (const auto &map : pair.at("maps")) {
                if (map.contains("error")) {
                    std::printf("  map at %.1f s: median error %.3f px, %.1f mm; %.1f %% of the pixels correct\n",
                                map.at("capture_time_s").get<double>(), map.at("error").at("median_px").get<double>(),
                                map.at("error").at("median_mm").get<double>(),
                                100 * map.at("error").at("correct").get<double>());
                }
            }
        }
    }
    if (const auto &baseline = summary.at("baseline"); !baseline.is_null()) {
        std::printf("a baseline: in the place of maps both views, as JPEG of quality %d\n",
                    baseline.at("jpeg_quality").get<int>());
    }
    std::printf("%.1f s of virtual time in %.1f s; results in %s, look at %s\n",
                summary.at("virtual_time_s").get<double>(), summary.at("wall_time_s").get<double>(), out.c_str(),
                (out / "index.html").c_str());
}

std::optional<tsr::Baseline> chosen_baseline(const Options &options)
{
    if (options.baseline.empty()) {
        return std::nullopt;
    }
    return tsr::Baseline{.stream = options.baseline == "stream"};
}

/* One site with its pictures, into the out folder. */
int run_site(const Options &options, const tsr::Site &of_maps, const tsr::KeyRing &keys, tsr::Pictures &pictures)
{
    const std::optional<tsr::Baseline> baseline = chosen_baseline(options);
    const tsr::Site site = baseline ? tsr::baseline_site(of_maps, *baseline) : of_maps;
    const auto start = std::chrono::steady_clock::now();
    tsr::OutFolder out(options.out);
    tsr::write_site(out.file("site.toml"), site);
    tsr::load_site(out.file("site.toml")); /* what the sink would refuse is refused here, by name */
    tsr::write_keys(out.file("keys.toml"), keys);

    take_signals();
    const auto sink = baseline ? tsr::start_jpeg_sink(keys, out) : tsr::start_map_sink(options.sink, site, out);
    tsr::Simulation simulation(site, keys, pictures, sink->link(), baseline);
    tsr::PcapngCapture capture(out.file("capture.pcapng"));
    simulation.record_air(capture);
    ProgressBar progress(!options.quiet);
    simulation.run([&](std::uint64_t now_us, std::uint64_t end_us) {
        progress(now_us, end_us);
        return stop_signal == 0;
    });
    progress.finish();
    sink->finish();

    capture.complete();
    tsr::RunRecord record =
        tsr::gather(site, simulation, pictures, sink->maps(simulation, pictures), sink->events(simulation));
    record.sink_restarts = sink->restarts();
    record.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto summary = tsr::make_summary(record);
    const auto gallery = tsr::choose_maps(record);
    if (!baseline) {
        tsr::write_truth_pictures(out.path(), gallery, pictures);
    }
    tsr::write_tables(out.path(), record);
    tsr::write_page(out.path(), summary, record, gallery);
    tsr::write_file_atomically(out.file("summary.json"), summary.dump(2) + "\n");
    out.keep();
    print_result(out.path(), summary);
    if (stop_signal != 0) {
        std::printf("stopped by a signal: the results are those of the time until then\n");
        return 128 + stop_signal;
    }
    return 0;
}

int run_recorded(const Options &options)
{
    if (!options.settings.empty()) {
        throw tsr::InputError("command line", "--set", "is for scenarios, and this is a site");
    }
    const tsr::Site site = with_absolute_folders(choose_site(options));
    const tsr::KeyRing keys = tsr::derive_test_keys(site.seed, site);
    tsr::check_nodes(site, keys);
    tsr::check_recorded(site);
    tsr::RecordedPictures pictures(site);
    return run_site(options, site, keys, pictures);
}

int run_crowd(const Options &options, const tsr::Scenario &scenario)
{
    const tsr::Crowd crowd = tsr::stage_crowd(scenario);
    const tsr::KeyRing keys = tsr::derive_test_keys(scenario.seed, crowd.site);
    tsr::check_nodes(crowd.site, keys);
    tsr::CrowdPictures pictures(crowd, scenario.scene.duration_s);
    return run_site(options, crowd.site, keys, pictures);
}

int run_scenario(const Options &options)
{
    std::vector<std::string> settings = options.settings;
    if (options.seed) {
        settings.push_back("seed=" + std::to_string(*options.seed));
    }
    const tsr::Scenario scenario = tsr::load_scenario(options.site, settings);
    if (scenario.recorded) {
        return run_crowd(options, scenario);
    }
    const tsr::Staging staging = tsr::stage_scenario(scenario);
    const tsr::KeyRing keys = tsr::derive_test_keys(scenario.seed, staging.site);
    tsr::check_nodes(staging.site, keys);
    tsr::ScenePictures pictures(scenario, staging, options.threads);
    return run_site(options, staging.site, keys, pictures);
}

int run(const Options &options)
{
    const bool scenario = !options.site.empty() && options.pair.empty() && tsr::is_scenario_file(options.site);
    return scenario ? run_scenario(options) : run_recorded(options);
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    options.sink = fs::read_symlink("/proc/self/exe").parent_path() / "tarsier-sink";
    return tsr::run_command_line({"tarsier-emulator", "Runs a Tarsier site on recorded frames in virtual time.",
                                  [&](CLI::App &app) { declare(app, options); }, [&] { return run(options); }},
                                 argc, argv);
}
