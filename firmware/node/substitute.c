/* A coder of one's own in the place of the map's. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/node/substitute.h"

#include <string.h>

#include "internal.h"

bool tsr_node_take_pair(struct tsr_node *node, struct tsr_gray_view *left, struct tsr_gray_view *right)
{
    if (node->config.role != TSR_ROLE_BINOCULAR || node->phase != TSR_PHASE_REFERENCE || node->row > 0) {
        return false;
    }
    *left = tsr_gray_as_view(tsr_node_left_view(node));
    *right = tsr_gray_as_view(tsr_match_pair_right(node->pair, &node->config.match));
    enter(node, TSR_PHASE_FILTERING); /* a wing's: no stage of this role */
    return true;
}

enum tsr_status tsr_node_send_pair(struct tsr_node *node, const uint8_t *left, size_t left_len, const uint8_t *right,
                                   size_t right_len, uint64_t now_us)
{
    uint8_t *body = node->message + TSR_MESSAGE_HEADER_LEN;
    size_t body_cap = node->message_cap - TSR_MESSAGE_OVERHEAD_LEN;
    enum tsr_status status = TSR_ERR_NOBUF;
    if (left_len <= body_cap - TSR_BODY_MAP_HEADER_LEN && right_len <= body_cap - TSR_BODY_MAP_HEADER_LEN - left_len) {
        tsr_body_write_map_header(node->capture_time_us, node->capture_id, left_len, body);
        memcpy(body + TSR_BODY_MAP_HEADER_LEN, left, left_len);
        memcpy(body + TSR_BODY_MAP_HEADER_LEN + left_len, right, right_len);
        node->body_len = TSR_BODY_MAP_HEADER_LEN + left_len + right_len;
        status = tsr_node_start_sealing(node, TSR_MESSAGE_MAP, TSR_ADDRESS_SINK);
    }
    if (status != TSR_OK) {
        tsr_node_abandon_capture(node, now_us);
        return status;
    }
    node->counters.maps_made++;
    enter(node, TSR_PHASE_SEALING);
    return TSR_OK;
}

void tsr_node_wake_next(struct tsr_node *node)
{
    node->recapture = true;
}
