/*
 * Next hop in a static tree.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/net/route.h"

uint16_t tsr_route_next(const struct tsr_routes *routes, uint16_t destination)
{
    for (uint16_t i = 0; i < routes->descendant_count; i++) {
        if (routes->descendants[i].destination == destination) {
            return routes->descendants[i].next_hop;
        }
    }
    return routes->parent;
}
