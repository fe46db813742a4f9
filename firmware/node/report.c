/*
 * Coding, sealing and sending a map, and keeping it once the sink has it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"

static enum tsr_status start_encoding(struct tsr_node *node, struct tsr_map_encoder *encoder)
{
    const struct tsr_match_config *match = &node->config.match;
    const struct tsr_map_info info = {.width = match->width,
                                      .height = match->height,
                                      .disparities = node->disparities,
                                      .step_log2 = node->config.step_log2,
                                      .d0_q4 = node->config.d0_q4};
    size_t in_front = TSR_MESSAGE_HEADER_LEN + TSR_BODY_MAP_HEADER_LEN + node->reference_len;
    uint16_t *rows = (uint16_t *)(void *)(node->scratch + sizeof *encoder);
    return tsr_map_encode_start(encoder, &info, node->message + in_front,
                                node->message_cap - in_front - TSR_CCM_TAG_LEN, rows,
                                (node->scratch_cap - sizeof *encoder) / sizeof *rows);
}

static void lose_map(struct tsr_node *node, uint64_t now_us)
{
    node->counters.maps_lost++;
    node->recapture = true;
    tsr_node_rest(node, now_us);
}

static enum tsr_status finish_encoding(struct tsr_node *node, size_t map_len)
{
    tsr_body_write_map_header(node->capture_time_us, node->capture_id, node->reference_len,
                              node->message + TSR_MESSAGE_HEADER_LEN);
    node->body_len = TSR_BODY_MAP_HEADER_LEN + node->reference_len + map_len;
    enum tsr_status status = tsr_node_start_sealing(node, TSR_MESSAGE_MAP, TSR_ADDRESS_SINK);
    enter(node, TSR_PHASE_SEALING);
    return status;
}

static struct work encode_map(struct tsr_node *node, uint64_t now_us)
{
    struct tsr_map_encoder *encoder = (struct tsr_map_encoder *)(void *)node->scratch;
    size_t width = node->config.match.width;
    enum tsr_status status = node->row == 0 ? start_encoding(node, encoder) : TSR_OK;
    uint16_t rows = rows_of_step(node, (unsigned)node->config.match.height - node->row);
    const uint16_t *map_rows = tsr_match_pair_map(node->pair) + node->row * width;
    if (status == TSR_OK) {
        status = tsr_map_encode_rows(encoder, map_rows, width, rows);
    }
    node->row = (uint16_t)(node->row + rows);
    size_t map_len = 0;
    if (status == TSR_OK) {
        status = tsr_map_encode_finish(encoder, &map_len);
    }
    if (status == TSR_OK) {
        status = finish_encoding(node, map_len);
    }
    if (status < TSR_OK && node->reference_len > 0) {
        /* No room for both: the map is what counts. */
        node->counters.references_omitted++;
        node->reference_len = 0;
        enter(node, TSR_PHASE_ENCODING);
    } else if (status < TSR_OK) { /* noise that outgrows the longest message, or no counter left */
        lose_map(node, now_us);
    }
    return work_of(TSR_WORK_MAP_ENCODE, rows * width);
}

/* As the one that is compared with, once the sink has it. */
static struct work keep_map(struct tsr_node *node)
{
    size_t len = sizeof(uint16_t) * node->config.match.width * node->config.match.height;
    memcpy(node->last_map, tsr_match_pair_map(node->pair), len);
    return work_of(TSR_WORK_COPY, len);
}

static struct work seal_map(struct tsr_node *node, uint64_t now_us)
{
    bool done = false;
    struct work work = tsr_node_continue_sealing(node, TSR_ADDRESS_SINK, now_us, &done);
    if (!done) {
        return work;
    }
    node->counters.map_bytes += (uint32_t)node->message_len;
    if (node->config.role != TSR_ROLE_BINOCULAR || node->config.rule_count == 0) {
        enter(node, TSR_PHASE_SENDING);
        return work;
    }
    /* Its place is needed for the next views. */
    node->map_under_way = true;
    node->has_last_map = false;
    tsr_node_rest(node, now_us);
    return keep_map(node);
}

void tsr_node_finish_map(struct tsr_node *node)
{
    node->map_under_way = false;
    if (tsr_sender_result(&node->sender) == TSR_OK) {
        node->has_last_map = true;
        node->counters.maps_sent++;
    } else {
        node->counters.maps_lost++;
        node->recapture = true;
    }
}

static struct work await_commit(struct tsr_node *node, uint64_t now_us)
{
    if (!tsr_sender_is_idle(&node->sender)) {
        return no_work();
    }
    struct work work = tsr_sender_result(&node->sender) == TSR_OK ? keep_map(node) : no_work();
    tsr_node_finish_map(node);
    tsr_node_rest(node, now_us);
    return work;
}

struct work tsr_node_report_map(struct tsr_node *node, uint64_t now_us)
{
    switch (node->phase) {
    case TSR_PHASE_ENCODING: return encode_map(node, now_us);
    case TSR_PHASE_SEALING: return seal_map(node, now_us);
    case TSR_PHASE_SENDING: return await_commit(node, now_us);
    default: return no_work();
    }
}
