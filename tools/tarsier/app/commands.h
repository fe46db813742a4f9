/*
 * The commands of `tarsier`: each declares its options and returns what to run
 * once the command line was read.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TARSIER_COMMANDS_H
#define TSR_TARSIER_COMMANDS_H

#include <functional>

#include <CLI/CLI.hpp>

namespace tsr
{

/* The exit status. */
using Command = std::function<int()>;

Command declare_demo_scene(CLI::App &command);
Command declare_compare(CLI::App &command);
Command declare_decode(CLI::App &command);
Command declare_encode(CLI::App &command);
Command declare_match(CLI::App &command);
Command declare_rectify_table(CLI::App &command);
Command declare_render(CLI::App &command);
Command declare_train_prior(CLI::App &command);

} // namespace tsr

#endif
