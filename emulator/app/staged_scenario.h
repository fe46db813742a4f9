/*
 * A scenario that has passed all checks and can be run.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_APP_STAGED_SCENARIO_H
#define TSR_EMULATOR_APP_STAGED_SCENARIO_H

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tsr/emulator/pictures.h"
#include "tsr/emulator/run_record.h"
#include "tsr/host/keys.h"
#include "tsr/scenario/crowd.h"
#include "tsr/scenario/effective.h"
#include "tsr/scenario/staging.h"

namespace tsr::app
{

/* A scenario as the file is now. */
struct LoadedScenario {
    /* settings: of --set and --seed. Throws InputError. */
    LoadedScenario(const std::filesystem::path &file, const std::vector<std::string> &settings);

    Scenario scenario;
    EffectiveScenario effective;
    RunSettings settings;
};

class StagedScenario
{
  public:
    /* Throws InputError. */
    explicit StagedScenario(LoadedScenario loaded);
    StagedScenario(const StagedScenario &) = delete;
    StagedScenario &operator=(const StagedScenario &) = delete;

    const std::string &name() const { return loaded_.scenario.name; }
    const Site &site() const { return crowd_ ? crowd_->site : staging_->site; }
    const KeyRing &keys() const { return keys_; }
    const EffectiveScenario &effective() const { return loaded_.effective; }
    const RunSettings &settings() const { return loaded_.settings; }
    /* The recorded site of a crowd; null: a scene. */
    const Site *recorded() const { return crowd_ ? &crowd_->recorded : nullptr; }
    /* What cameras see; does not outlive this. Reads all frames of a crowd and throws InputError for those it cannot.
     */
    std::unique_ptr<Pictures> pictures(unsigned threads) const;

  private:
    LoadedScenario loaded_;
    std::optional<Crowd> crowd_; /* either this or a scene */
    std::optional<Staging> staging_;
    KeyRing keys_;
};

} // namespace tsr::app

#endif
