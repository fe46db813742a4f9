/*
 * Command lines by CLI11, refusals by InputError.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/host/command_line.h"

#include "tsr/host/input_error.h"

namespace tsr
{

int run_command_line(const Program &program, int argc, char **argv)
{
    return run_program(program.name, [&] {
        CLI::App app(program.description);
        program.declare(app);
        try {
            app.parse(argc, argv);
        } catch (const CLI::Success &help) {
            return app.exit(help);
        } catch (const CLI::ParseError &error) {
            throw InputError("command line", "", error.what());
        }
        return program.run();
    });
}

} // namespace tsr
