/*
 * The loop that waits for gateways: a listening socket with its connections,
 * or one serial port. All bytes that are there at one moment are one batch:
 * one commit, then the answers.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_GATEWAY_H
#define TSR_SINK_GATEWAY_H

#include <functional>
#include <string>

#include "tsr/sink/link_session.h"
#include "tsr/sink/listen_address.h"

namespace tsr
{

struct GatewayOptions {
    bool once = false; /* return when the last connection has closed */
    std::function<void(const std::string &)> log = [](const std::string &) {};
};

/*
 * Serve until SIGINT or SIGTERM arrives (both are blocked from here on and
 * taken from a descriptor), the serial port goes away, or options.once says so.
 * Throws InputError if address cannot be opened.
 */
void serve_gateways(const ListenAddress &address, LinkServer &server, const GatewayOptions &options);

} // namespace tsr

#endif
