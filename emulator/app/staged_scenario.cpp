/* From a scenario file to what a run needs. SPDX-License-Identifier: Apache-2.0 */
#include "staged_scenario.h"

#include <utility>

#include "tsr/emulator/crowd_pictures.h"
#include "tsr/emulator/preflight.h"
#include "tsr/emulator/scene_pictures.h"
#include "tsr/emulator/sweep.h"

namespace tsr::app
{

LoadedScenario::LoadedScenario(const std::filesystem::path &file, const std::vector<std::string> &changes)
    : scenario(load_scenario(file, changes)), effective(file, changes)
{
    settings.scenario = file.filename().string();
    for (const std::string &change : changes) {
        if (fields_of(change) != std::vector<std::string>{"seed"}) { /* the site tells it */
            settings.set.push_back(without_folders(change));
        }
    }
}

StagedScenario::StagedScenario(LoadedScenario loaded) : loaded_(std::move(loaded))
{
    const Scenario &scenario = loaded_.scenario;
    if (scenario.recorded) {
        crowd_ = stage_crowd(scenario);
    } else {
        staging_ = stage_scenario(scenario);
    }
    keys_ = derive_test_keys(scenario.seed, site());
    const std::uint64_t seen = crowd_ ? 0 : ScenePictures::memory(*staging_);
    check_memory(site(), scenario.file, check_nodes(site(), keys_) + seen);
}

std::unique_ptr<Pictures> StagedScenario::pictures(unsigned threads) const
{
    if (crowd_) {
        return std::make_unique<CrowdPictures>(*crowd_, loaded_.scenario.scene.duration_s);
    }
    return std::make_unique<ScenePictures>(loaded_.scenario, *staging_, threads);
}

} // namespace tsr::app
