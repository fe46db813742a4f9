/*
 * Packets of gray pixels: docs/codec.md, 3a and 4a.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "packet_pixels.h"

#include <string.h>

#define COUNT_MAX 4096u

/* One packet being coded, in either direction: from `in`, or into `out`. */
struct coding {
    const struct tsr_pixel_model *model;
    struct tsr_packet_grid grid;
    const uint8_t *in;
    uint8_t *out;
    size_t stride;
    uint32_t first;
    bool is_literal;
    uint8_t last; /* pixel coded last */
};

static struct tsr_packet_grid grid_of(uint16_t width, uint16_t height)
{
    return (struct tsr_packet_grid){width, height, TSR_PACKET_STRIP_PX, TSR_PACKET_GROUP_PX, TSR_PACKET_FIRST_BITS};
}

/* Columns x .. end - 1 of a row of the strip. */
static void code_span(const struct coding *c, const struct tsr_range_port *port, uint8_t *row, unsigned x, unsigned end,
                      bool direct)
{
    const struct tsr_pixel_model *m = c->model;
    if (!direct) {
        m->code(m->model, port, x, end);
        return;
    }
    for (; x < end; x++) {
        row[x] = m->admit(m->model, (uint8_t)tsr_port_direct(port, row[x], m->literal_bits));
    }
}

/* count pixels after the first `done` of the packet. */
static void code_pixels(struct coding *c, const struct tsr_range_port *port, uint32_t done, uint32_t count)
{
    const struct tsr_pixel_model *m = c->model;
    for (const uint32_t end_done = done + count; done < end_done;) {
        const struct tsr_packet_place place = tsr_packet_place_of(&c->grid, c->first + done);
        if (done == 0 || (place.x == 0 && place.y == 0)) {
            m->enter_strip(m->model, place.strip_width, c->last);
        }
        const unsigned left = place.strip_width - place.x, wanted = end_done - done;
        const unsigned count_here = done == 0 ? 1u : wanted < left ? wanted : left;
        uint8_t *row = m->enter_row(m->model, place.y);
        const size_t at = place.y * c->stride + place.strip_x + place.x;
        for (unsigned i = 0; c->in != NULL && i < count_here; i++) {
            row[place.x + i] = m->admit(m->model, c->in[at + i]);
        }
        code_span(c, port, row, place.x, place.x + count_here, c->is_literal || (done == 0 && m->first_is_direct));
        if (c->out != NULL) {
            memcpy(c->out + at, row + place.x, count_here);
        }
        c->last = row[place.x + count_here - 1u];
        if (done == 0 && m->first_is_direct) {
            m->enter_strip(m->model, place.strip_width, c->last);
        }
        done += count_here;
    }
}

static bool code_group(void *coding, struct tsr_range_encoder *range, uint32_t done, uint32_t count)
{
    const struct tsr_range_port port = {.encoder = range};
    code_pixels(coding, &port, done, count);
    return true;
}

/* From its first byte on: as many pixels as fit coded, or literal where that holds more. */
static void code_payload(struct coding *c, struct tsr_range_encoder *range, uint8_t *payload, size_t cap,
                         struct tsr_packet *packet)
{
    const uint32_t left = tsr_packet_units(&c->grid) - packet->first, limit = left < COUNT_MAX ? left : COUNT_MAX;
    c->model->start(c->model->model);
    tsr_range_encode_start(range, payload, cap);
    (void)tsr_packet_fill(range, limit, TSR_PACKET_GROUP_PX, code_group, c, &packet->count);
    uint32_t literal = tsr_packet_literal_count(cap, c->model->literal_bits, TSR_PACKET_GROUP_PX);
    literal = literal < limit ? literal : limit;
    c->is_literal = packet->is_literal = packet->count < literal;
    if (packet->is_literal) {
        packet->count = literal;
        tsr_range_encode_start(range, payload, cap);
        (void)code_group(c, range, 0, literal);
    }
}

enum tsr_status tsr_pixel_packets_next(const struct tsr_pixel_model *model, struct tsr_packet_source *source,
                                       uint8_t *out, size_t out_cap, size_t *len)
{
    struct coding c = {.model = model,
                       .grid = grid_of(source->width, source->height),
                       .in = source->pixels,
                       .stride = source->stride,
                       .first = source->position,
                       .last = model->unknown};
    const enum tsr_status status = tsr_packet_check_next(source, &c.grid, out_cap);
    if (status != TSR_OK) {
        return status;
    }
    struct tsr_packet packet = {.id = source->id, .first = c.first};
    struct tsr_range_encoder range;
    code_payload(&c, &range, out + TSR_PACKET_HEADER_LEN, out_cap - TSR_PACKET_HEADER_LEN, &packet);
    return tsr_packet_finish(source, &c.grid, &range, model->version, &packet, out, len);
}

enum tsr_status tsr_pixel_packet_decode(const struct tsr_pixel_model *model, const struct tsr_pixel_sink *sink,
                                        uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet)
{
    if (sink->stride < sink->width) {
        return TSR_ERR_SIZE;
    }
    if (sink->arrived_cap < TSR_PACKET_ARRIVED_LEN(sink->width, sink->height)) {
        return TSR_ERR_NOBUF;
    }
    struct coding c = {.model = model,
                       .grid = grid_of(sink->width, sink->height),
                       .out = sink->pixels,
                       .stride = sink->stride,
                       .last = model->unknown};
    const enum tsr_status status = tsr_packet_read_header(bytes, len, &c.grid, model->version, id, packet);
    if (status != TSR_OK) {
        return status;
    }
    c.first = packet->first;
    c.is_literal = packet->is_literal;
    struct tsr_range_decoder range;
    const struct tsr_range_port port = {.decoder = &range};
    tsr_range_decode_start(&range, bytes + TSR_PACKET_HEADER_LEN, len - TSR_PACKET_HEADER_LEN);
    model->start(model->model);
    code_pixels(&c, &port, 0, packet->count);
    for (uint32_t group = c.first / TSR_PACKET_GROUP_PX; group * TSR_PACKET_GROUP_PX < c.first + packet->count;
         group++) {
        sink->arrived[group / 8u] = (uint8_t)(sink->arrived[group / 8u] | 1u << group % 8u);
    }
    return TSR_OK;
}
