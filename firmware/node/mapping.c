/*
 * From two views to a decision: open and decode the wing's view, code the
 * reference image, match, filter, compare with the last map the sink has.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "internal.h"
#include "tsr/vision/quantise.h"

/* Not the view this capture waits for: keep waiting for that one. */
static void refuse_view(struct tsr_node *node)
{
    uint16_t message_id = node->inbox.message_id;
    tsr_node_reset_inbox(node);
    enter(node, TSR_PHASE_RECEIVING);
    tsr_node_answer(node, message_id, TSR_DELIVERY_REFUSED);
}

/* The tag is wrong: some fragment was not the wing's. All are asked for again. */
static void restart_view(struct tsr_node *node)
{
    node->counters.dropped_auth++;
    tsr_node_reset_inbox(node);
    enter(node, TSR_PHASE_RECEIVING);
}

static void start_decoding(struct tsr_node *node, const struct tsr_message_header *header)
{
    const uint8_t *body = node->message + TSR_MESSAGE_HEADER_LEN;
    size_t body_len = node->inbox.message_len - TSR_MESSAGE_OVERHEAD_LEN;
    const struct tsr_match_config *match = &node->config.match;
    struct tsr_view_decoder *decoder = (struct tsr_view_decoder *)(void *)node->scratch;
    struct tsr_body_capture capture;
    struct tsr_view_info info;
    bool ours =
        (!node->partner_heard || header->counter > node->partner_counter) &&
        tsr_body_read_capture(body, body_len, &capture) == TSR_OK && capture.capture_id == node->capture_id &&
        capture.attempt == node->attempt &&
        tsr_view_read_info(body + TSR_BODY_VIEW_HEADER_LEN, body_len - TSR_BODY_VIEW_HEADER_LEN, &info) == TSR_OK &&
        info.width == match->width && info.height == match->height && info.cap == tsr_match_prefilter_cap(match) &&
        tsr_view_decode_start(decoder, body + TSR_BODY_VIEW_HEADER_LEN, body_len - TSR_BODY_VIEW_HEADER_LEN,
                              &node->held, node->scratch + sizeof *decoder, node->scratch_cap - sizeof *decoder,
                              &info) == TSR_OK;
    node->partner_heard = true;
    node->partner_counter = header->counter > node->partner_counter ? header->counter : node->partner_counter;
    if (!ours) {
        node->counters.dropped_foreign++;
        refuse_view(node);
        return;
    }
    node->inbox_done = true;
    node->inbox_done_id = node->inbox.message_id;
    tsr_node_answer(node, node->inbox_done_id, TSR_DELIVERY_COMMITTED);
}

/* Open the view piece by piece. Once all of it is open, row counts decoded rows. */
static struct work open_view(struct tsr_node *node)
{
    struct tsr_message_header header;
    size_t message_len = node->inbox.message_len;
    if (tsr_message_parse(node->message, message_len, node->inbox.origin, node->inbox.destination, &header) != TSR_OK ||
        header.key_use != TSR_KEY_PAIR || header.kind != TSR_MESSAGE_VIEW) {
        restart_view(node);
        return no_work();
    }
    size_t body_len = message_len - TSR_MESSAGE_OVERHEAD_LEN;
    if (node->sealed == 0) {
        (void)tsr_message_open_start(&node->ccm, &header, &node->pair_cipher, message_len);
    }
    size_t left = body_len - node->sealed;
    size_t len = left < SEAL_BYTES_PER_STEP ? left : SEAL_BYTES_PER_STEP;
    uint8_t *body = node->message + TSR_MESSAGE_HEADER_LEN;
    (void)tsr_ccm_update(&node->ccm, body + node->sealed, len);
    node->sealed += len;
    if (node->sealed == body_len) {
        if (tsr_ccm_open(&node->ccm, body + body_len) == TSR_OK) {
            node->inbox_ready = false; /* from here the body is plain */
            start_decoding(node, &header);
        } else {
            restart_view(node);
        }
    }
    return work_of(TSR_WORK_SEAL, len);
}

static struct work decode_view(struct tsr_node *node)
{
    struct tsr_gray right = tsr_match_pair_right(node->pair, &node->config.match);
    struct tsr_view_decoder *decoder = (struct tsr_view_decoder *)(void *)node->scratch;
    uint16_t rows = rows_of_step(node, (unsigned)right.height - node->row);
    (void)tsr_view_decode_rows(decoder, right.pixels + (size_t)node->row * right.stride, right.stride, rows);
    node->row = (uint16_t)(node->row + rows);
    if (node->row == right.height) {
        enter(node, TSR_PHASE_REFERENCE);
    }
    return work_of(TSR_WORK_VIEW_DECODE, (size_t)rows * right.width);
}

static void start_matching(struct tsr_node *node)
{
    struct tsr_match_config config = node->config.match;
    config.right_is_prefiltered = node->config.role == TSR_ROLE_LEAD;
    (void)tsr_match_start_sad(&node->work.match, &config, tsr_match_pair_left(node->pair, &config),
                              tsr_match_pair_right(node->pair, &config), tsr_match_pair_map(node->pair),
                              (size_t)config.width * config.height, node->scratch, node->scratch_cap);
    node->disparities = node->work.match.config.disparities;
    enter(node, TSR_PHASE_MATCHING);
}

/* A picture is coded in bands: a quantum is whole ones. */
static uint16_t rows_of_bands(const struct tsr_node *node, unsigned left)
{
    unsigned rows = (rows_of_step(node, left) + TSR_PICTURE_BLOCK - 1u) / TSR_PICTURE_BLOCK * TSR_PICTURE_BLOCK;
    return (uint16_t)(rows < left ? rows : left);
}

/* The reference image is coded before matching consumes the view. */
static struct work code_reference(struct tsr_node *node)
{
    struct tsr_gray view = tsr_node_left_view(node);
    struct tsr_picture_encoder *encoder = (struct tsr_picture_encoder *)(void *)node->scratch;
    if (node->config.reference_step == TSR_REFERENCE_NONE || node->measures_only) {
        node->reference_len = 0;
        start_matching(node);
        return no_work();
    }
    if (node->row == 0) {
        const struct tsr_picture_info info = {view.width, view.height, node->config.reference_step,
                                              TSR_PICTURE_PRIOR_TRAINED};
        size_t in_front = TSR_MESSAGE_HEADER_LEN + TSR_BODY_MAP_HEADER_LEN;
        (void)tsr_picture_encode_start(encoder, &info, 0, node->message + in_front,
                                       node->message_cap - in_front - TSR_CCM_TAG_LEN, node->scratch + sizeof *encoder,
                                       node->scratch_cap - sizeof *encoder);
    }
    uint16_t rows = rows_of_bands(node, (unsigned)view.height - node->row);
    enum tsr_status status =
        tsr_picture_encode_rows(encoder, view.pixels + (size_t)node->row * view.stride, view.stride, rows);
    node->row = (uint16_t)(node->row + rows);
    if (status != TSR_AGAIN) {
        size_t len = 0;
        if (status != TSR_OK || tsr_picture_encode_finish(encoder, &len) != TSR_OK) {
            node->counters.references_omitted++;
        }
        node->reference_len = len;
        start_matching(node);
    }
    return work_of(TSR_WORK_REFERENCE_ENCODE, (size_t)rows * view.width);
}

static struct work match(struct tsr_node *node)
{
    const struct tsr_match_config *config = &node->work.match.config;
    uint16_t before = tsr_match_rows_done(&node->work.match);
    enum tsr_status status = tsr_match_run(&node->work.match, rows_of_step(node, TSR_IMAGE_HEIGHT_MAX));
    size_t units = (size_t)(tsr_match_rows_done(&node->work.match) - before) * config->width * config->disparities;
    if (status == TSR_OK) {
        (void)tsr_median_start(&node->work.median, config->width, config->height, tsr_match_pair_map(node->pair),
                               (size_t)config->width * config->height, node->scratch, node->scratch_cap);
        enter(node, TSR_PHASE_MEDIAN);
    }
    return work_of(TSR_WORK_MATCH, units);
}

static struct work filter(struct tsr_node *node, uint64_t now_us)
{
    uint16_t before = tsr_median_rows_done(&node->work.median);
    enum tsr_status status = tsr_median_run(&node->work.median, rows_of_step(node, TSR_IMAGE_HEIGHT_MAX));
    size_t units = (size_t)(tsr_median_rows_done(&node->work.median) - before) * node->config.match.width;
    if (status == TSR_OK) {
        node->counters.maps_made++;
        tsr_node_start_measuring(node, now_us);
    }
    return work_of(TSR_WORK_MEDIAN, units);
}

static void start_comparing(struct tsr_node *node)
{
    size_t pixels = (size_t)node->config.match.width * node->config.match.height;
    if (node->has_last_map) {
        (void)tsr_similarity_start(&node->work.similarity, &node->config.similarity, tsr_match_pair_map(node->pair),
                                   node->last_map, pixels);
    } else {
        enter(node, TSR_PHASE_ENCODING);
    }
}

/* Quantise to what the sink will see, then compare with what it has seen. */
static struct work compare(struct tsr_node *node, uint64_t now_us)
{
    const struct tsr_match_config *match_config = &node->config.match;
    unsigned height = match_config->height;
    if (node->row < height) {
        uint16_t rows = rows_of_step(node, height - node->row);
        size_t pixels = (size_t)rows * match_config->width;
        uint16_t *map_rows = tsr_match_pair_map(node->pair) + (size_t)node->row * match_config->width;
        (void)tsr_quantise(map_rows, pixels, node->config.step_log2, node->disparities);
        node->row = (uint16_t)(node->row + rows);
        if (node->row == height) {
            start_comparing(node);
        }
        return work_of(TSR_WORK_COMPARE, pixels);
    }
    uint16_t before = tsr_similarity_rows_done(&node->work.similarity);
    enum tsr_status status = tsr_similarity_run(&node->work.similarity, rows_of_step(node, TSR_IMAGE_HEIGHT_MAX));
    size_t units = (size_t)(tsr_similarity_rows_done(&node->work.similarity) - before) * match_config->width;
    if (status == TSR_OK) {
        struct tsr_similarity_result result;
        (void)tsr_similarity_get_result(&node->work.similarity, &result);
        if (tsr_similarity_is_similar(&node->config.similarity, &result)) {
            node->counters.maps_withheld++;
            tsr_node_rest(node, now_us);
        } else {
            enter(node, TSR_PHASE_ENCODING);
        }
    }
    return work_of(TSR_WORK_COMPARE, units);
}

struct work tsr_node_make_map(struct tsr_node *node, uint64_t now_us)
{
    switch (node->phase) {
    case TSR_PHASE_UNPACKING: return node->inbox_ready ? open_view(node) : decode_view(node);
    case TSR_PHASE_REFERENCE: return code_reference(node);
    case TSR_PHASE_MATCHING: return match(node);
    case TSR_PHASE_MEDIAN: return filter(node, now_us);
    case TSR_PHASE_COMPARING: return compare(node, now_us);
    default: return no_work();
    }
}
