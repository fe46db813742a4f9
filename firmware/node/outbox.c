/*
 * Messages from this node: short ones at once, long ones sealed piece by piece
 * and given to the sender.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"

static const struct tsr_cipher *cipher_for(const struct tsr_node *node, uint16_t destination, uint8_t *key_use)
{
    bool pair = destination == node->config.partner;
    *key_use = pair ? TSR_KEY_PAIR : TSR_KEY_NODE;
    return pair ? &node->pair_cipher : &node->node_cipher;
}

/* A header with a fresh counter; TSR_ERR_ARG when they are used up. */
static enum tsr_status make_header(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination,
                                   struct tsr_message_header *header)
{
    if (node->message_counter == UINT32_MAX) {
        return TSR_ERR_ARG;
    }
    header->kind = (uint8_t)kind;
    header->origin = node->config.address;
    header->destination = destination;
    header->counter = ++node->message_counter;
    return TSR_OK;
}

enum tsr_status tsr_node_seal_short(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination,
                                    uint8_t message[TSR_FRAGMENT_PIECE_MAX], size_t body_len, size_t *message_len,
                                    uint32_t *counter)
{
    struct tsr_message_header header;
    const struct tsr_cipher *cipher = cipher_for(node, destination, &header.key_use);
    enum tsr_status status = make_header(node, kind, destination, &header);
    if (status == TSR_OK) {
        *counter = header.counter;
        status = tsr_message_seal(&header, cipher, message, TSR_FRAGMENT_PIECE_MAX, body_len, message_len);
    }
    return status;
}

enum tsr_status tsr_node_send_short(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination,
                                    const uint8_t *body, size_t body_len, enum token token)
{
    if (tsr_mac_room(&node->mac) == 0) {
        return TSR_ERR_NOBUF;
    }
    uint8_t message[TSR_FRAGMENT_PIECE_MAX];
    if (body_len + TSR_MESSAGE_OVERHEAD_LEN > sizeof message) {
        return TSR_ERR_SIZE;
    }
    memcpy(message + TSR_MESSAGE_HEADER_LEN, body, body_len);
    size_t message_len = 0;
    uint32_t counter = 0;
    enum tsr_status status = tsr_node_seal_short(node, kind, destination, message, body_len, &message_len, &counter);
    if (status != TSR_OK) {
        return status;
    }
    struct tsr_fragment fragment = tsr_fragment_of(message, message_len, 0);
    fragment.origin = node->config.address;
    fragment.destination = destination;
    fragment.message_id = (uint16_t)counter;
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    status = tsr_fragment_write(&fragment, payload, sizeof payload, &len);
    uint16_t next_hop = tsr_route_next(&node->config.routes, destination);
    if (status != TSR_OK || next_hop == TSR_ADDRESS_NONE) {
        return status != TSR_OK ? status : TSR_ERR_NOROUTE;
    }
    /* A WAKE is timed by the one transmission that is acknowledged, so the MAC
     * must not repeat it by itself. */
    return tsr_mac_send(&node->mac, next_hop, payload, len, (uint16_t)token, kind == TSR_MESSAGE_WAKE);
}

void tsr_node_answer(struct tsr_node *node, uint16_t message_id, enum tsr_delivery state)
{
    struct tsr_body_status status;
    if (state == TSR_DELIVERY_MISSING) {
        status = tsr_body_status_of(&node->inbox, TSR_DELIVERY_COMMITTED);
    } else {
        memset(&status, 0, sizeof status);
        status.state = (uint8_t)state;
    }
    status.message_id = message_id;
    uint8_t body[TSR_BODY_STATUS_MAX];
    size_t body_len = 0;
    if (tsr_body_write_status(&status, body, sizeof body, &body_len) != TSR_OK ||
        tsr_node_send_short(node, TSR_MESSAGE_STATUS, node->config.partner, body, body_len, TOKEN_NONE) != TSR_OK) {
        node->counters.dropped_queue++; /* it is asked for again */
    }
}

enum tsr_status tsr_node_start_sealing(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination)
{
    struct tsr_message_header header;
    const struct tsr_cipher *cipher = cipher_for(node, destination, &header.key_use);
    enum tsr_status status = make_header(node, kind, destination, &header);
    if (status != TSR_OK) {
        return status;
    }
    node->sealed = 0;
    node->sealing_counter = header.counter; /* short messages take counters meanwhile */
    return tsr_message_seal_start(&node->ccm, &header, cipher, node->message, node->message_cap, node->body_len);
}

struct work tsr_node_continue_sealing(struct tsr_node *node, uint16_t destination, uint64_t now_us, bool *done)
{
    *done = false;
    uint8_t *body = node->message + TSR_MESSAGE_HEADER_LEN;
    size_t left = node->body_len - node->sealed;
    if (left > 0) {
        size_t len = left < SEAL_BYTES_PER_STEP ? left : SEAL_BYTES_PER_STEP;
        (void)tsr_ccm_update(&node->ccm, body + node->sealed, len);
        node->sealed += len;
        return work_of(TSR_WORK_SEAL, len);
    }
    if (!tsr_sender_is_idle(&node->sender)) {
        return no_work(); /* its last frame is still in the MAC; the confirm wakes us */
    }
    (void)tsr_ccm_seal(&node->ccm, body + node->body_len);
    node->message_len = node->body_len + TSR_MESSAGE_OVERHEAD_LEN;
    (void)tsr_sender_start(&node->sender, node->message, node->message_len, destination, node->sealing_counter, now_us);
    *done = true;
    return no_work();
}
