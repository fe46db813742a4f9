/*
 * tarsier: the tools.
 *
 *   tarsier demo-scene --pictures DIR --out DIR   recorded folders and site of the demo
 *
 * SPDX-License-Identifier: Apache-2.0
 */

#include "tsr/host/command_line.h"
#include "tsr/stage/stage.h"

namespace
{

void declare(CLI::App &app, tsr::StageOptions &stage)
{
    app.require_subcommand(1);
    CLI::App *demo_scene = app.add_subcommand("demo-scene", "write the demo's recorded frames and site");
    demo_scene->add_option("--pictures", stage.pictures, "folder of OpenCV's example data")->required();
    demo_scene->add_option("--out", stage.out, "folder to write")->required();
    demo_scene->add_option("--seed", stage.seed, "of the sensor noise and the site");
}

} // namespace

int main(int argc, char **argv)
{
    tsr::StageOptions stage;
    const auto run = [&] {
        tsr::write_stage(stage);
        return 0;
    };
    return tsr::run_command_line({"tarsier", "Tools of Tarsier.", [&](CLI::App &app) { declare(app, stage); }, run},
                                 argc, argv);
}
