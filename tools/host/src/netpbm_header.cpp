/* Tokens of PGM and PFM headers. SPDX-License-Identifier: Apache-2.0 */
#include "netpbm_header.h"

#include <charconv>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr std::size_t kTokenMax = 32;

} // namespace

void NetpbmHeader::refuse(const char *field, const std::string &reason) const
{
    throw InputError(name_.string(), field, reason);
}

bool NetpbmHeader::at_space() const
{
    const std::uint8_t byte = bytes_[at_];
    return byte == ' ' || (byte >= '\t' && byte <= '\r');
}

void NetpbmHeader::skip_space()
{
    while (at_ < bytes_.size()) {
        if (bytes_[at_] == '#') {
            while (at_ < bytes_.size() && bytes_[at_] != '\n' && bytes_[at_] != '\r') {
                at_++;
            }
        } else if (at_space()) {
            at_++;
        } else {
            return;
        }
    }
}

std::string NetpbmHeader::token(const char *field)
{
    skip_space();
    std::string text;
    while (at_ < bytes_.size() && !at_space() && bytes_[at_] != '#') {
        if (text.size() == kTokenMax) {
            refuse(field, "more than 32 characters");
        }
        text += static_cast<char>(bytes_[at_++]);
    }
    if (text.empty()) {
        refuse(field, "the file ends before it");
    }
    return text;
}

std::uint32_t NetpbmHeader::number(const char *field, std::uint32_t minimum, std::uint32_t maximum)
{
    const std::string text = token(field);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < minimum || value > maximum) {
        refuse(field, "'" + text + "' is not a number of " + std::to_string(minimum) + ".." + std::to_string(maximum));
    }
    return value;
}

std::span<const std::uint8_t> NetpbmHeader::data()
{
    if (at_ >= bytes_.size() || !at_space()) {
        refuse("header", "no white space before the pixels");
    }
    return bytes_.subspan(at_ + 1);
}

} // namespace tsr
