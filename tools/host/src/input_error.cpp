/* One line per refusal. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/input_error.h"

#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <utility>

namespace tsr
{
namespace
{

/* Bytes of the UTF-8 character at the front of text; 0: none is there (RFC 3629). */
std::size_t character_len(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    const std::size_t len = first < 0x80   ? 1
                            : first < 0xc2 ? 0
                            : first < 0xe0 ? 2
                            : first < 0xf0 ? 3
                            : first < 0xf5 ? 4
                                           : 0;
    if (len > text.size()) {
        return 0;
    }
    for (std::size_t i = 1; i < len; ++i) {
        /* No longer forms than needed, no surrogates, nothing above U+10FFFF. */
        const unsigned char low = i > 1 ? 0x80 : first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
        const unsigned char high = i > 1 ? 0xbf : first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
        if (byte(i) < low || byte(i) > high) {
            return 0;
        }
    }
    return len;
}

/* What a terminal obeys instead of showing it: C0, DEL, C1, line and paragraph separators, changes of direction. */
bool is_control(std::string_view character)
{
    const auto first = static_cast<unsigned char>(character[0]);
    return first < 0x20 || first == 0x7f || (first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0) ||
           (character >= "\u2028" && character <= "\u202e" && character.size() == 3) ||
           (character >= "\u2066" && character <= "\u2069" && character.size() == 3);
}

std::string one_line(std::string_view text)
{
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string line;
    while (!text.empty()) {
        const std::size_t len = character_len(text);
        const std::string_view character = text.substr(0, len > 0 ? len : 1);
        if (len > 0 && !is_control(character)) {
            line += character;
        } else {
            for (const char c : character) {
                const auto byte = static_cast<unsigned char>(c);
                line += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
            }
        }
        text.remove_prefix(character.size());
    }
    return line;
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
    } catch (const std::filesystem::filesystem_error &error) {
        const std::string path = error.path1().string();
        std::cerr << program << ": " << one_line(path.empty() ? error.what() : path + ": " + error.code().message())
                  << '\n';
        return kExitInput;
    } catch (const std::exception &error) {
        std::cerr << program << ": " << one_line(error.what()) << '\n';
        return kExitInternal;
    }
}

} // namespace tsr
