/*
 * Records as tables: nodes.csv, links.csv and maps.csv, and the same in the
 * page. A column is named by the record's JSON keys, joined by "_".
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_TABLE_H
#define TSR_EMULATOR_TABLE_H

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tsr/emulator/run_record.h"

namespace tsr
{

struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<nlohmann::ordered_json>> rows; /* a cell for each column; null: nothing */
};

Table nodes_table(const RunRecord &run);
Table links_table(const RunRecord &run);
Table maps_table(const RunRecord &run);

/* RFC 4180 with line feeds; a header line even without rows. */
std::string csv_of(const Table &table);

/* The same cells in columns as wide as they must be, numbers to the right. Lines end at width: columns that do not fit
 * follow below, the first kept ones before them again. width 0: lines of any length. */
std::string aligned_text(const Table &table, std::size_t kept, std::size_t width);

} // namespace tsr

#endif
