/*
 * tarsier: the tools.
 *
 *   tarsier demo-scene --pictures DIR --out DIR   recorded folders and site of the demo
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <CLI/CLI.hpp>

#include "tsr/host/input_error.h"
#include "tsr/stage/stage.h"

int main(int argc, char **argv)
{
    return tsr::run_program("tarsier", [&] {
        CLI::App app("Tools of Tarsier.");
        app.require_subcommand(1);
        tsr::StageOptions stage;
        CLI::App *demo_scene = app.add_subcommand("demo-scene", "write the demo's recorded frames and site");
        demo_scene->add_option("--pictures", stage.pictures, "folder of OpenCV's example data")->required();
        demo_scene->add_option("--out", stage.out, "folder to write")->required();
        demo_scene->add_option("--seed", stage.seed, "of the sensor noise and the site");
        demo_scene->callback([&] { tsr::write_stage(stage); });
        try {
            app.parse(argc, argv);
        } catch (const CLI::Success &help) {
            return app.exit(help);
        } catch (const CLI::ParseError &error) {
            throw tsr::InputError("command line", "", error.what());
        }
        return 0;
    });
}
