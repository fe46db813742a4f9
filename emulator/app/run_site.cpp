/*
 * Nodes, air and sink of one run, and what it leaves.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "run_site.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <optional>
#include <utility>

#include "inputs.h"
#include "progress_bar.h"
#include "tsr/emulator/pace.h"
#include "tsr/emulator/report.h"
#include "tsr/emulator/run_sink.h"
#include "tsr/emulator/simulation.h"
#include "tsr/emulator/unfinished_run.h"
#include "tsr/host/atomic_file.h"

namespace tsr::app
{

namespace
{

namespace fs = std::filesystem;

volatile std::sig_atomic_t signal_taken = 0;
std::atomic<std::int64_t> taken_ms = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler writes it");

/* timeout(1) tells a program and then its group, so who is told again at once is told once. */
constexpr std::int64_t kSameSignalMs = 1000;

void note_signal(int number)
{
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const std::int64_t now_ms = std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
    if (signal_taken == 0) {
        taken_ms = now_ms;
        signal_taken = number;
    } else if (now_ms - taken_ms >= kSameSignalMs) {
        std::signal(number, SIG_DFL);
        std::raise(number); /* taken when this returns */
    }
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

} // namespace

void take_signals()
{
    struct sigaction action {
    };
    action.sa_handler = note_signal;
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
                    const KeyRing &keys, Pictures &pictures, const StagedScenario *scenario)
{
    const std::optional<Baseline> baseline = baseline_of(options);
    const Site site = baseline ? baseline_site(of_maps) : of_maps;
    const auto start = std::chrono::steady_clock::now();
    take_signals();
    const OutFolder out(folder);
    refuse_inputs_of_run(out, options, site, scenario);
    UnfinishedRun run(out);
    write_site(run.file("site.toml"), site);
    load_site(run.file("site.toml")); /* what the sink would refuse is refused here, by name */
    write_keys(run.file("keys.toml"), keys);
    if (scenario != nullptr) {
        write_file_atomically(run.file("scenario.toml"), scenario->effective().text_for(out.path()));
    }

    const SinkProgram program{options.sink, [] { return stop_signal() != 0; }};
    const auto sink = baseline ? start_jpeg_sink(keys, run) : start_map_sink(program, site, run);
    Simulation simulation(site, keys, pictures, sink->link(), baseline);
    PcapngCapture capture(run.file("capture.pcapng"));
    simulation.record_air(capture);
    RunOutcome outcome;
    outcome.late = play(options, label, simulation);
    sink->finish();

    capture.complete();
    auto events = sink->events(simulation);
    find_true_depths(site, pictures, events);
    RunRecord record = gather(site, simulation, pictures, sink->maps(simulation, pictures), std::move(events));
    record.settings = scenario != nullptr ? scenario->settings() : RunSettings{};
    record.sink_restarts = sink->restarts();
    record.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.summary = make_summary(record);
    const auto gallery = choose_maps(record);
    if (!baseline) {
        write_truth_pictures(run.path(), gallery, pictures);
    }
    write_tables(run.path(), record);
    write_page(run.path(), outcome.summary, record, gallery);
    write_file_atomically(run.file("summary.json"), summary_text(outcome.summary));
    run.complete();
    return outcome;
}

} // namespace tsr::app
