/* Runs of one scenario, a table of all. SPDX-License-Identifier: Apache-2.0 */
#ifndef TSR_EMULATOR_APP_RUN_SWEEP_H
#define TSR_EMULATOR_APP_RUN_SWEEP_H

#include "options.h"

namespace tsr::app
{

/* settings: of --set and --seed, for every run. Returns the exit status. Throws InputError: before the first run, if
 * any of them cannot be. */
int run_sweep(const Options &options, const std::vector<std::string> &settings);

} // namespace tsr::app

#endif
