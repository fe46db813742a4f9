/*
 * The frame of a program with a command line: help, refusals, exit status.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_COMMAND_LINE_H
#define TSR_HOST_COMMAND_LINE_H

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace tsr
{

struct Program {
    std::string name;        /* in front of refusals */
    std::string description; /* first line of --help */
    std::function<void(CLI::App &)> declare;
    std::function<int()> run; /* after the command line was read */
};

/* Refuses what is not a number above 0. */
CLI::Validator above_zero();

/* Reads the command line and runs: 0, or 2 with one line on stderr for what
 * the user gave wrong, 1 for everything else (input_error.h). */
int run_command_line(const Program &program, int argc, char **argv);

} // namespace tsr

#endif
