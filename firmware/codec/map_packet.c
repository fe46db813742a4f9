/*
 * Packets of a map, both ways.
 *
 *   bytes 0..3  header of packet.h, of pixels
 *   bytes 4..   range-coded labels
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map_packet.h"

#include "map_strip.h"
#include "range_inline.h"

#define COUNT_MAX 4096u

static uint32_t pixels_of(const struct tsr_map_info *info)
{
    return (uint32_t)info->width * info->height;
}

static uint32_t code_of_label(const struct tsr_map_model *model, unsigned label)
{
    return label == model->invalid ? model->label_count : label;
}

/* Code count pixels after done ones of the packet; false if one is not a value of this map. */
static bool encode_pixels(struct tsr_map_packet_encoder *encoder, struct tsr_range_encoder *range, uint32_t done,
                          uint32_t count, bool literal)
{
    struct tsr_map_model *model = &encoder->model;
    for (const uint32_t end_done = done + count; done < end_done;) {
        const struct tsr_map_span span =
            tsr_map_strip_next(model, &encoder->info, encoder->position, done, end_done - done);
        uint16_t *labels = tsr_map_row_labels(model, 0);
        for (unsigned x = span.place.x; x < span.end; x++) {
            const uint16_t value = encoder->map[tsr_map_strip_index(&span, encoder->stride, x)];
            if (!tsr_map_is_valid_value(&encoder->info, value)) {
                return false;
            }
            labels[x] = TSR_MAP_LABEL(value, encoder->info.step_log2);
            if (literal) {
                tsr_encode_direct(range, code_of_label(model, labels[x]), model->label_bits);
            }
        }
        if (!literal) {
            tsr_map_encode_span(model, range, span.place.x, span.end);
        }
        tsr_map_strip_close(model, &span, done);
        done += span.end - span.place.x;
    }
    return true;
}

static bool encode_group(void *encoder, struct tsr_range_encoder *range, uint32_t done, uint32_t count)
{
    return encode_pixels(encoder, range, done, count, false);
}

enum tsr_status tsr_map_packets_start(struct tsr_map_packet_encoder *encoder, const struct tsr_map_info *info,
                                      const uint16_t *map, size_t stride, uint8_t map_id, uint16_t *scratch,
                                      size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || map == NULL || scratch == NULL || map_id > TSR_MAP_PACKET_MAP_ID_MAX ||
        !tsr_map_is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    if (stride < info->width) {
        return TSR_ERR_SIZE;
    }
    if (scratch_cap < TSR_MAP_PACKET_SCRATCH_COUNT) {
        return TSR_ERR_NOBUF;
    }
    encoder->info = *info;
    encoder->map = map;
    encoder->stride = stride;
    encoder->scratch = scratch;
    encoder->map_id = map_id;
    encoder->position = 0;
    return TSR_OK;
}

/* The packet's pixels into its payload: coded, or literally where that holds more. */
static bool code_payload(struct tsr_map_packet_encoder *encoder, struct tsr_range_encoder *range, uint8_t *payload,
                         size_t cap, uint32_t limit, struct tsr_packet *packet)
{
    struct tsr_map_model *model = &encoder->model;
    (void)tsr_map_strip_start(model, &encoder->info, encoder->position, encoder->scratch, TSR_MAP_PACKET_SCRATCH_COUNT);
    tsr_range_encode_start(range, payload, cap);
    if (!tsr_packet_fill(range, limit, TSR_MAP_PACKET_GROUP_PIXELS, encode_group, encoder, &packet->count)) {
        return false;
    }
    uint32_t literal = tsr_packet_literal_count(cap, model->label_bits, TSR_MAP_PACKET_GROUP_PIXELS);
    literal = literal < limit ? literal : limit;
    packet->is_literal = packet->count < literal;
    if (packet->is_literal) {
        packet->count = literal;
        tsr_range_encode_start(range, payload, cap);
        return encode_pixels(encoder, range, 0, literal, true);
    }
    return true;
}

enum tsr_status tsr_map_packets_next(struct tsr_map_packet_encoder *encoder, uint8_t *out, size_t out_cap, size_t *len)
{
    if (encoder == NULL || out == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    if (out_cap < TSR_MAP_PACKET_LEN_MIN) {
        return TSR_ERR_NOBUF;
    }
    const uint32_t left = pixels_of(&encoder->info) - encoder->position;
    if (left == 0) {
        return TSR_ERR_SIZE;
    }
    struct tsr_packet packet = {.id = encoder->map_id, .first = encoder->position};
    struct tsr_range_encoder range;
    size_t payload_len = 0;
    if (!code_payload(encoder, &range, out + TSR_MAP_PACKET_HEADER_LEN, out_cap - TSR_MAP_PACKET_HEADER_LEN,
                      left < COUNT_MAX ? left : COUNT_MAX, &packet)) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status = tsr_range_encode_finish(&range, &payload_len);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_packet_grid grid = tsr_map_packet_grid(&encoder->info);
    tsr_packet_write_header(out, &grid, TSR_MAP_PACKET_FORMAT_VERSION, &packet);
    encoder->position += packet.count;
    *len = TSR_MAP_PACKET_HEADER_LEN + payload_len;
    return encoder->position < pixels_of(&encoder->info) ? TSR_AGAIN : TSR_OK;
}

enum tsr_status tsr_map_packets_clear(const struct tsr_map_info *info, uint16_t *map, size_t stride)
{
    if (info == NULL || map == NULL) {
        return TSR_ERR_ARG;
    }
    if (stride < info->width) {
        return TSR_ERR_SIZE;
    }
    for (unsigned y = 0; y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            map[y * stride + x] = TSR_MAP_PIXEL_MISSING;
        }
    }
    return TSR_OK;
}

/* A literal label; false if it does not exist. */
static bool decode_literal(const struct tsr_map_model *model, struct tsr_range_decoder *range, uint16_t *label)
{
    const uint32_t code = tsr_range_decode_direct(range, model->label_bits);
    *label = (uint16_t)(code == model->label_count ? model->invalid : code);
    return code <= model->label_count;
}

/* Columns first .. end - 1 of a row; gives the end of those that exist. */
static unsigned decode_labels(struct tsr_map_model *model, struct tsr_range_decoder *range, bool literal,
                              uint16_t *labels, unsigned first, unsigned end)
{
    for (unsigned x = first; x < end; x++) {
        if (literal ? !decode_literal(model, range, &labels[x]) : !tsr_map_decode_span(model, range, x, x + 1u)) {
            return x;
        }
    }
    return end;
}

enum tsr_status tsr_map_packet_decode(struct tsr_map_model *model, const struct tsr_map_info *info, uint8_t map_id,
                                      const uint8_t *bytes, size_t len, uint16_t *scratch, size_t scratch_cap,
                                      struct tsr_map_packet *packet, uint16_t *map, size_t stride)
{
    if (model == NULL || info == NULL || bytes == NULL || scratch == NULL || packet == NULL || map == NULL ||
        map_id > TSR_MAP_PACKET_MAP_ID_MAX || !tsr_map_is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    struct tsr_packet read = {.count = 0};
    const struct tsr_packet_grid grid = tsr_map_packet_grid(info);
    enum tsr_status status =
        stride < info->width ? TSR_ERR_SIZE
                             : tsr_packet_read_header(bytes, len, &grid, TSR_MAP_PACKET_FORMAT_VERSION, map_id, &read);
    if (status == TSR_OK) {
        status = tsr_map_strip_start(model, info, read.first, scratch, scratch_cap);
    }
    if (status != TSR_OK) {
        return status;
    }
    struct tsr_range_decoder range;
    tsr_range_decode_start(&range, bytes + TSR_MAP_PACKET_HEADER_LEN, len - TSR_MAP_PACKET_HEADER_LEN);
    uint32_t done = 0;
    while (done < read.count && status == TSR_OK) {
        struct tsr_map_span span = tsr_map_strip_next(model, info, read.first, done, read.count - done);
        const unsigned asked = span.end;
        uint16_t *labels = tsr_map_row_labels(model, 0);
        span.end = decode_labels(model, &range, read.is_literal, labels, span.place.x, asked);
        for (unsigned x = span.place.x; x < span.end; x++) {
            map[tsr_map_strip_index(&span, stride, x)] =
                (uint16_t)(labels[x] == model->invalid ? TSR_DISPARITY_INVALID
                                                       : (unsigned)labels[x] << info->step_log2);
        }
        done += span.end - span.place.x;
        if (span.end < asked) {
            status = TSR_ERR_FORMAT;
            break;
        }
        tsr_map_strip_close(model, &span, done - (span.end - span.place.x));
    }
    *packet =
        (struct tsr_map_packet){.map_id = read.id, .is_literal = read.is_literal, .first = read.first, .count = done};
    return status;
}

size_t tsr_map_packets_missing(const struct tsr_map_info *info, const uint16_t *map, size_t stride)
{
    size_t missing = 0;
    for (unsigned y = 0; info != NULL && map != NULL && y < info->height; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            missing += map[y * stride + x] == TSR_MAP_PIXEL_MISSING;
        }
    }
    return missing;
}
