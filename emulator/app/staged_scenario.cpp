/* From a scenario file to what a run needs. SPDX-License-Identifier: Apache-2.0 */
#include "staged_scenario.h"

#include "tsr/emulator/crowd_pictures.h"
#include "tsr/emulator/preflight.h"
#include "tsr/emulator/scene_pictures.h"
#include "tsr/emulator/sweep.h"

namespace tsr::app
{

StagedScenario::StagedScenario(const std::filesystem::path &file, const std::vector<std::string> &settings)
    : scenario_(load_scenario(file, settings)), effective_(file, settings)
{
    settings_.scenario = file.filename().string();
    for (const std::string &setting : settings) {
        if (key_of(setting) != "seed") { /* the site tells it */
            settings_.set.push_back(without_folders(setting));
        }
    }
    if (scenario_.recorded) {
        crowd_ = stage_crowd(scenario_);
    } else {
        staging_ = stage_scenario(scenario_);
    }
    keys_ = derive_test_keys(scenario_.seed, site());
    check_nodes(site(), keys_);
}

std::unique_ptr<Pictures> StagedScenario::pictures(unsigned threads) const
{
    if (crowd_) {
        return std::make_unique<CrowdPictures>(*crowd_, scenario_.scene.duration_s);
    }
    return std::make_unique<ScenePictures>(scenario_, *staging_, threads);
}

} // namespace tsr::app
