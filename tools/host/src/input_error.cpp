/* One line per refusal. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/input_error.h"

#include <csignal>
#include <exception>
#include <iostream>
#include <utility>

namespace tsr
{
namespace
{

std::string one_line(std::string text)
{
    for (char &c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) {
            c = '?';
        }
    }
    return text;
}

std::string join(const std::string &file, const std::string &field, const std::string &reason)
{
    return one_line(field.empty() ? file + ": " + reason : file + ": " + field + ": " + reason);
}

} // namespace

InputError::InputError(std::string file, std::string field, std::string reason)
    : std::runtime_error(join(file, field, reason)), file_(std::move(file)), field_(std::move(field)),
      reason_(std::move(reason))
{
}

int run_program(std::string_view program, const std::function<int()> &body)
{
    std::signal(SIGXFSZ, SIG_IGN); /* a file at its size limit fails as a write, with its name */
    try {
        return body();
    } catch (const InputError &error) {
        std::cerr << program << ": " << error.what() << '\n';
        return kExitInput;
    } catch (const std::exception &error) {
        std::cerr << program << ": " << one_line(error.what()) << '\n';
        return kExitInternal;
    }
}

} // namespace tsr
