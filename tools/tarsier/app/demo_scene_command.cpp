/*
 * tarsier demo-scene --pictures DIR --out DIR [--seed N]
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <memory>

#include "commands.h"
#include "tsr/stage/stage.h"

namespace tsr
{

Command declare_demo_scene(CLI::App &command)
{
    auto stage = std::make_shared<StageOptions>();
    command.add_option("--pictures", stage->pictures, "folder of OpenCV's example data")->required();
    command.add_option("--out", stage->out, "folder to write")->required();
    command.add_option("--seed", stage->seed, "of the sensor noise and the site");
    return [stage] {
        write_stage(*stage);
        return 0;
    };
}

} // namespace tsr
