/*
 * Forwarding: fragments for others go on by the tree, or to the sink.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "internal.h"

enum tsr_status tsr_node_forward(struct tsr_node *node, const struct tsr_fragment *fragment)
{
    uint16_t next_hop = tsr_route_next(&node->config.routes, fragment->destination);
    if (fragment->ttl == 0 || next_hop == TSR_ADDRESS_NONE) {
        node->counters.dropped_route++;
        return TSR_ERR_NOROUTE;
    }
    struct tsr_fragment onward = *fragment;
    onward.ttl--;
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    enum tsr_status status = tsr_fragment_write(&onward, payload, sizeof payload, &len);
    if (status == TSR_OK) {
        status = tsr_mac_send(&node->mac, next_hop, payload, len, TOKEN_NONE, false);
    }
    if (status == TSR_OK) {
        node->counters.forwarded++;
    }
    return status;
}

/* Whether the way the fragment has to go can take it now; until then it stays
 * in the MAC's ring, and a full ring stops the radio from acknowledging. */
static bool way_is_free(const struct tsr_node *node, const struct tsr_fragment *fragment)
{
    if (fragment->destination == node->config.address) {
        return true;
    }
    if (node->config.role == TSR_ROLE_GATEWAY && fragment->destination == TSR_ADDRESS_SINK) {
        return tsr_node_uplink_free(node);
    }
    return tsr_mac_room(&node->mac) > 0;
}

bool tsr_node_take_frame(struct tsr_node *node, uint64_t now_us)
{
    const struct tsr_mac_frame *frame = tsr_mac_received(&node->mac);
    if (frame == NULL) {
        return false;
    }
    struct tsr_fragment fragment;
    if (tsr_fragment_read(frame->payload, frame->len, &fragment) != TSR_OK) {
        node->counters.dropped_format++;
    } else if (!way_is_free(node, &fragment)) {
        return false;
    } else if (fragment.destination == node->config.address) {
        tsr_node_take_fragment(node, &fragment, frame->time_us, now_us);
    } else if (node->config.role == TSR_ROLE_GATEWAY && fragment.destination == TSR_ADDRESS_SINK) {
        tsr_node_send_uplink(node, frame->payload, frame->len, frame->time_us, now_us);
    } else {
        tsr_node_forward(node, &fragment);
    }
    tsr_mac_release(&node->mac);
    return true;
}
