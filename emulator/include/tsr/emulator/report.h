/*
 * What a run gave: summary.json, and index.html to look at.
 *
 *   summary.json  numbers of nodes, pairs, maps and energy; equal for equal
 *                 seeds but for wall_time_s
 *   index.html    the same with pictures, self-contained
 *
 * The sink's side is read from the files it exported (sink.json, maps/,
 * cloud.ply): the emulator knows nothing else of it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_REPORT_H
#define TSR_EMULATOR_REPORT_H

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tsr/emulator/simulation.h"
#include "tsr/emulator/truth.h"

namespace tsr
{

/* One map the sink has, with what the emulator knows of it. */
struct ReceivedMap {
    std::uint16_t node = 0;
    std::uint32_t counter = 0;
    std::uint64_t capture_time_us = 0; /* virtual time */
    bool kept = false;
    std::size_t map_bytes = 0;
    std::size_t reference_bytes = 0;
    std::string file;              /* below the out folder, without ending */
    std::optional<MapError> error; /* where there is ground truth */
};

/* Reads sink.json in out and compares each map with ground truth. Throws InputError. */
std::vector<ReceivedMap> read_received_maps(const Site &site, const Simulation &simulation, Pictures &pictures,
                                            const std::filesystem::path &out);

/* What went wrong on purpose, in order of time. */
nlohmann::ordered_json faults_json(const Simulation &simulation);

nlohmann::ordered_json make_summary(const Site &site, const Simulation &simulation,
                                    const std::vector<ReceivedMap> &maps, unsigned sink_restarts, double wall_time_s);

/* The page, from the summary and the exported files. */
void write_page(const std::filesystem::path &out, const nlohmann::ordered_json &summary, const Simulation &simulation,
                const std::vector<ReceivedMap> &maps);

} // namespace tsr

#endif
