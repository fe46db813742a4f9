/*
 * A sweep: all runs checked, then one after the other.
 *
 * OUT has runs/N/ of each, and sweep.csv and index.html, which are written anew
 * after each run: whatever ends a sweep, they are there for the runs before.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "run_sweep.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include <sys/ioctl.h>
#include <unistd.h>

#include "inputs.h"
#include "print_result.h"
#include "run_site.h"
#include "staged_scenario.h"
#include "tsr/emulator/out_folder.h"
#include "tsr/emulator/sweep_report.h"
#include "tsr/host/input_error.h"

namespace tsr::app
{

namespace
{

namespace fs = std::filesystem;

using Settings = std::vector<std::string>;

/* --set, --seed and --sweep would contradict each other. */
void refuse_set_twice(const std::vector<SweepAxis> &axes, const Settings &settings)
{
    for (const SweepAxis &axis : axes) {
        for (const std::string &setting : settings) {
            if (std::ranges::count(fields_of(setting), axis.key) > 0) {
                throw InputError("command line", "--sweep", axis.key + " is swept and also set to one value");
            }
        }
    }
}

/* Names the swept values, wherever the refusal itself is. */
[[noreturn]] void refuse_run(const Settings &swept, const InputError &error)
{
    std::string place;
    for (const std::string &setting : swept) {
        place += (place.empty() ? "--sweep '" : " '") + setting + "'";
        if (error.file().starts_with("--set '" + setting + "'")) {
            throw InputError("--sweep '" + setting + "'", error.field(), error.reason());
        }
    }
    throw InputError(place, "", error.what());
}

Settings joined(Settings settings, const Settings &more)
{
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

struct Checked {
    std::vector<LoadedScenario> scenarios; /* of each run, as the file is now: it may be edited while they run */
    std::vector<Site> recorded;            /* that crowds see */
};

/* Frames of a crowd are read once for all runs that share them. */
Checked check_all(const Options &options, const Settings &settings, const std::vector<Settings> &runs)
{
    std::set<fs::path> read;
    Checked checked;
    for (const Settings &swept : runs) {
        try {
            checked.scenarios.emplace_back(options.site, joined(settings, swept));
            const StagedScenario staged(checked.scenarios.back());
            if (baseline_of(options)) {
                baseline_site(staged.site());
            }
            if (staged.recorded() != nullptr && read.insert(staged.recorded()->file).second) {
                staged.pictures(options.threads);
                checked.recorded.push_back(*staged.recorded());
            }
        } catch (const InputError &error) {
            refuse_run(swept, error);
        }
    }
    return checked;
}

/* 1, 2, ... of equal length, so that names sort as numbers do. */
std::string folder_of(std::size_t run, std::size_t runs)
{
    const std::string number = std::to_string(run);
    return "runs/" + std::string(std::to_string(runs).size() - number.size(), '0') + number;
}

/* Columns of the terminal; 0: stdout is none. */
std::size_t terminal_width()
{
    winsize size{};
    return isatty(STDOUT_FILENO) != 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

} // namespace

int run_sweep(const Options &options, const Settings &settings)
{
    SweepReport report;
    for (const std::string &option : options.sweeps) {
        report.axes.push_back(parse_sweep(option));
    }
    refuse_set_twice(report.axes, settings);
    const std::vector<SweepPoint> points = sweep_points(report.axes);
    std::vector<Settings> runs;
    for (const SweepPoint &point : points) {
        runs.push_back(sweep_settings(report.axes, point));
    }
    const auto [scenarios, recorded] = check_all(options, settings, runs);

    take_signals();
    const OutFolder out(options.out);
    refuse_inputs_of_sweep(out, options, recorded);
    out.clear();
    report.planned = points.size();
    Lateness late;
    for (std::size_t i = 0; i < points.size() && stop_signal() == 0; ++i) {
        const StagedScenario staged(scenarios[i]);
        const auto pictures = staged.pictures(options.threads);
        const std::string folder = folder_of(i + 1, points.size());
        const std::string label = "run " + std::to_string(i + 1) + " of " + std::to_string(points.size()) + " ";
        const RunOutcome outcome =
            run_site(options, out.path() / folder, label, staged.site(), staged.keys(), *pictures, &staged);
        report.scenario = staged.name();
        add_run(report, points[i], outcome.summary, folder);
        write_sweep(out.path(), report);
        if (outcome.late.worst_s > late.worst_s) {
            late = outcome.late;
        }
    }
    if (!report.table.rows.empty()) {
        std::fputs(aligned_text(report.table, report.axes.size(), terminal_width()).c_str(), stdout);
        std::printf("%zu of %zu runs; results in %s, look at %s\n", report.table.rows.size(), points.size(),
                    out.path().c_str(), out.file("index.html").c_str());
    }
    print_lateness(late);
    print_left_out(options, !scenarios.front().scenario.zones.empty());
    return exit_status();
}

} // namespace tsr::app
