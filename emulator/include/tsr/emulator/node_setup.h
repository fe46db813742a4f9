/*
 * From a site's description to the configuration of each node's firmware.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_NODE_SETUP_H
#define TSR_EMULATOR_NODE_SETUP_H

#include <memory>
#include <vector>

extern "C" {
#include "tsr/node/node.h"
}
#include "tsr/host/keys.h"
#include "tsr/host/site.h"

namespace tsr
{

struct NodeSetup {
    tsr_node_config config{};
    std::vector<tsr_route> routes;     /* config.routes points into it */
    std::vector<tsr_depth_rule> rules; /* and config.rules into this */
};

/* Throws InputError naming the pair's field the firmware refuses. The result is
 * kept behind a pointer because config points into it. */
std::unique_ptr<NodeSetup> set_up_node(const Site &site, const SiteNode &node, const KeyRing &keys);

} // namespace tsr

#endif
