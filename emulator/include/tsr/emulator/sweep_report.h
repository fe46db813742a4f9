/*
 * What a sweep gave: one row for each run, its swept values first, then the
 * figures of its summary.json that runs are compared by, then its folder.
 * docs/units.md, 7, has the columns.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_SWEEP_REPORT_H
#define TSR_EMULATOR_SWEEP_REPORT_H

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tsr/emulator/sweep.h"
#include "tsr/emulator/table.h"

namespace tsr
{

struct SweepReport {
    std::string scenario; /* its name */
    std::vector<SweepAxis> axes;
    std::size_t planned = 0; /* runs */
    Table table;             /* without columns before the first run */
};

/* summary: of make_summary(); folder: of the run, below the sweep's. */
void add_run(SweepReport &report, const SweepPoint &point, const nlohmann::ordered_json &summary,
             const std::string &folder);

/* sweep.csv and index.html in out, which replace those of fewer runs. There is a run. Throws InputError. */
void write_sweep(const std::filesystem::path &out, const SweepReport &report);

} // namespace tsr

#endif
