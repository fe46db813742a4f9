/*
 * tarsier: the tools.
 *
 *   tarsier demo-scene --pictures DIR --out DIR        recorded folders and site of the demo
 *   tarsier rectify-table CALIBRATION... -o TABLE      a node's rectification from a calibration
 *
 * SPDX-License-Identifier: Apache-2.0
 */

#include "tsr/host/command_line.h"
#include "tsr/stage/rectify_command.h"
#include "tsr/stage/stage.h"

namespace
{

void declare_demo_scene(CLI::App &command, tsr::StageOptions &stage)
{
    command.add_option("--pictures", stage.pictures, "folder of OpenCV's example data")->required();
    command.add_option("--out", stage.out, "folder to write")->required();
    command.add_option("--seed", stage.seed, "of the sensor noise and the site");
}

void declare_rectify_table(CLI::App &command, tsr::RectifyTableOptions &options)
{
    command
        .add_option("CALIBRATION", options.calibration,
                    "OpenCV YAML (one file or two), ROS camera_info YAML (left, right), BoofCV stereo YAML or "
                    "Middlebury calib.txt")
        ->required()
        ->expected(1, 2);
    command.add_option("-o,--out", options.table, "table to write")->required();
    command.add_option("--c-header", options.c_header, "the table as a C array as well");
    command.add_option("--width", options.width, "of the rectified views, px; default: as calibrated");
    command.add_option("--height", options.height, "of the rectified views, px");
    command.add_option("--source", options.source, "WIDTHxHEIGHT of the camera's frames; default: as the views");
    command.add_option("--calibrated", options.calibrated, "WIDTHxHEIGHT of the calibrated pictures, if no file says");
    command.add_option("--step", options.step, "px between control points; default: the widest that is exact enough")
        ->check(CLI::IsMember({8, 16, 32}));
    command.add_option("--zoom", options.zoom, "0: no pixel from outside the frame, 1: the whole frame is in view")
        ->check(CLI::Range(0.0, 1.0));
    command.add_flag("--separate-centres", options.separate_centres, "each view has its own cx, so d0 is not 0");
    command.add_option("--unit-mm", options.unit_mm, "mm in one unit of the calibration's T")
        ->check(CLI::PositiveNumber);
    command.add_flag("--json", options.json, "print JSON instead of lines for site.toml");
}

struct Commands {
    tsr::StageOptions stage;
    tsr::RectifyTableOptions rectify;
    CLI::App *rectify_table = nullptr;
};

void declare(CLI::App &app, Commands &commands)
{
    app.require_subcommand(1);
    declare_demo_scene(*app.add_subcommand("demo-scene", "write the demo's recorded frames and site"), commands.stage);
    commands.rectify_table = app.add_subcommand("rectify-table", "make a node's rectification table");
    declare_rectify_table(*commands.rectify_table, commands.rectify);
}

int run(const Commands &commands)
{
    if (commands.rectify_table->parsed()) {
        tsr::write_rectify_table(commands.rectify);
    } else {
        tsr::write_stage(commands.stage);
    }
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    Commands commands;
    return tsr::run_command_line(
        {"tarsier", "Tools of Tarsier.", [&](CLI::App &app) { declare(app, commands); }, [&] { return run(commands); }},
        argc, argv);
}
