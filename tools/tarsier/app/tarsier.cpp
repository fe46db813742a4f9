/*
 * tarsier: the tools.
 *
 *   tarsier demo-scene --pictures DIR --out DIR          recorded folders and site of the demo
 *   tarsier render SCENARIO.toml --out DIR               a virtual scene as recorded folders with ground truth
 *   tarsier match LEFT RIGHT --disparities N -o OUT      a disparity map as a node computes it
 *   tarsier encode MAP -o OUT.tdm                       a map in few bytes
 *   tarsier decode MAP.tdm -o OUT                        the map of those bytes
 *   tarsier compare MAP TRUTH                            how good a disparity map is
 *   tarsier rectify-table CALIBRATION... -o TABLE        a node's rectification from a calibration
 *   tarsier train-prior DIR... -o map_prior.c            what the map codec knows beforehand
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cstdio>
#include <iostream>

#include "commands.h"
#include "tsr/host/command_line.h"
#include "tsr/host/input_error.h"

namespace
{

struct Entry {
    const char *name;
    const char *description;
    tsr::Command (*declare)(CLI::App &);
};

constexpr Entry kCommands[] = {
    {"demo-scene", "write the demo's recorded frames and site", tsr::declare_demo_scene},
    {"render", "write a virtual scene as recorded frames with ground truth", tsr::declare_render},
    {"match", "match a rectified pair as a node does", tsr::declare_match},
    {"encode", "code a disparity map in few bytes", tsr::declare_encode},
    {"decode", "decode a coded disparity map", tsr::declare_decode},
    {"rectify-table", "make a node's rectification table", tsr::declare_rectify_table},
    {"train-prior", "learn the map codec's prior from maps", tsr::declare_train_prior},
    {"compare", "judge a disparity map by the truth", tsr::declare_compare},
};

void declare(CLI::App &app, tsr::Command &chosen)
{
    app.require_subcommand(1);
    for (const Entry &entry : kCommands) {
        CLI::App *command = app.add_subcommand(entry.name, entry.description);
        const tsr::Command run = entry.declare(*command);
        command->callback([&chosen, run] { chosen = run; });
    }
}

/* Figures that standard output did not take are lost. */
void expect_printed()
{
    std::cout.flush();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout) {
        throw tsr::InputError("standard output", "write", "what was to be printed is lost");
    }
}

} // namespace

int main(int argc, char **argv)
{
    tsr::Command chosen;
    const auto run = [&] {
        const int status = chosen();
        expect_printed();
        return status;
    };
    return tsr::run_command_line({"tarsier", "Tools of Tarsier.", [&](CLI::App &app) { declare(app, chosen); }, run},
                                 argc, argv);
}
