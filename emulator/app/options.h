/* The command line of tarsier-emulator. SPDX-License-Identifier: Apache-2.0 */
#ifndef TSR_EMULATOR_APP_OPTIONS_H
#define TSR_EMULATOR_APP_OPTIONS_H

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tsr/emulator/baseline.h"
#include "tsr/emulator/pair_site.h"
#include "tsr/host/command_line.h"

namespace tsr::app
{

struct Options {
    std::filesystem::path site;
    std::vector<std::filesystem::path> pair;
    PairOptions pair_options;
    std::vector<std::string> settings;
    std::vector<std::string> sweeps;
    std::optional<std::uint64_t> seed;
    std::string speed;    /* empty: as fast as it can */
    std::string baseline; /* empty: nodes send maps */
    std::filesystem::path out;
    std::filesystem::path sink; /* tarsier-sink; beside this program by default */
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    bool quiet = false;
};

void declare(CLI::App &app, Options &options);
std::optional<Baseline> baseline_of(const Options &options);

} // namespace tsr::app

#endif
