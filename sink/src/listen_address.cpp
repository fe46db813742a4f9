/* The text of --listen. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/listen_address.h"

#include <charconv>

#include <sys/un.h>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr std::size_t kUnixPathMax = sizeof(sockaddr_un::sun_path) - 1;
constexpr unsigned kDescriptorMax = 0x7fffffff;

[[noreturn]] void refuse(std::string_view text, const std::string &field, const std::string &reason)
{
    throw InputError("--listen " + std::string(text), field, reason);
}

unsigned number(std::string_view text, std::string_view digits, const std::string &field, unsigned maximum)
{
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value > maximum) {
        refuse(text, field, "'" + std::string(digits) + "' is not a number of 0.." + std::to_string(maximum));
    }
    return value;
}

} // namespace

ListenAddress parse_listen_address(std::string_view text)
{
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
        refuse(text, "", "is not unix:PATH, tcp:HOST:PORT, serial:DEVICE:BAUD or fd:NUMBER");
    }
    const std::string_view kind = text.substr(0, colon);
    const std::string_view rest = text.substr(colon + 1);
    const std::size_t last = rest.rfind(':');
    ListenAddress address;
    if (kind == "unix") {
        address.place = rest;
        if (rest.empty() || rest.size() > kUnixPathMax) {
            refuse(text, "path",
                   "has " + std::to_string(rest.size()) + " bytes, not 1.." + std::to_string(kUnixPathMax));
        }
        return address;
    }
    if (kind == "fd") {
        address.kind = ListenAddress::Kind::inherited;
        address.place = text;
        address.descriptor = static_cast<int>(number(text, rest, "number", kDescriptorMax));
        return address;
    }
    if (kind != "tcp" && kind != "serial") {
        refuse(text, "kind", "'" + std::string(kind) + "' is not unix, tcp, serial or fd");
    }
    if (last == std::string_view::npos || last == 0) {
        refuse(text, "", kind == "tcp" ? "is not tcp:HOST:PORT" : "is not serial:DEVICE:BAUD");
    }
    std::string_view place = rest.substr(0, last);
    const std::string_view digits = rest.substr(last + 1);
    if (kind == "serial") {
        address.kind = ListenAddress::Kind::serial;
        address.baud = number(text, digits, "baud", 4'000'000);
    } else {
        address.kind = ListenAddress::Kind::tcp;
        address.port = std::to_string(number(text, digits, "port", 65535));
        if (place.size() > 2 && place.front() == '[' && place.back() == ']') {
            place = place.substr(1, place.size() - 2);
        }
    }
    address.place = place;
    return address;
}

} // namespace tsr
