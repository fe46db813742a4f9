/*
 * Routes of a static tree: to a descendant by a table, to anyone else upward.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NET_ROUTE_H
#define TSR_NET_ROUTE_H

#include <stdint.h>

#include "tsr/wire/address.h"

struct tsr_route {
    uint16_t destination; /* a descendant */
    uint16_t next_hop;    /* the child it is behind, or itself */
};

struct tsr_routes {
    uint16_t parent; /* TSR_ADDRESS_NONE at the gateway */
    uint16_t descendant_count;
    const struct tsr_route *descendants; /* kept */
};

/* The neighbour to send to, or TSR_ADDRESS_NONE if there is none. */
uint16_t tsr_route_next(const struct tsr_routes *routes, uint16_t destination);

#endif
