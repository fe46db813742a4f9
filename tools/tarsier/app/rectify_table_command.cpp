/*
 * tarsier rectify-table CALIBRATION... -o TABLE [--width W --height H] [--step N] ...
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <memory>

#include "commands.h"
#include "tsr/host/command_line.h"
#include "tsr/host/output_files.h"
#include "tsr/stage/rectify_command.h"

namespace tsr
{

Command declare_rectify_table(CLI::App &command)
{
    auto options = std::make_shared<RectifyTableOptions>();
    command
        .add_option("CALIBRATION", options->calibration,
                    "OpenCV YAML (one file or two), ROS camera_info YAML (left, right), BoofCV stereo YAML or "
                    "Middlebury calib.txt")
        ->required()
        ->expected(1, 2);
    command.add_option("-o,--out", options->table, "table to write")->required()->check(refuse_empty_name);
    command.add_option("--c-header", options->c_header, "the table as a C array as well")->check(refuse_empty_name);
    command.add_option("--width", options->width, "of the rectified views, px; default: as calibrated")
        ->check(above_zero());
    command.add_option("--height", options->height, "of the rectified views, px")->check(above_zero());
    command.add_option("--source", options->source, "WIDTHxHEIGHT of the camera's frames; default: as the views");
    command.add_option("--calibrated", options->calibrated, "WIDTHxHEIGHT of the calibrated pictures, if no file says");
    command.add_option("--step", options->step, "px between control points; default: the widest that is exact enough")
        ->check(CLI::IsMember({8, 16, 32}));
    command.add_option("--zoom", options->zoom, "0: no pixel from outside the frame, 1: the whole frame is in view");
    command.add_flag("--separate-centres", options->separate_centres, "each view has its own cx, so d0 is not 0");
    command.add_option("--unit-mm", options->unit_mm, "mm in one unit of the calibration's T");
    command.add_flag("--json", options->json, "print JSON instead of lines for site.toml");
    return [options] {
        write_rectify_table(*options);
        return 0;
    };
}

} // namespace tsr
