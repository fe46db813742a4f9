/* What a run came to, on stdout. SPDX-License-Identifier: Apache-2.0 */
#ifndef TSR_EMULATOR_APP_PRINT_RESULT_H
#define TSR_EMULATOR_APP_PRINT_RESULT_H

#include <filesystem>

#include "run_site.h"

namespace tsr::app
{

void print_result(const std::filesystem::path &out, const RunOutcome &outcome);
/* A line if the machine did not keep up. */
void print_lateness(const Lateness &late);
/* A line if a baseline leaves zones out. */
void print_left_out(const Options &options, bool has_zones);

} // namespace tsr::app

#endif
