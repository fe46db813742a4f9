/*
 * Command lines by CLI11, refusals by InputError.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/host/command_line.h"

#include <algorithm>
#include <string>
#include <vector>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

/* What CLI11 found wrong, in terms of what was typed: an unknown word is named before what is missing for it. */
std::string describe(const CLI::App &app, const CLI::ParseError &error)
{
    const std::vector<std::string> unknown = app.remaining(true);
    const auto option = std::find_if(unknown.begin(), unknown.end(),
                                     [](const std::string &word) { return word.size() > 1 && word[0] == '-'; });
    if (option != unknown.end()) {
        return "'" + *option + "' is not an option";
    }
    if (unknown.empty()) {
        return error.what();
    }
    if (!app.get_subcommands({}).empty() && app.get_subcommands().empty()) {
        std::string names;
        for (const CLI::App *command : app.get_subcommands({})) {
            names += (names.empty() ? "" : ", ") + command->get_name();
        }
        return "'" + unknown.front() + "' is none of: " + names;
    }
    return "'" + unknown.front() + "' is not expected";
}

/* CLI11 takes an empty word for 0 where it expects a number. */
void refuse_empty_words(const CLI::App &app)
{
    for (const CLI::Option *option : app.get_options()) {
        if (std::ranges::count(option->results(), std::string()) > 0) {
            throw InputError("command line", option->get_name(), "is empty");
        }
    }
    for (const CLI::App *command : app.get_subcommands()) {
        refuse_empty_words(*command);
    }
}

} // namespace

CLI::Validator above_zero()
{
    const auto check = [](const std::string &text) {
        double value = 0;
        const bool is_above = CLI::detail::lexical_cast(text, value) && value > 0;
        return is_above ? std::string() : "'" + text + "' is not above 0";
    };
    return {check, "ABOVE 0"};
}

int run_command_line(const Program &program, int argc, char **argv)
{
    return run_program(program.name, [&] {
        CLI::App app(program.description);
        app.set_version_flag("--version", TSR_VERSION);
        program.declare(app);
        try {
            app.parse(argc, argv);
        } catch (const CLI::Success &help) {
            return app.exit(help);
        } catch (const CLI::ParseError &error) {
            throw InputError("command line", "", describe(app, error));
        }
        refuse_empty_words(app);
        return program.run();
    });
}

} // namespace tsr
