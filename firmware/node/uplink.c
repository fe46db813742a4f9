/*
 * The gateway's side of the link to the sink: one frame unanswered at a time,
 * repeated until it is answered.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "internal.h"
#include "tsr/base/bytes.h"

static void transmit(struct tsr_node *node, uint64_t now_us)
{
    struct tsr_uplink *uplink = &node->uplink;
    /* A port that cannot take the frame now gets it again with the timer. */
    (void)node->hal.port.ops->write(node->hal.port.self, uplink->frame, uplink->frame_len);
    uplink->timer_us = now_us + TSR_LINK_ANSWER_TIMEOUT_US;
}

static void send_frame(struct tsr_node *node, enum tsr_link_type type, const uint8_t *body, size_t body_len,
                       uint64_t now_us)
{
    struct tsr_uplink *uplink = &node->uplink;
    const struct tsr_link_frame frame = {(uint8_t)type, ++uplink->sequence, body, body_len};
    size_t len = 0;
    if (tsr_link_encode(&frame, uplink->frame, sizeof uplink->frame, &len) != TSR_OK) {
        return; /* TSR_NODE_UPLINK_MAX holds every frame this file makes */
    }
    uplink->frame_len = (uint16_t)len;
    uplink->waiting = true;
    transmit(node, now_us);
}

void tsr_node_start_uplink(struct tsr_node *node, uint64_t now_us)
{
    tsr_link_decoder_init(&node->uplink.decoder);
    uint8_t body[TSR_LINK_HELLO_LEN];
    struct tsr_writer writer = tsr_writer_make(body, sizeof body);
    tsr_write_u8(&writer, TSR_LINK_VERSION);
    tsr_write_u16(&writer, node->config.pan_id);
    tsr_write_u16(&writer, node->config.address);
    send_frame(node, TSR_LINK_HELLO, body, sizeof body, now_us);
}

bool tsr_node_uplink_free(const struct tsr_node *node)
{
    return !node->uplink.waiting;
}

void tsr_node_send_uplink(struct tsr_node *node, const uint8_t *fragment, size_t len, uint64_t time_us, uint64_t now_us)
{
    uint8_t body[TSR_LINK_UPLINK_HEADER_LEN + TSR_FRAME_PAYLOAD_MAX];
    struct tsr_writer writer = tsr_writer_make(body, sizeof body);
    tsr_write_u64(&writer, time_us);
    tsr_write_span(&writer, fragment, len);
    node->counters.uplinks++;
    send_frame(node, TSR_LINK_UPLINK, body, writer.at, now_us);
}

void tsr_node_repeat_uplink(struct tsr_node *node, uint64_t now_us)
{
    if (node->uplink.waiting && now_us >= node->uplink.timer_us) {
        node->counters.uplink_repeats++;
        transmit(node, now_us);
    }
}

/* The fragments inside an ANSWER go down the tree. What finds no room is lost:
 * its receiver polls again. */
static void take_answer(struct tsr_node *node, const struct tsr_link_frame *frame)
{
    struct tsr_reader reader = tsr_reader_make(frame->body, frame->body_len);
    while (tsr_reader_left(&reader) > 0) {
        uint8_t len = tsr_read_u8(&reader);
        const uint8_t *bytes = tsr_read_span(&reader, len);
        struct tsr_fragment fragment;
        if (bytes == NULL || tsr_fragment_read(bytes, len, &fragment) != TSR_OK) {
            node->counters.port_rejected++;
            return;
        }
        enum tsr_status status = tsr_node_forward(node, &fragment);
        if (status == TSR_OK) {
            node->counters.downlinks++;
        } else if (status != TSR_ERR_NOROUTE) { /* that one is counted */
            node->counters.dropped_queue++;
        }
    }
}

void tsr_node_on_port(struct tsr_node *node, const uint8_t *bytes, size_t len, uint64_t now_us)
{
    (void)now_us;
    struct tsr_uplink *uplink = &node->uplink;
    for (size_t i = 0; i < len; i++) {
        struct tsr_link_frame frame;
        enum tsr_status status = tsr_link_decode(&uplink->decoder, bytes[i], &frame);
        if (status == TSR_ERR_FORMAT) {
            node->counters.port_rejected++;
        }
        if (status != TSR_OK || frame.type != TSR_LINK_ANSWER || !uplink->waiting ||
            frame.sequence != uplink->sequence) {
            continue;
        }
        uplink->waiting = false;
        uplink->timer_us = TSR_TIME_NEVER;
        take_answer(node, &frame);
    }
}
