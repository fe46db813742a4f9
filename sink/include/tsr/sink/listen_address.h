/*
 * Where the gateway link comes in:
 *
 *   unix:PATH              a Unix stream socket that the sink creates
 *   tcp:HOST:PORT          HOST a name, an address or [IPv6 address]
 *   serial:DEVICE:BAUD     a serial port, 8N1, raw
 *   fd:NUMBER              a connected stream socket, inherited from the process that started the sink
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
        serial,
        inherited
    };
    Kind kind = Kind::unix_socket;
    std::string place;   /* path, host, device or "fd:NUMBER" */
    std::string port;    /* tcp */
    unsigned baud = 0;   /* serial */
    int descriptor = -1; /* inherited */

    /* A link that is there from the start and comes once: nobody can connect to it. */
    bool is_one_link() const { return kind == Kind::serial || kind == Kind::inherited; }
};

/* Throws InputError whose file is "--listen TEXT". */
ListenAddress parse_listen_address(std::string_view text);

} // namespace tsr

#endif
