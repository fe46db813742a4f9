/*
 * The loop that waits for gateways: a listening socket with its connections,
 * or one link: a serial port, or an inherited socket. All bytes that are there at one moment are one batch:
 * one commit, then the answers.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_GATEWAY_H
#define TSR_SINK_GATEWAY_H

#include <functional>
#include <memory>
#include <string>

#include "tsr/sink/link_session.h"
#include "tsr/sink/listen_address.h"

namespace tsr
{

struct GatewayOptions {
    bool once = false; /* return when the last connection has closed */
    std::function<void(const std::string &)> log = [](const std::string &) {};
};

/* An opened address: it can be had before anything else of a sink is made. */
class Gateways
{
  public:
    /* Throws InputError if address cannot be opened. SIGINT and SIGTERM are
     * blocked from here on and taken from a descriptor. */
    Gateways(const ListenAddress &address, const GatewayOptions &options);
    ~Gateways();
    Gateways(const Gateways &) = delete;
    Gateways &operator=(const Gateways &) = delete;

    /* Serve until SIGINT or SIGTERM arrives, the one link goes away, or options.once says so. */
    void serve(LinkServer &server);

  private:
    class Loop;
    std::unique_ptr<Loop> loop_; /* too large for some stacks */
};

} // namespace tsr

#endif
