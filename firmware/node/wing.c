/*
 * The wing: woken by its lead, it captures once and sends its view.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "internal.h"

void tsr_node_on_wake(struct tsr_node *node, const struct tsr_body_capture *wake, uint64_t frame_time_us)
{
    /* Of the same capture only the last attempt counts: its frame end is the
     * instant the lead knows. */
    node->capture_id = wake->capture_id;
    node->attempt = wake->attempt;
    node->capture_at_us = frame_time_us + TSR_CAPTURE_DELAY_US;
    node->wake_due = true;
}

static void count_view(struct tsr_node *node, bool accepted)
{
    if (accepted) {
        node->counters.views_sent++;
    } else {
        node->counters.views_lost++;
    }
}

/* A new WAKE makes an older view useless. */
static void drop_view(struct tsr_node *node)
{
    if (node->phase == TSR_PHASE_SENDING && tsr_sender_is_idle(&node->sender)) {
        count_view(node, tsr_sender_result(&node->sender) == TSR_OK);
    } else if (node->phase == TSR_PHASE_SENDING) {
        tsr_sender_abort(&node->sender);
        count_view(node, false);
    } else if (node->phase == TSR_PHASE_ENCODING || node->phase == TSR_PHASE_SEALING) {
        count_view(node, false);
    }
    node->left.pending = false;
    enter(node, TSR_PHASE_IDLE);
}

/* Drop what is under way as soon as the camera has given its buffer back, and
 * order the capture only shortly before its instant: until then the lead may
 * wake again for a later one. */
static void obey_wake(struct tsr_node *node, uint64_t now_us)
{
    bool camera_free = !node->left.pending || __atomic_load_n(&node->left.done, __ATOMIC_ACQUIRE);
    if (!node->wake_due || !camera_free) {
        return;
    }
    drop_view(node);
    if (now_us + TSR_CAPTURE_ORDER_US < node->capture_at_us) {
        return;
    }
    node->wake_due = false;
    if (now_us <= node->capture_at_us + TSR_CAPTURE_ORDER_US &&
        tsr_node_start_capture(node, false, node->capture_at_us) == TSR_OK) {
        enter(node, TSR_PHASE_CAPTURING);
    } else {
        node->counters.captures_failed++;
    }
}

static struct work await_capture(struct tsr_node *node)
{
    if (!__atomic_load_n(&node->left.done, __ATOMIC_ACQUIRE)) {
        return no_work();
    }
    node->left.pending = false;
    if (node->left.status == TSR_OK) {
        enter(node, TSR_PHASE_ENCODING);
    } else {
        node->counters.captures_failed++;
        enter(node, TSR_PHASE_IDLE);
    }
    return no_work();
}

static struct work encode_view(struct tsr_node *node)
{
    struct tsr_gray view = tsr_node_left_view(node);
    struct tsr_gray_encoder *encoder = (struct tsr_gray_encoder *)(void *)node->scratch;
    uint8_t *body = node->message + TSR_MESSAGE_HEADER_LEN;
    if (node->row == 0) {
        const struct tsr_gray_info info = {view.width, view.height, 0};
        const struct tsr_body_capture capture = {node->capture_id, node->attempt};
        tsr_body_write_capture(&capture, body);
        (void)tsr_gray_encode_start(encoder, &info, body + TSR_BODY_VIEW_HEADER_LEN,
                                    node->message_cap - TSR_MESSAGE_OVERHEAD_LEN - TSR_BODY_VIEW_HEADER_LEN,
                                    node->scratch + sizeof *encoder, node->scratch_cap - sizeof *encoder);
    }
    uint16_t rows = rows_of_step(node, (unsigned)view.height - node->row);
    enum tsr_status status =
        tsr_gray_encode_rows(encoder, view.pixels + (size_t)node->row * view.stride, view.stride, rows);
    node->row = (uint16_t)(node->row + rows);
    size_t len = 0;
    if (status == TSR_OK) {
        status = tsr_gray_encode_finish(encoder, &len);
    }
    if (status == TSR_OK) {
        node->body_len = TSR_BODY_VIEW_HEADER_LEN + len;
        status = tsr_node_start_sealing(node, TSR_MESSAGE_VIEW, node->config.partner);
    }
    if (status == TSR_OK) {
        enter(node, TSR_PHASE_SEALING);
    } else if (status != TSR_AGAIN) {
        count_view(node, false);
        enter(node, TSR_PHASE_IDLE);
    }
    return work_of(TSR_WORK_VIEW_ENCODE, (size_t)rows * view.width);
}

static struct work seal_view(struct tsr_node *node, uint64_t now_us)
{
    bool done = false;
    struct work work = tsr_node_continue_sealing(node, node->config.partner, now_us, &done);
    if (done) {
        node->counters.view_bytes += (uint32_t)node->message_len;
        enter(node, TSR_PHASE_SENDING);
    }
    return work;
}

static struct work await_acceptance(struct tsr_node *node)
{
    if (tsr_sender_is_idle(&node->sender)) {
        count_view(node, tsr_sender_result(&node->sender) == TSR_OK);
        enter(node, TSR_PHASE_IDLE);
    }
    return no_work();
}

struct work tsr_node_serve_lead(struct tsr_node *node, uint64_t now_us)
{
    obey_wake(node, now_us);
    switch (node->phase) {
    case TSR_PHASE_CAPTURING: return await_capture(node);
    case TSR_PHASE_ENCODING: return encode_view(node);
    case TSR_PHASE_SEALING: return seal_view(node, now_us);
    case TSR_PHASE_SENDING: return await_acceptance(node);
    default: return no_work();
    }
}
