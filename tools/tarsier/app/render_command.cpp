/*
 * tarsier render SCENARIO.toml --out DIR [--set TABLE.FIELD=VALUE]... [--period-ms N]
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <csignal>
#include <cstdio>
#include <memory>

#include <unistd.h>

#include "commands.h"
#include "tsr/host/command_line.h"
#include "tsr/scenario/render.h"

namespace tsr
{

namespace
{

volatile std::sig_atomic_t stop_signal = 0;

void take_signal(int number)
{
    stop_signal = number;
}

void take_signals()
{
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        std::signal(number, take_signal);
    }
}

struct Options {
    std::filesystem::path scenario;
    std::vector<std::string> settings;
    RenderOptions render;
};

int render(const Options &options)
{
    const Scenario scenario = load_scenario(options.scenario, options.settings);
    RenderOptions render = options.render;
    const bool shown = isatty(STDERR_FILENO) != 0;
    render.progress = [shown](std::size_t done, std::size_t all) {
        if (done == 0) { /* until then there is nothing to clean up: a signal ends the program */
            take_signals();
        }
        if (shown) {
            std::fprintf(stderr, "\r%zu of %zu pairs of frames\x1b[K", done, all);
        }
        return stop_signal == 0;
    };
    const bool complete = render_scenario(scenario, render);
    if (shown) {
        std::fputs("\r\x1b[K", stderr);
    }
    if (!complete) {
        std::printf("stopped by a signal: nothing was written\n");
        return 128 + stop_signal;
    }
    std::printf("%s: frames and ground truth; tarsier-emulator %s plays them\n", render.out.c_str(),
                (render.out / "site.toml").c_str());
    return 0;
}

} // namespace

Command declare_render(CLI::App &command)
{
    auto options = std::make_shared<Options>();
    command.add_option("SCENARIO", options->scenario, "scenario.toml")->required();
    command.add_option("--out", options->render.out, "folder to write, new or empty")->required();
    command.add_option("--set", options->settings, "TABLE.FIELD=VALUE in the place of what the file says")
        ->allow_extra_args(false);
    command.add_option("--period-ms", options->render.period_ms, "between frames; by default the watch period")
        ->check(CLI::Range(1, 3'600'000));
    command.add_option("--threads", options->render.threads, "by default as many as the machine has")
        ->check(CLI::Range(1, 256));
    return [options] { return render(*options); };
}

} // namespace tsr
