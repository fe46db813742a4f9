/* From a scenario file to what a run needs. SPDX-License-Identifier: Apache-2.0 */
#include "staged_scenario.h"

#include <utility>

#include "tsr/emulator/crowd_pictures.h"
#include "tsr/emulator/preflight.h"
#include "tsr/emulator/scene_pictures.h"

namespace tsr::app
{

StagedScenario::StagedScenario(Scenario scenario) : scenario_(std::move(scenario))
{
    if (scenario_.recorded) {
        crowd_ = stage_crowd(scenario_);
    } else {
        staging_ = stage_scenario(scenario_);
    }
    keys_ = derive_test_keys(scenario_.seed, site());
    const std::uint64_t seen = crowd_ ? 0 : ScenePictures::memory(*staging_);
    check_memory(site(), scenario_.file, check_nodes(site(), keys_) + seen);
}

std::unique_ptr<Pictures> StagedScenario::pictures(unsigned threads) const
{
    if (crowd_) {
        return std::make_unique<CrowdPictures>(*crowd_, scenario_.scene.duration_s);
    }
    return std::make_unique<ScenePictures>(scenario_, *staging_, threads);
}

} // namespace tsr::app
