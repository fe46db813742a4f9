/*
 * Records as JSON: an object each in summary.json, a line each in the tables.
 *
 * Numbers are rounded, so that the same run gives the same text. Docs: units.md, chapter 7.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_RECORD_JSON_H
#define TSR_EMULATOR_RECORD_JSON_H

#include <nlohmann/json.hpp>

#include "tsr/emulator/run_record.h"
#include "tsr/emulator/zone_record.h"

namespace tsr
{

double rounded(double value, int digits);

nlohmann::ordered_json json_of(const NodeRecord &node);
nlohmann::ordered_json json_of(const LinkRecord &link);
/* error is null if the map was not compared. */
nlohmann::ordered_json json_of(const ReceivedMap &map);
nlohmann::ordered_json json_of(const ReceivedEvent &event);
nlohmann::ordered_json json_of(const ZoneRecord &record);
nlohmann::ordered_json json_of(const FaultNote &note);

} // namespace tsr

#endif
