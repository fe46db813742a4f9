/*
 * The wing: woken by its lead, it captures once and sends its view, as the
 * matcher's mode needs it and against the last one if the lead has said that it has that.
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

/* A view that is not known to be the lead's is not held either: the next one goes on its own. */
static void count_view(struct tsr_node *node, bool accepted)
{
    if (accepted) {
        node->counters.views_sent++;
    } else {
        node->counters.views_lost++;
        node->held.full = false;
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
    } else if (node->phase == TSR_PHASE_FILTERING || node->phase == TSR_PHASE_COMPARING ||
               node->phase == TSR_PHASE_ENCODING || node->phase == TSR_PHASE_SEALING) {
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
        enter(node, TSR_PHASE_FILTERING);
    } else {
        node->counters.captures_failed++;
        enter(node, TSR_PHASE_IDLE);
    }
    return no_work();
}

/* The scratch of a view being coded: encoder, tiles, the coder's rows. The prefilter's lies over it before. */
static uint8_t *tiles_of(const struct tsr_node *node)
{
    return node->scratch + sizeof(struct tsr_view_encoder);
}

static size_t count_tiles(const struct tsr_node *node)
{
    return TSR_VIEW_TILE_COUNT(node->config.match.width, node->config.match.height);
}

static struct tsr_view_info info_of(const struct tsr_node *node)
{
    struct tsr_view_info info = {.width = node->config.match.width,
                                 .height = node->config.match.height,
                                 .cap = tsr_match_prefilter_cap(&node->config.match),
                                 .against_held = node->held.full};
    info.coarse = info.cap == TSR_VIEW_CAP_MAX;
    return info;
}

static struct work filter_view(struct tsr_node *node)
{
    struct tsr_gray view = tsr_node_left_view(node);
    if (node->row == 0) {
        (void)tsr_prefilter_start(&node->work.prefilter, view, tsr_match_prefilter_cap(&node->config.match),
                                  node->scratch, node->scratch_cap);
    }
    uint16_t rows = rows_of_step(node, (unsigned)view.height - node->row);
    node->row = (uint16_t)(node->row + rows);
    if (tsr_prefilter_run(&node->work.prefilter, rows) == TSR_OK) {
        enter(node, node->held.full ? TSR_PHASE_COMPARING : TSR_PHASE_ENCODING);
    }
    return work_of(TSR_WORK_VIEW_FILTER, (size_t)rows * view.width);
}

/* A row of tiles: what the lead holds already need not be sent. */
static struct work compare_view(struct tsr_node *node)
{
    struct tsr_gray view = tsr_node_left_view(node);
    unsigned left = (unsigned)view.height - node->row;
    uint16_t rows = (uint16_t)(left < TSR_VIEW_TILE_PX ? left : TSR_VIEW_TILE_PX);
    struct tsr_view_change *change = &node->work.view_change;
    change->tiles = tiles_of(node);
    change->tiles_cap = count_tiles(node);
    (void)tsr_view_compare(&node->held, view.pixels + (size_t)node->row * view.stride, view.stride, node->row, rows,
                           change);
    node->row = (uint16_t)(node->row + rows);
    if (node->row == view.height) {
        (void)tsr_view_choose(change, count_tiles(node), 0);
        enter(node, TSR_PHASE_ENCODING);
    }
    return work_of(TSR_WORK_VIEW_FILTER, (size_t)rows * view.width);
}

static struct work encode_view(struct tsr_node *node)
{
    struct tsr_gray view = tsr_node_left_view(node);
    struct tsr_view_encoder *encoder = (struct tsr_view_encoder *)(void *)node->scratch;
    uint8_t *body = node->message + TSR_MESSAGE_HEADER_LEN;
    if (node->row == 0) {
        const struct tsr_view_info info = info_of(node);
        const struct tsr_body_capture capture = {node->capture_id, node->attempt};
        const size_t in_front = sizeof *encoder + count_tiles(node);
        tsr_body_write_capture(&capture, body);
        (void)tsr_view_encode_start(encoder, &info, &node->held, tiles_of(node), body + TSR_BODY_VIEW_HEADER_LEN,
                                    node->message_cap - TSR_MESSAGE_OVERHEAD_LEN - TSR_BODY_VIEW_HEADER_LEN,
                                    node->scratch + in_front, node->scratch_cap - in_front);
    }
    uint16_t rows = rows_of_step(node, (unsigned)view.height - node->row);
    enum tsr_status status =
        tsr_view_encode_rows(encoder, view.pixels + (size_t)node->row * view.stride, view.stride, rows);
    node->row = (uint16_t)(node->row + rows);
    size_t len = 0;
    if (status == TSR_OK) {
        status = tsr_view_encode_finish(encoder, &len);
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
    case TSR_PHASE_FILTERING: return filter_view(node);
    case TSR_PHASE_COMPARING: return compare_view(node);
    case TSR_PHASE_ENCODING: return encode_view(node);
    case TSR_PHASE_SEALING: return seal_view(node, now_us);
    case TSR_PHASE_SENDING: return await_acceptance(node);
    default: return no_work();
    }
}
