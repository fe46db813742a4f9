/*
 * Watching one view, waking the wing, capturing both views at one instant.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"

/* WAKE frames for one capture before the wing counts as out of reach. */
#define WAKE_ATTEMPTS_MAX 5u

struct tsr_gray tsr_node_left_view(struct tsr_node *node)
{
    if (node->config.role == TSR_ROLE_WING) {
        struct tsr_gray view = {node->pair, node->config.match.width, node->config.match.height,
                                node->config.match.width};
        return view;
    }
    return tsr_match_pair_left(node->pair, &node->config.match);
}

enum tsr_status tsr_node_start_capture(struct tsr_node *node, bool right, uint64_t at_us)
{
    struct tsr_capture *capture = right ? &node->right : &node->left;
    struct tsr_camera *camera = right ? &node->hal.right : &node->hal.left;
    struct tsr_gray view = right ? tsr_match_pair_right(node->pair, &node->config.match) : tsr_node_left_view(node);
    __atomic_store_n(&capture->done, false, __ATOMIC_RELAXED);
    enum tsr_status status = camera->ops->capture(camera->self, view, at_us);
    capture->pending = status == TSR_OK;
    return status;
}

/* Whether an awaited capture has ended; it is then no longer pending. */
static bool capture_ended(struct tsr_capture *capture)
{
    if (capture->pending && __atomic_load_n(&capture->done, __ATOMIC_ACQUIRE)) {
        capture->pending = false;
    }
    return !capture->pending;
}

void tsr_node_rest(struct tsr_node *node, uint64_t now_us)
{
    enter(node, TSR_PHASE_IDLE);
    if (node->next_watch_us <= now_us) {
        /* Whole periods of up to an hour at once: a division of 64 bits is a library of 700 bytes on a Cortex-M. */
        uint32_t period_us = node->config.watch_period_us;
        uint32_t most_us = UINT32_MAX / period_us * period_us;
        while (now_us - node->next_watch_us >= most_us) {
            node->next_watch_us += most_us;
        }
        uint32_t late_us = (uint32_t)(now_us - node->next_watch_us);
        node->next_watch_us += (late_us / period_us + 1u) * (uint64_t)period_us;
    }
}

void tsr_node_abandon_capture(struct tsr_node *node, uint64_t now_us)
{
    node->counters.captures_failed++;
    node->recapture = true;
    tsr_node_rest(node, now_us);
}

static void send_wake(struct tsr_node *node, uint64_t now_us)
{
    node->attempt++;
    const struct tsr_body_capture wake = {node->capture_id, node->attempt};
    uint8_t body[TSR_BODY_WAKE_LEN];
    tsr_body_write_capture(&wake, body);
    if (node->attempt > WAKE_ATTEMPTS_MAX ||
        tsr_node_send_short(node, TSR_MESSAGE_WAKE, node->config.partner, body, sizeof body, TOKEN_WAKE) != TSR_OK) {
        tsr_node_abandon_capture(node, now_us);
        return;
    }
    node->counters.wakes_sent++;
    enter(node, TSR_PHASE_WAKING);
}

/* Both boards heard the same frame end at the same instant: that is the common
 * clock of the pair. */
void tsr_node_on_wake_confirm(struct tsr_node *node, const struct tsr_mac_confirm *confirm, uint64_t now_us)
{
    if (node->phase != TSR_PHASE_WAKING) {
        return;
    }
    uint64_t capture_at_us = confirm->time_us + TSR_CAPTURE_DELAY_US;
    if (confirm->status != TSR_OK || now_us > capture_at_us + TSR_CAPTURE_ORDER_US) {
        send_wake(node, now_us);
    } else if (tsr_node_start_capture(node, false, capture_at_us) == TSR_OK) {
        enter(node, TSR_PHASE_CAPTURING);
    } else {
        tsr_node_abandon_capture(node, now_us);
    }
}

static void begin_pair_capture(struct tsr_node *node, uint64_t now_us)
{
    node->counters.frames_woken++;
    node->recapture = false;
    node->capture_id++;
    if (node->next_measure_us != TSR_TIME_NEVER) {
        node->next_measure_us = now_us + node->config.measure_period_us;
    }
    node->attempt = 0;
    if (node->config.role == TSR_ROLE_LEAD) {
        /* In a step of its own: its confirm must not wait until the work of this one is done. */
        node->wake_due = true;
        enter(node, TSR_PHASE_WAKING);
        return;
    }
    /* A right camera that fails to start is seen when the left one is done. */
    node->right.status = tsr_node_start_capture(node, true, now_us + TSR_CAPTURE_DELAY_US);
    if (tsr_node_start_capture(node, false, now_us + TSR_CAPTURE_DELAY_US) == TSR_OK) {
        enter(node, TSR_PHASE_CAPTURING);
    } else {
        tsr_node_abandon_capture(node, now_us);
    }
}

static struct work start_watching(struct tsr_node *node, uint64_t now_us)
{
    if (now_us < node->next_watch_us) {
        return no_work();
    }
    if (!capture_ended(&node->left) || !capture_ended(&node->right) ||
        tsr_node_start_capture(node, false, now_us) != TSR_OK) {
        tsr_node_abandon_capture(node, now_us);
        return no_work();
    }
    enter(node, TSR_PHASE_WATCHING);
    return no_work();
}

static struct work compare_with_background(struct tsr_node *node, uint64_t now_us)
{
    if (!capture_ended(&node->left)) {
        return no_work();
    }
    if (node->left.status != TSR_OK) {
        tsr_node_abandon_capture(node, now_us);
        return no_work();
    }
    struct tsr_gray_view frame = tsr_gray_as_view(tsr_node_left_view(node));
    struct tsr_change_result result;
    (void)tsr_change_update(&node->change, &frame, &result);
    node->counters.frames_watched++;
    bool changed = result.changed || node->recapture;
    if (!result.settling && (changed || now_us >= node->next_measure_us)) {
        node->measures_only = !changed;
        begin_pair_capture(node, now_us);
    } else {
        tsr_node_rest(node, now_us);
    }
    return work_of(TSR_WORK_CHANGE, (size_t)frame.width * frame.height);
}

/* Both views are there, or the left one while the wing's is on its way. What
 * they show becomes the background: one change wakes the pair once. What was
 * only to be measured does not: slow changes must add up. */
static struct work take_views(struct tsr_node *node, uint64_t now_us)
{
    bool right_ended = capture_ended(&node->right);
    if (!capture_ended(&node->left) || !right_ended) {
        return no_work();
    }
    bool binocular = node->config.role == TSR_ROLE_BINOCULAR;
    if (node->left.status != TSR_OK || (binocular && node->right.status != TSR_OK)) {
        tsr_node_abandon_capture(node, now_us);
        return no_work();
    }
    node->capture_time_us = node->left.time_us;
    struct tsr_gray_view frame = tsr_gray_as_view(tsr_node_left_view(node));
    if (!node->measures_only) {
        (void)tsr_change_rebase(&node->change, &frame);
    }
    node->measures_only = node->measures_only || node->map_under_way;
    if (binocular) {
        enter(node, TSR_PHASE_REFERENCE);
    } else {
        tsr_node_reset_inbox(node);
        node->phase_timer_us = now_us + TSR_SENDER_WAIT_MAX_US;
        enter(node, TSR_PHASE_RECEIVING);
    }
    return work_of(TSR_WORK_CHANGE, (size_t)frame.width * frame.height);
}

static struct work await_view(struct tsr_node *node, uint64_t now_us)
{
    if (node->inbox_ready) {
        enter(node, TSR_PHASE_UNPACKING);
    } else if (now_us >= node->phase_timer_us) {
        tsr_node_abandon_capture(node, now_us);
    }
    return no_work();
}

static struct work wake_wing(struct tsr_node *node, uint64_t now_us)
{
    if (node->wake_due) {
        node->wake_due = false;
        send_wake(node, now_us);
    }
    return no_work(); /* WAKING ends with a confirm */
}

struct work tsr_node_watch(struct tsr_node *node, uint64_t now_us)
{
    switch (node->phase) {
    case TSR_PHASE_IDLE: return start_watching(node, now_us);
    case TSR_PHASE_WATCHING: return compare_with_background(node, now_us);
    case TSR_PHASE_WAKING: return wake_wing(node, now_us);
    case TSR_PHASE_CAPTURING: return take_views(node, now_us);
    case TSR_PHASE_RECEIVING: return await_view(node, now_us);
    default: return no_work();
    }
}
