/*
 * One run of a site, into a folder.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_APP_RUN_SITE_H
#define TSR_EMULATOR_APP_RUN_SITE_H

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "options.h"
#include "staged_scenario.h"
#include "tsr/emulator/pictures.h"
#include "tsr/host/keys.h"
#include "tsr/host/site.h"

namespace tsr::app
{

struct Lateness { /* of --speed; s of the wall clock */
    double worst_s = 0;
    double end_s = 0;
};

struct RunOutcome {
    nlohmann::ordered_json summary; /* summary.json */
    Lateness late;
};

/* From now on a signal asks for an end: the run then reports what it has, if its sink answers. Another one, a second
 * later or more, ends the program. */
void take_signals();
/* The signal that asked; 0: none. */
int stop_signal();
/* The exit status of what a signal may have ended, which it tells. */
int exit_status();

/* label: before the progress bar; scenario: that the site is of, null: of none. Throws InputError. */
RunOutcome run_site(const Options &options, const std::filesystem::path &out, const std::string &label,
                    const Site &site, const KeyRing &keys, Pictures &pictures, const StagedScenario *scenario);

} // namespace tsr::app

#endif
