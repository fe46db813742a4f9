/*
 * Nodes, air and sink of one run, and what it leaves.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "run_site.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>

#include "progress_bar.h"
#include "tsr/emulator/out_folder.h"
#include "tsr/emulator/pace.h"
#include "tsr/emulator/report.h"
#include "tsr/emulator/run_sink.h"
#include "tsr/emulator/simulation.h"
#include "tsr/host/atomic_file.h"

namespace tsr::app
{

namespace
{

namespace fs = std::filesystem;

constexpr std::size_t kPairsPrinted = 20; /* one by one; more are summed up */
constexpr double kLateToldS = 0.2;        /* less is how exactly a machine sleeps and draws a frame */

volatile std::sig_atomic_t signal_taken = 0;

void print_counts(const char *name, const nlohmann::ordered_json &counts)
{
    std::printf("%s: %d frames watched, %d woken, %d maps made, %d withheld, %d sent, %d received, %d lost\n", name,
                counts.at("frames_watched").get<int>(), counts.at("frames_woken").get<int>(),
                counts.at("maps_made").get<int>(), counts.at("maps_withheld").get<int>(),
                counts.at("maps_sent").get<int>(), counts.at("maps_received").get<int>(),
                counts.at("maps_lost").get<int>());
}

/* To the end, or to a signal. */
Lateness play(const Options &options, const std::string &label, Simulation &simulation)
{
    ProgressBar progress(!options.quiet, label);
    std::optional<Pace> pace;
    if (!options.speed.empty()) {
        pace.emplace(parse_speed(options.speed));
        simulation.keep_pace([&](std::uint64_t next_us) {
            return pace->wait_for(next_us, [&](std::uint64_t reached_us) {
                progress.waiting(reached_us);
                return stop_signal() == 0;
            });
        });
    }
    simulation.run([&](std::uint64_t now_us, std::uint64_t end_us) {
        progress.after_event(now_us, end_us);
        return stop_signal() == 0;
    });
    progress.finish();
    return pace ? Lateness{pace->worst_late_s(), pace->late_s()} : Lateness{};
}

void print_error(const nlohmann::ordered_json &map)
{
    const auto &error = map.at("error");
    if (error.is_null()) {
        return;
    }
    std::printf("  map at %.1f s: median error %.3f px, ", map.at("capture_time_s").get<double>(),
                error.at("median_px").get<double>());
    if (const auto &depth = error.at("median_mm"); !depth.is_null()) {
        std::printf("%.1f mm; ", depth.get<double>());
    }
    std::printf("%.1f %% of the pixels correct\n", 100 * error.at("correct").get<double>());
}

} // namespace

void take_signals()
{
    struct sigaction action {
    };
    action.sa_handler = [](int number) { signal_taken = number; };
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        sigaction(number, &action, nullptr);
    }
}

int stop_signal()
{
    return signal_taken;
}

int exit_status()
{
    if (stop_signal() == 0) {
        return 0;
    }
    std::printf("stopped by a signal: the results are those of the time until then\n");
    return 128 + stop_signal();
}

RunOutcome run_site(const Options &options, const fs::path &folder, const std::string &label, const Site &of_maps,
                    const KeyRing &keys, Pictures &pictures)
{
    const std::optional<Baseline> baseline = baseline_of(options);
    const Site site = baseline ? baseline_site(of_maps) : of_maps;
    const auto start = std::chrono::steady_clock::now();
    OutFolder out(folder);
    write_site(out.file("site.toml"), site);
    load_site(out.file("site.toml")); /* what the sink would refuse is refused here, by name */
    write_keys(out.file("keys.toml"), keys);

    take_signals();
    const auto sink = baseline ? start_jpeg_sink(keys, out) : start_map_sink(options.sink, site, out);
    Simulation simulation(site, keys, pictures, sink->link(), baseline);
    PcapngCapture capture(out.file("capture.pcapng"));
    simulation.record_air(capture);
    RunOutcome outcome;
    outcome.late = play(options, label, simulation);
    sink->finish();

    capture.complete();
    RunRecord record = gather(site, simulation, pictures, sink->maps(simulation, pictures), sink->events(simulation));
    record.sink_restarts = sink->restarts();
    record.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.summary = make_summary(record);
    const auto gallery = choose_maps(record);
    if (!baseline) {
        write_truth_pictures(out.path(), gallery, pictures);
    }
    write_tables(out.path(), record);
    write_page(out.path(), outcome.summary, record, gallery);
    write_file_atomically(out.file("summary.json"), outcome.summary.dump(2) + "\n");
    out.keep();
    return outcome;
}

void print_result(const fs::path &out, const RunOutcome &outcome)
{
    const auto &summary = outcome.summary;
    const auto &pairs = summary.at("pairs");
    if (pairs.size() > kPairsPrinted) {
        print_counts((std::to_string(pairs.size()) + " pairs").c_str(), summary.at("totals"));
    } else {
        for (const auto &pair : pairs) {
            print_counts(pair.at("name").get<std::string>().c_str(), pair);
            for (const auto &map : pair.at("maps")) {
                print_error(map);
            }
        }
    }
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
