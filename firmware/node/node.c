/*
 * Life cycle of a node: init, step, events.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"

static void place_regions(struct tsr_node *node, const struct tsr_memory_plan *plan, uint8_t *arena)
{
    if (plan->total == 0) {
        return; /* arena may be null */
    }
    node->pair = arena + plan->offset[TSR_REGION_PAIR];
    node->message = arena + plan->offset[TSR_REGION_MESSAGE];
    node->message_cap = plan->len[TSR_REGION_MESSAGE];
    node->last_map = (uint16_t *)(void *)(arena + plan->offset[TSR_REGION_LAST_MAP]);
    node->held.packed = arena + plan->offset[TSR_REGION_HELD_VIEW];
    node->held.packed_cap = plan->len[TSR_REGION_HELD_VIEW];
    node->scratch = arena + plan->offset[TSR_REGION_SCRATCH];
    node->scratch_cap = plan->len[TSR_REGION_SCRATCH];
}

static enum tsr_status init_ciphers(struct tsr_node *node)
{
    const struct tsr_node_config *config = &node->config;
    enum tsr_status status = tsr_cipher_init(&node->link_cipher, node->hal.aes, config->link_key);
    if (status == TSR_OK) {
        status = tsr_cipher_init(&node->node_cipher, node->hal.aes, config->node_key);
    }
    if (status == TSR_OK) {
        status = tsr_cipher_init(&node->pair_cipher, node->hal.aes, config->pair_key);
    }
    return status;
}

static enum tsr_status init_mac(struct tsr_node *node)
{
    const struct tsr_mac_config mac_config = {
        .pan_id = node->config.pan_id,
        .address = node->config.address,
        .channel = node->config.channel,
        .counter_start = node->config.counter_start,
    };
    return tsr_mac_init(&node->mac, &mac_config, &node->link_cipher, node->hal.radio, node->hal.entropy);
}

enum tsr_status tsr_node_init(struct tsr_node *node, const struct tsr_node_config *config,
                              const struct tsr_node_hal *hal, uint8_t *arena, size_t arena_cap, uint64_t now_us)
{
    struct tsr_memory_plan plan;
    enum tsr_status status = tsr_node_plan_memory(config, &plan);
    if (status != TSR_OK || ((uintptr_t)arena & (TSR_NODE_MEMORY_ALIGN - 1u)) != 0) {
        return TSR_ERR_ARG;
    }
    if (arena_cap < plan.total) {
        return TSR_ERR_NOBUF;
    }
    memset(node, 0, sizeof *node);
    node->config = *config;
    node->hal = *hal;
    node->message_counter = config->counter_start;
    place_regions(node, &plan, arena);
    status = init_ciphers(node);
    if (status == TSR_OK && tsr_node_watches(config->role)) {
        status = tsr_change_init(&node->change, &config->change, arena + plan.offset[TSR_REGION_CHANGE],
                                 plan.len[TSR_REGION_CHANGE]);
    }
    if (status == TSR_OK) {
        status = init_mac(node);
    }
    if (status != TSR_OK) {
        return status;
    }
    tsr_sender_init(&node->sender, config->address, TOKEN_SENDER);
    tsr_sender_init(&node->notice.sender, config->address, TOKEN_NOTICE);
    tsr_node_reset_inbox(node);
    enter(node, TSR_PHASE_IDLE);
    node->next_watch_us = now_us;
    node->next_measure_us = config->measure_period_us > 0 && config->rule_count > 0 ? now_us : TSR_TIME_NEVER;
    node->recapture = true;                                            /* the first map needs no change */
    memset(node->notice.reported, 0xff, sizeof node->notice.reported); /* nothing is */
    node->uplink.timer_us = TSR_TIME_NEVER;
    if (config->role == TSR_ROLE_GATEWAY) {
        tsr_node_start_uplink(node, now_us);
    }
    return TSR_OK;
}

static void take_confirms(struct tsr_node *node, uint64_t now_us)
{
    struct tsr_mac_confirm confirm;
    while (tsr_mac_confirmed(&node->mac, &confirm)) {
        if (confirm.token == TOKEN_SENDER) {
            tsr_sender_on_confirm(&node->sender, &confirm, now_us);
        } else if (confirm.token == TOKEN_NOTICE) {
            tsr_sender_on_confirm(&node->notice.sender, &confirm, now_us);
        } else if (confirm.token == TOKEN_WAKE) {
            tsr_node_on_wake_confirm(node, &confirm, now_us);
        }
    }
}

static struct work step_stage(struct tsr_node *node, uint64_t now_us)
{
    if (node->config.role == TSR_ROLE_WING) {
        return tsr_node_serve_lead(node, now_us);
    }
    switch (node->phase) {
    case TSR_PHASE_IDLE:
    case TSR_PHASE_WATCHING:
    case TSR_PHASE_WAKING:
    case TSR_PHASE_CAPTURING:
    case TSR_PHASE_RECEIVING: return tsr_node_watch(node, now_us);
    case TSR_PHASE_UNPACKING:
    case TSR_PHASE_REFERENCE:
    case TSR_PHASE_MATCHING:
    case TSR_PHASE_MEDIAN:
    case TSR_PHASE_COMPARING: return tsr_node_make_map(node, now_us);
    case TSR_PHASE_MEASURING: return tsr_node_measure(node, now_us);
    case TSR_PHASE_ENCODING:
    case TSR_PHASE_SEALING:
    case TSR_PHASE_SENDING: return tsr_node_report_map(node, now_us);
    case TSR_PHASE_FILTERING: /* a wing's */
    case TSR_PHASE_COUNT: break;
    }
    return no_work();
}

/* A stage that ends without work hands over to the next at once. */
static struct work step_phase(struct tsr_node *node, uint64_t now_us)
{
    enum tsr_node_phase phase;
    struct work work;
    do {
        phase = node->phase;
        work = step_stage(node, now_us);
    } while (work.kind == TSR_WORK_NONE && node->phase != phase);
    return work;
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* When the node wants its next step if no event comes before. */
static uint64_t next_wake(const struct tsr_node *node)
{
    uint64_t wake_us = node->uplink.timer_us;
    if (tsr_mac_room(&node->mac) > 0) { /* else a confirm comes first */
        wake_us = earlier(wake_us, tsr_sender_timer_us(&node->sender));
        wake_us = earlier(wake_us, tsr_sender_timer_us(&node->notice.sender));
    }
    if (tsr_node_watches(node->config.role) && node->phase == TSR_PHASE_IDLE) {
        wake_us = earlier(wake_us, node->next_watch_us);
    }
    if (node->phase == TSR_PHASE_RECEIVING) {
        wake_us = earlier(wake_us, node->phase_timer_us);
    }
    if (node->wake_due && node->phase == TSR_PHASE_IDLE) {
        wake_us = earlier(wake_us, node->capture_at_us - TSR_CAPTURE_ORDER_US);
    }
    return wake_us;
}

static uint32_t fragments_sent(const struct tsr_node *node)
{
    return node->sender.counters.fragments + node->notice.sender.counters.fragments;
}

/* Of what is under way while the node does something else. */
static void finish_deliveries(struct tsr_node *node)
{
    if (node->notice.under_way && tsr_sender_is_idle(&node->notice.sender)) {
        tsr_node_finish_notice(node);
    }
    if (node->map_under_way && tsr_sender_is_idle(&node->sender)) {
        tsr_node_finish_map(node);
    }
}

struct tsr_node_outcome tsr_node_step(struct tsr_node *node, uint64_t now_us)
{
    take_confirms(node, now_us);
    finish_deliveries(node);
    struct work work = no_work();
    if (tsr_node_take_frame(node, now_us)) {
        work = work_of(TSR_WORK_SEAL, TSR_FRAME_PSDU_MAX);
    } else {
        uint32_t fragments = fragments_sent(node);
        tsr_sender_step(&node->notice.sender, &node->mac, &node->config.routes, now_us);
        tsr_sender_step(&node->sender, &node->mac, &node->config.routes, now_us);
        if (node->config.role == TSR_ROLE_GATEWAY) {
            tsr_node_repeat_uplink(node, now_us);
        }
        if (fragments_sent(node) != fragments) {
            work = work_of(TSR_WORK_SEAL, TSR_FRAME_PSDU_MAX);
        } else if (tsr_node_is_camera(node->config.role)) {
            work = step_phase(node, now_us);
        }
    }
    uint64_t wake_us = work.kind != TSR_WORK_NONE ? now_us : next_wake(node);
    struct tsr_node_outcome outcome = {wake_us > now_us ? wake_us : now_us, work.kind, work.units};
    return outcome;
}

void tsr_node_on_radio(struct tsr_node *node, const struct tsr_radio_event *event, uint64_t now_us)
{
    tsr_mac_on_radio(&node->mac, event, now_us);
}

void tsr_node_on_timer(struct tsr_node *node, uint64_t now_us)
{
    tsr_mac_on_timer(&node->mac, now_us);
}

uint64_t tsr_node_timer_us(const struct tsr_node *node)
{
    return tsr_mac_timer_us(&node->mac);
}

void tsr_node_on_camera(struct tsr_node *node, bool right, enum tsr_status status, uint64_t time_us)
{
    struct tsr_capture *capture = right ? &node->right : &node->left;
    capture->status = status;
    capture->time_us = time_us;
    __atomic_store_n(&capture->done, true, __ATOMIC_RELEASE);
}

enum tsr_node_phase tsr_node_get_phase(const struct tsr_node *node)
{
    return node->phase;
}

bool tsr_node_is_quiet(const struct tsr_node *node)
{
    return tsr_mac_room(&node->mac) == TSR_MAC_QUEUE_LEN && tsr_mac_received(&node->mac) == NULL &&
           tsr_sender_is_idle(&node->sender) && tsr_sender_is_idle(&node->notice.sender) && !node->uplink.waiting;
}

const struct tsr_node_counters *tsr_node_get_counters(const struct tsr_node *node)
{
    return &node->counters;
}

const struct tsr_mac_counters *tsr_node_get_mac_counters(const struct tsr_node *node)
{
    return &node->mac.counters;
}

const struct tsr_sender_counters *tsr_node_get_sender_counters(const struct tsr_node *node)
{
    return &node->sender.counters;
}
