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

#include "tsr/emulator/pictures.h"
#include "tsr/host/keys.h"
#include "tsr/scenario/crowd.h"
#include "tsr/scenario/staging.h"

namespace tsr::app
{

class StagedScenario
{
  public:
    /* Throws InputError. */
    explicit StagedScenario(Scenario scenario);
    StagedScenario(const StagedScenario &) = delete;
    StagedScenario &operator=(const StagedScenario &) = delete;

    const std::string &name() const { return scenario_.name; }
    const Site &site() const { return crowd_ ? crowd_->site : staging_->site; }
    const KeyRing &keys() const { return keys_; }
    /* The recorded site of a crowd; empty: a scene. */
    std::filesystem::path recorded() const { return crowd_ ? crowd_->recorded.file : std::filesystem::path(); }
    /* What cameras see; does not outlive this. Reads all frames of a crowd and throws InputError for those it cannot.
     */
    std::unique_ptr<Pictures> pictures(unsigned threads) const;

  private:
    Scenario scenario_;
    std::optional<Crowd> crowd_; /* either this or a scene */
    std::optional<Staging> staging_;
    KeyRing keys_;
};

} // namespace tsr::app

#endif
