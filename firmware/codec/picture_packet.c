/*
 * Packets of pictures: blocks of picture_block.c in strips of four, docs/codec.md, chapter 5a.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/picture_packet.h"

#include <string.h>

#include "packet.h"
#include "picture_block.h"
#include "picture_transform.h"

#define COUNT_MAX 512u
#define FIRST_BITS 13u
#define COARSER_MAX 15u
#define STEPS_A_HALF_OCTAVE 4u
#define MEAN_BITS 8u
#define ROWS_ABOVE 2u /* of the scratch, before the band */

/* One packet being coded, in either direction: from `in`, or into `out` and `marks`. */
struct coding {
    struct tsr_picture_model *model;
    struct tsr_packet_grid grid;
    const uint8_t *in;
    uint8_t *out, *marks;
    size_t stride;
    uint16_t width, height; /* px */
    uint32_t first;
    bool is_literal;
};

static struct tsr_packet_grid grid_of(uint16_t width, uint16_t height)
{
    return (struct tsr_packet_grid){.width = (uint16_t)TSR_PICTURE_BLOCKS(width),
                                    .height = (uint16_t)TSR_PICTURE_BLOCKS(height),
                                    .strip_width = TSR_PICTURE_PACKET_STRIP_PX / TSR_PICTURE_BLOCK,
                                    .group = 1,
                                    .first_bits = FIRST_BITS};
}

static bool is_valid_info(const struct tsr_picture_info *info)
{
    return tsr_picture_encoded_len_max(info) != 0 && info->prior == TSR_PICTURE_PRIOR_TRAINED;
}

/* Forget everything, as at the beginning of each packet. */
static void start_packet(struct tsr_picture_packet_state *state, const struct tsr_picture_info *info, unsigned coarser)
{
    struct tsr_picture_model *model = &state->model;
    const unsigned step = info->step + STEPS_A_HALF_OCTAVE * coarser;
    model->info = *info;
    model->info.width = TSR_PICTURE_PACKET_STRIP_PX;
    model->scratch = state->rows;
    tsr_picture_model_reset(model);
    model->step = (uint8_t)(step < TSR_PICTURE_STEP_MAX ? step : TSR_PICTURE_STEP_MAX);
    model->allowed_bits = UINT32_MAX / 2u; /* a packet is literal as a whole or not at all */
}

static unsigned smaller(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* The block from the picture, which its last column and row extend. */
static void take_block(const struct coding *c, unsigned x, unsigned y, uint8_t *pixels, size_t stride)
{
    for (unsigned i = 0; i < TSR_PICTURE_BLOCK; i++) {
        const uint8_t *row = c->in + smaller(y + i, c->height - 1u) * c->stride;
        for (unsigned j = 0; j < TSR_PICTURE_BLOCK; j++) {
            pixels[i * stride + j] = row[smaller(x + j, c->width - 1u)];
        }
    }
}

/* The block into the picture, as far as it is inside. */
static void hand_out_block(const struct coding *c, unsigned x, unsigned y, const uint8_t *pixels, size_t stride)
{
    const unsigned count = smaller(c->width - x, TSR_PICTURE_BLOCK);
    for (unsigned i = 0; i < smaller(c->height - y, TSR_PICTURE_BLOCK); i++) {
        memcpy(c->out + (y + i) * c->stride + x, pixels + i * stride, count);
    }
}

/* A literal block is its mean. */
static void code_mean(const struct tsr_range_port *port, uint8_t *pixels, size_t stride, uint8_t *limit)
{
    unsigned sum = TSR_PICTURE_COEFFICIENTS / 2u;
    for (unsigned i = 0; i < TSR_PICTURE_COEFFICIENTS; i++) {
        sum += pixels[i / TSR_PICTURE_BLOCK * stride + i % TSR_PICTURE_BLOCK];
    }
    const uint32_t mean = tsr_port_direct(port, sum / TSR_PICTURE_COEFFICIENTS, MEAN_BITS);
    for (unsigned i = 0; i < TSR_PICTURE_BLOCK; i++) {
        memset(pixels + i * stride, (int)mean, TSR_PICTURE_BLOCK);
    }
    *limit = tsr_picture_limit_of(tsr_picture_step_q6(TSR_PICTURE_STEP_MAX));
}

/* Block number `done` of the packet. */
static void code_one(const struct coding *c, const struct tsr_range_port *port, uint32_t done)
{
    const struct tsr_packet_place place = tsr_packet_place_of(&c->grid, c->first + done);
    c->model->info.width = (uint16_t)(TSR_PICTURE_BLOCK * place.strip_width);
    const struct tsr_picture_rows rows = tsr_picture_rows_of(c->model);
    if (place.x == 0) {
        tsr_picture_keep_last_rows(&rows);
    }
    const unsigned block_x = place.strip_x + place.x;
    const unsigned x = TSR_PICTURE_BLOCK * block_x, y = TSR_PICTURE_BLOCK * place.y;
    uint8_t *pixels = rows.pixels + ROWS_ABOVE * rows.stride + TSR_PICTURE_BLOCK * place.x;
    if (c->in != NULL) {
        take_block(c, x, y, pixels, rows.stride);
    }
    if (c->is_literal) {
        code_mean(port, pixels, rows.stride, &rows.limits[place.x]);
    } else {
        const struct tsr_picture_known known = {.left = place.x > 0 && done > 0,
                                                .above = place.y > 0 && done >= place.strip_width};
        tsr_picture_code_block(c->model, port, &rows, place.x, known);
    }
    if (c->out != NULL) {
        hand_out_block(c, x, y, pixels, rows.stride);
        c->marks[(size_t)place.y * c->grid.width + block_x] = (uint8_t)(1u + rows.limits[place.x]);
    }
}

static bool code_blocks(void *coding, struct tsr_range_encoder *range, uint32_t done, uint32_t count)
{
    const struct tsr_range_port port = {.encoder = range};
    for (const uint32_t end = done + count; done < end; done++) {
        code_one(coding, &port, done);
    }
    return true;
}

/* As many blocks as fit, with the finest quantiser that lets one fit, or one literal block. */
static void code_payload(struct tsr_picture_packet_encoder *encoder, struct coding *c, struct tsr_range_encoder *range,
                         uint8_t *payload, size_t cap, struct tsr_packet *packet)
{
    const uint32_t limit = smaller(tsr_packet_units(&c->grid) - packet->first, COUNT_MAX);
    for (unsigned coarser = 0; coarser <= COARSER_MAX && packet->count == 0; coarser++) {
        packet->coarser = (uint8_t)coarser;
        start_packet(&encoder->state, &encoder->info, coarser);
        tsr_range_encode_start(range, payload, cap);
        (void)tsr_packet_fill(range, limit, 1, code_blocks, c, &packet->count);
    }
    if (packet->count == 0) {
        packet->count = 1;
        packet->coarser = 0;
        c->is_literal = packet->is_literal = true;
        tsr_range_encode_start(range, payload, cap);
        (void)code_blocks(c, range, 0, 1);
    }
}

enum tsr_status tsr_picture_packets_start(struct tsr_picture_packet_encoder *encoder,
                                          const struct tsr_picture_info *info, const uint8_t *picture, size_t stride,
                                          uint8_t id)
{
    if (encoder == NULL || picture == NULL || !is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    encoder->info = *info;
    return tsr_packet_source_start(&encoder->source, picture, stride, info->width, info->height, id);
}

enum tsr_status tsr_picture_packets_next(struct tsr_picture_packet_encoder *encoder, uint8_t *out, size_t out_cap,
                                         size_t *len)
{
    if (encoder == NULL || out == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    const struct tsr_packet_source *source = &encoder->source;
    struct coding c = {.model = &encoder->state.model,
                       .grid = grid_of(source->width, source->height),
                       .in = source->pixels,
                       .stride = source->stride,
                       .width = source->width,
                       .height = source->height,
                       .first = source->position};
    const enum tsr_status status = tsr_packet_check_next(source, &c.grid, out_cap);
    if (status != TSR_OK) {
        return status;
    }
    struct tsr_packet packet = {.id = source->id, .first = source->position};
    struct tsr_range_encoder range;
    code_payload(encoder, &c, &range, out + TSR_PACKET_HEADER_LEN, out_cap - TSR_PACKET_HEADER_LEN, &packet);
    return tsr_packet_finish(&encoder->source, &c.grid, &range, TSR_PICTURE_PACKET_FORMAT_VERSION, &packet, out, len);
}

enum tsr_status tsr_picture_packet_decode(struct tsr_picture_packet_state *state, const struct tsr_picture_info *info,
                                          uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet,
                                          uint8_t *picture, size_t stride, uint8_t *marks, size_t marks_cap)
{
    if (state == NULL || bytes == NULL || packet == NULL || picture == NULL || marks == NULL || !is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    if (stride < info->width) {
        return TSR_ERR_SIZE;
    }
    if (marks_cap < TSR_PICTURE_MARKS_LEN(info->width, info->height)) {
        return TSR_ERR_NOBUF;
    }
    struct coding c = {.model = &state->model,
                       .grid = grid_of(info->width, info->height),
                       .out = picture,
                       .marks = marks,
                       .stride = stride,
                       .width = info->width,
                       .height = info->height};
    const enum tsr_status status =
        tsr_packet_read_header(bytes, len, &c.grid, TSR_PICTURE_PACKET_FORMAT_VERSION, id, packet);
    if (status != TSR_OK) {
        return status;
    }
    c.first = packet->first;
    c.is_literal = packet->is_literal;
    struct tsr_range_decoder range;
    const struct tsr_range_port port = {.decoder = &range};
    start_packet(state, info, packet->coarser);
    tsr_range_decode_start(&range, bytes + TSR_PACKET_HEADER_LEN, len - TSR_PACKET_HEADER_LEN);
    for (uint32_t done = 0; done < packet->count; done++) {
        code_one(&c, &port, done);
    }
    return TSR_OK;
}

size_t tsr_picture_packets_missing(const struct tsr_picture_info *info, const uint8_t *marks)
{
    size_t missing = 0;
    for (size_t i = 0; info != NULL && marks != NULL && i < TSR_PICTURE_MARKS_LEN(info->width, info->height); i++) {
        missing += marks[i] == 0;
    }
    return missing;
}
