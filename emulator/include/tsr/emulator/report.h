/*
 * What a run gave, as files; each equal for equal seeds but for wall_time_s.
 *
 *   summary.json           numbers of nodes, pairs, links, maps and energy
 *   nodes.csv, links.csv,  the same records as tables
 *   maps.csv
 *   index.html             the same to look at, self-contained
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_REPORT_H
#define TSR_EMULATOR_REPORT_H

#include <filesystem>

#include <nlohmann/json.hpp>

#include "tsr/emulator/gallery.h"
#include "tsr/emulator/run_record.h"

namespace tsr
{

nlohmann::ordered_json make_summary(const RunRecord &run);
/* summary.json. Of a name that is no UTF-8, U+FFFD stands for what is none. */
std::string summary_text(const nlohmann::ordered_json &summary);

/* nodes.csv, links.csv, maps.csv. Throws InputError. */
void write_tables(const std::filesystem::path &out, const RunRecord &run);

/* summary: of make_summary(); cloud.ply is there. Throws InputError. */
void write_page(const std::filesystem::path &out, const nlohmann::ordered_json &summary, const RunRecord &run,
                const std::vector<GalleryMap> &gallery);

} // namespace tsr

#endif
