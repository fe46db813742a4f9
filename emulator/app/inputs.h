/* What a run reads must not be what it replaces. SPDX-License-Identifier: Apache-2.0 */
#ifndef TSR_EMULATOR_APP_INPUTS_H
#define TSR_EMULATOR_APP_INPUTS_H

#include <vector>

#include "options.h"
#include "staged_scenario.h"
#include "tsr/emulator/out_folder.h"

namespace tsr::app
{

/* Throws InputError if SITE, frames or truth lie among the results in out. SITE may be the site.toml or scenario.toml
 * of a run whose place this one takes. scenario: that the site is of, null: of none. */
void refuse_inputs_of_run(const OutFolder &out, const Options &options, const Site &site,
                          const StagedScenario *scenario);
/* A sweep leaves no scenario.toml, so it may not be SITE either. recorded: sites that crowds see. */
void refuse_inputs_of_sweep(const OutFolder &out, const Options &options, const std::vector<Site> &recorded);

} // namespace tsr::app

#endif
