/*
 * Where the gateway link comes in:
 *
 *   unix:PATH              a Unix stream socket that the sink creates
 *   tcp:HOST:PORT          HOST a name, an address or [IPv6 address]
 *   serial:DEVICE:BAUD     a serial port, 8N1, raw
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_LISTEN_ADDRESS_H
#define TSR_SINK_LISTEN_ADDRESS_H

#include <string>
#include <string_view>

namespace tsr
{

struct ListenAddress {
    enum class Kind {
        unix_socket,
        tcp,
        serial
    };
    Kind kind = Kind::unix_socket;
    std::string place; /* path, host or device */
    std::string port;  /* tcp */
    unsigned baud = 0; /* serial */
};

/* Throws InputError whose file is "--listen TEXT". */
ListenAddress parse_listen_address(std::string_view text);

} // namespace tsr

#endif
