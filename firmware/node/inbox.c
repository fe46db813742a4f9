/*
 * Messages for this node: WAKE and STATUS at once, a VIEW from its fragments.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"

void tsr_node_reset_inbox(struct tsr_node *node)
{
    tsr_reassembly_init(&node->inbox, node->message, node->message_cap);
    node->inbox_ready = false;
}

/* Counters of one peer only grow; a repetition of an old message is refused. */
static bool counter_is_fresh(struct tsr_node *node, const struct tsr_message_header *header)
{
    bool partner = header->key_use == TSR_KEY_PAIR;
    uint32_t *last = partner ? &node->partner_counter : &node->sink_counter;
    bool *heard = partner ? &node->partner_heard : &node->sink_heard;
    if (*heard && header->counter <= *last) {
        node->counters.dropped_replay++;
        return false;
    }
    *last = header->counter;
    *heard = true;
    return true;
}

/* Whether origin and key use belong together: the partner's or the sink's. */
static bool origin_is_known(const struct tsr_node *node, const struct tsr_message_header *header)
{
    return header->key_use == TSR_KEY_PAIR ? header->origin == node->config.partner
                                           : header->origin == TSR_ADDRESS_SINK;
}

static void take_short(struct tsr_node *node, const struct tsr_fragment *fragment,
                       const struct tsr_message_header *header, uint64_t frame_time_us, uint64_t now_us)
{
    if (!origin_is_known(node, header)) {
        node->counters.dropped_foreign++;
        return;
    }
    const struct tsr_cipher *cipher = header->key_use == TSR_KEY_PAIR ? &node->pair_cipher : &node->node_cipher;
    uint8_t message[TSR_FRAGMENT_PIECE_MAX];
    memcpy(message, fragment->piece, fragment->piece_len);
    size_t body_len = 0;
    if (tsr_message_open(header, cipher, message, fragment->piece_len, &body_len) != TSR_OK) {
        node->counters.dropped_auth++;
        return;
    }
    if (!counter_is_fresh(node, header)) {
        return;
    }
    const uint8_t *body = message + TSR_MESSAGE_HEADER_LEN;
    struct tsr_body_status status;
    struct tsr_body_capture wake;
    if (header->kind == TSR_MESSAGE_STATUS && header->origin == node->sender.destination &&
        tsr_body_read_status(body, body_len, &status) == TSR_OK) { /* nobody else can accept what it sends */
        tsr_sender_on_status(&node->sender, &status, now_us);
        tsr_sender_on_status(&node->notice.sender, &status, now_us);
    } else if (header->kind == TSR_MESSAGE_WAKE && node->config.role == TSR_ROLE_WING &&
               header->key_use == TSR_KEY_PAIR && tsr_body_read_capture(body, body_len, &wake) == TSR_OK) {
        tsr_node_on_wake(node, &wake, frame_time_us);
    } else {
        node->counters.dropped_foreign++;
    }
}

/* A piece of the wing's view, or of something this node does not expect. */
static void take_piece(struct tsr_node *node, const struct tsr_fragment *fragment, uint64_t now_us)
{
    if (node->config.role != TSR_ROLE_LEAD || fragment->origin != node->config.partner) {
        node->counters.dropped_foreign++;
        return;
    }
    if (node->inbox_done && fragment->message_id == node->inbox_done_id) {
        if (fragment->poll) { /* it was accepted, the answer was lost */
            tsr_node_answer(node, fragment->message_id, TSR_DELIVERY_COMMITTED);
        }
        return;
    }
    if (node->phase == TSR_PHASE_UNPACKING && tsr_reassembly_matches(&node->inbox, fragment)) {
        return; /* complete and being opened: the answer follows */
    }
    if (node->phase != TSR_PHASE_RECEIVING) {
        /* The wing may be done with its view before this camera is: no answer, and it polls again. */
        bool early = node->phase == TSR_PHASE_WAKING || node->phase == TSR_PHASE_CAPTURING;
        node->counters.dropped_foreign++;
        if (fragment->poll && !early) {
            tsr_node_answer(node, fragment->message_id, TSR_DELIVERY_REFUSED);
        }
        return;
    }
    if (!tsr_reassembly_matches(&node->inbox, fragment) && tsr_reassembly_begin(&node->inbox, fragment) != TSR_OK) {
        node->counters.dropped_format++;
        return;
    }
    uint16_t received = node->inbox.received;
    enum tsr_status status = tsr_reassembly_add(&node->inbox, fragment);
    if (status < TSR_OK) {
        node->counters.dropped_format++;
    } else if (node->inbox.received != received) {
        node->phase_timer_us = now_us + TSR_SENDER_WAIT_MAX_US;
    }
    node->inbox_ready = tsr_reassembly_complete(&node->inbox);
    if (fragment->poll && status == TSR_AGAIN) {
        tsr_node_answer(node, fragment->message_id, TSR_DELIVERY_MISSING);
    }
}

void tsr_node_take_fragment(struct tsr_node *node, const struct tsr_fragment *fragment, uint64_t frame_time_us,
                            uint64_t now_us)
{
    struct tsr_message_header header;
    if (fragment->count == 1 &&
        tsr_message_parse(fragment->piece, fragment->piece_len, fragment->origin, fragment->destination, &header) ==
            TSR_OK &&
        header.kind != TSR_MESSAGE_VIEW) {
        take_short(node, fragment, &header, frame_time_us, now_us);
    } else {
        take_piece(node, fragment, now_us);
    }
}
