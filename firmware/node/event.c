/*
 * Depth rules: measuring their zones in a fresh map, and telling the sink
 * what has changed before the map itself goes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"

#define REPORTED_NOTHING TSR_ZONE_NO_DISPARITY
#define REPORTED_BEGUN 1u /* of a rule with a limit; of a surface its disparity is reported */
#define Q8_OF_Q4 16

_Static_assert(TSR_ZONE_NO_DISPARITY == TSR_EVENT_NO_DISPARITY, "a zone's disparity goes on air as it is");

const char *tsr_node_check_rules(const struct tsr_node_config *config)
{
    if (config->rule_count > TSR_DEPTH_RULES_MAX) {
        return "rule_count";
    }
    if (config->rule_count > 0 && config->rules == NULL) {
        return "rules";
    }
    for (unsigned i = 0; i < config->rule_count; i++) {
        const struct tsr_depth_rule *rule = &config->rules[i];
        const struct tsr_rectangle *part = &rule->zone.part;
        if (rule->zone.kind < TSR_ZONE_NEARER || rule->zone.kind > TSR_ZONE_SURFACE ||
            !tsr_rectangle_is_inside(part, config->match.width, config->match.height)) {
            return "rules.zone";
        }
        if (rule->begin_px == 0 || rule->begin_px > (uint32_t)part->width * part->height) {
            return "rules.begin_px";
        }
        bool surface = rule->zone.kind == TSR_ZONE_SURFACE;
        if (!surface && (rule->end_px == 0 || rule->end_px > rule->begin_px)) {
            return "rules.end_px";
        }
        if (surface && (rule->scale_q8 == 0 || rule->change_mm == 0)) {
            return rule->scale_q8 == 0 ? "rules.scale_q8" : "rules.change_mm";
        }
    }
    return NULL;
}

static void start_zone(struct tsr_node *node)
{
    const struct tsr_match_config *match = &node->config.match;
    (void)tsr_zone_start((struct tsr_zone *)(void *)node->scratch, &node->config.rules[node->notice.rule].zone,
                         tsr_match_pair_map(node->pair), match->width, match->height);
}

/* The map itself goes on, unless it was made for the rules alone: if it is worth one, another is made later. */
static void go_on(struct tsr_node *node, uint64_t now_us)
{
    if (node->measures_only) {
        node->counters.maps_measured++;
        node->recapture = node->recapture || node->map_under_way || node->notice.under_way;
        tsr_node_rest(node, now_us);
    } else {
        enter(node, TSR_PHASE_COMPARING);
    }
}

void tsr_node_start_measuring(struct tsr_node *node, uint64_t now_us)
{
    if (node->config.rule_count == 0 || node->notice.under_way) {
        /* What the sink knows is open until it has answered. */
        node->recapture = node->recapture || node->notice.under_way;
        go_on(node, now_us);
        return;
    }
    node->notice.rule = 0;
    node->notice.body.count = 0;
    start_zone(node);
    enter(node, TSR_PHASE_MEASURING);
}

/* Eq. (97); beyond infinity is infinitely far. */
static uint32_t depth_mm(const struct tsr_node *node, const struct tsr_depth_rule *rule, uint16_t disparity_q8)
{
    int32_t divisor_q8 = disparity_q8 + node->config.d0_q4 * Q8_OF_Q4;
    return divisor_q8 > 0 ? rule->scale_q8 / (uint32_t)divisor_q8 : UINT32_MAX;
}

static bool has_moved(const struct tsr_node *node, const struct tsr_depth_rule *rule, uint16_t before_q8,
                      uint16_t now_q8)
{
    uint32_t before_mm = depth_mm(node, rule, before_q8);
    uint32_t now_mm = depth_mm(node, rule, now_q8);
    return (before_mm > now_mm ? before_mm - now_mm : now_mm - before_mm) >= rule->change_mm;
}

/* What a surface's rule would report now: 0 if nothing is new. */
static uint8_t judge_surface(const struct tsr_node *node, const struct tsr_depth_rule *rule,
                             const struct tsr_zone_result *result, uint16_t reported, uint16_t *found)
{
    *found = result->counted >= rule->begin_px ? result->disparity_q8 : REPORTED_NOTHING;
    if (*found == REPORTED_NOTHING || reported == REPORTED_NOTHING) {
        return *found == reported ? 0 : *found == REPORTED_NOTHING ? TSR_EVENT_VANISHED : TSR_EVENT_MEASURED;
    }
    return has_moved(node, rule, reported, *found) ? TSR_EVENT_MEASURED : 0;
}

static uint8_t judge_limit(const struct tsr_depth_rule *rule, const struct tsr_zone_result *result, uint16_t reported,
                           uint16_t *found)
{
    bool begun = reported == REPORTED_BEGUN;
    bool holds = result->counted >= (begun ? rule->end_px : rule->begin_px);
    *found = holds ? REPORTED_BEGUN : REPORTED_NOTHING;
    return holds == begun ? 0 : holds ? TSR_EVENT_BEGUN : TSR_EVENT_ENDED;
}

static void judge(struct tsr_node *node)
{
    struct tsr_notice *notice = &node->notice;
    const struct tsr_depth_rule *rule = &node->config.rules[notice->rule];
    struct tsr_zone_result result = tsr_zone_get_result((struct tsr_zone *)(void *)node->scratch);
    uint16_t reported = notice->reported[notice->rule];
    uint16_t found = REPORTED_NOTHING;
    uint8_t kind = rule->zone.kind == TSR_ZONE_SURFACE ? judge_surface(node, rule, &result, reported, &found)
                                                       : judge_limit(rule, &result, reported, &found);
    notice->found[notice->rule] = kind != 0 ? found : reported;
    if (kind != 0) {
        uint32_t pixels = (uint32_t)rule->zone.part.width * rule->zone.part.height;
        uint16_t share_q12 = (uint16_t)(result.counted * TSR_EVENT_SHARE_ONE / pixels);
        struct tsr_body_event event = {notice->rule, kind, share_q12, result.disparity_q8};
        notice->body.events[notice->body.count++] = event;
    }
}

static void send_events(struct tsr_node *node, uint64_t now_us)
{
    struct tsr_notice *notice = &node->notice;
    notice->body.capture_time_us = node->capture_time_us;
    notice->body.capture_id = node->capture_id;
    size_t body_len = 0;
    size_t message_len = 0;
    uint32_t counter = 0;
    (void)tsr_body_write_events(&notice->body, notice->message + TSR_MESSAGE_HEADER_LEN,
                                sizeof notice->message - TSR_MESSAGE_OVERHEAD_LEN, &body_len);
    enum tsr_status status = tsr_node_seal_short(node, TSR_MESSAGE_EVENT, TSR_ADDRESS_SINK, notice->message, body_len,
                                                 &message_len, &counter);
    if (status == TSR_OK) {
        status = tsr_sender_start(&notice->sender, notice->message, message_len, TSR_ADDRESS_SINK, counter, now_us);
    }
    notice->under_way = status == TSR_OK;
    if (status != TSR_OK) { /* no counter left, or the last frame of the last notice is still in the MAC */
        node->counters.events_lost += notice->body.count;
        node->recapture = true;
    }
}

void tsr_node_finish_notice(struct tsr_node *node)
{
    struct tsr_notice *notice = &node->notice;
    enum tsr_status result = tsr_sender_result(&notice->sender);
    if (result == TSR_OK || result == TSR_ERR_FORMAT) { /* what the sink refuses it would refuse again */
        memcpy(notice->reported, notice->found, sizeof notice->reported);
    } else {
        node->recapture = true;
    }
    uint32_t *counter = result == TSR_OK ? &node->counters.events_sent : &node->counters.events_lost;
    *counter += notice->body.count;
    notice->under_way = false;
}

struct work tsr_node_measure(struct tsr_node *node, uint64_t now_us)
{
    struct tsr_notice *notice = &node->notice;
    struct tsr_zone *zone = (struct tsr_zone *)(void *)node->scratch;
    unsigned width = node->config.rules[notice->rule].zone.part.width;
    uint16_t before = tsr_zone_rows_done(zone);
    enum tsr_status status = tsr_zone_run(zone, rows_of_step(node, TSR_IMAGE_HEIGHT_MAX));
    struct work work = work_of(TSR_WORK_MEASURE, (size_t)(tsr_zone_rows_done(zone) - before) * width);
    if (status != TSR_OK) {
        return work;
    }
    judge(node);
    notice->rule++;
    if (notice->rule < node->config.rule_count) {
        start_zone(node);
        return work;
    }
    if (notice->body.count > 0) {
        send_events(node, now_us);
    }
    go_on(node, now_us);
    return work;
}
