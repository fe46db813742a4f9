/*
 * Packets of prefiltered views: the model of view_row.c in strips.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/view_packet.h"

#include "packet_pixels.h"
#include "view_row.h"

#define LITERAL_BITS 4

static void start_packet(void *model)
{
    struct tsr_view_model *view = model;
    tsr_view_model_reset(view);
    tsr_range_bits_load(view->contexts, tsr_view_packet_prior[view->info.coarse ? 1 : 0], TSR_VIEW_CONTEXT_COUNT);
    view->allowed_bits = UINT32_MAX / 2u; /* a packet is literal as a whole or not at all */
}

/* What is unknown has no contrast, whatever the pixels beside it. */
static void enter_strip(void *model, unsigned strip_width, uint8_t unknown)
{
    struct tsr_view_model *view = model;
    (void)unknown;
    view->info.width = (uint16_t)strip_width;
    tsr_view_clear_rows(view);
}

static uint8_t *enter_row(void *model, unsigned y)
{
    struct tsr_view_model *view = model;
    view->row = (uint16_t)y;
    return tsr_view_row_pixels(view);
}

static void code_span(void *model, const struct tsr_range_port *port, unsigned x, unsigned end)
{
    tsr_view_code_span(model, port, x, end);
}

static uint8_t admit(const void *model, uint8_t pixel)
{
    const struct tsr_view_model *view = model;
    const int cap = view->info.cap, value = (pixel < 2 * cap ? pixel : 2 * cap) - cap;
    const int magnitude = view->value_of[view->level_of[value < 0 ? -value : value]];
    return (uint8_t)(value < 0 ? cap - magnitude : cap + magnitude);
}

static struct tsr_pixel_model model_of(struct tsr_view_packet_state *state, const struct tsr_view_info *info)
{
    state->model.info = *info;
    state->model.info.width = TSR_PACKET_STRIP_PX;
    state->model.scratch = state->rows;
    state->model.held = NULL;
    return (struct tsr_pixel_model){.model = &state->model,
                                    .version = TSR_VIEW_PACKET_FORMAT_VERSION,
                                    .literal_bits = LITERAL_BITS,
                                    .first_is_direct = false,
                                    .start = start_packet,
                                    .enter_strip = enter_strip,
                                    .enter_row = enter_row,
                                    .code = code_span,
                                    .admit = admit,
                                    .unknown = info->cap};
}

enum tsr_status tsr_view_packets_start(struct tsr_view_packet_encoder *encoder, const struct tsr_view_info *info,
                                       const uint8_t *view, size_t stride, uint8_t id)
{
    if (encoder == NULL || view == NULL || tsr_view_encoded_len_max(info) == 0 || info->against_held) {
        return TSR_ERR_ARG;
    }
    encoder->info = *info;
    return tsr_packet_source_start(&encoder->source, view, stride, info->width, info->height, id);
}

enum tsr_status tsr_view_packets_next(struct tsr_view_packet_encoder *encoder, uint8_t *out, size_t out_cap,
                                      size_t *len)
{
    if (encoder == NULL || out == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    const struct tsr_pixel_model model = model_of(&encoder->state, &encoder->info);
    return tsr_pixel_packets_next(&model, &encoder->source, out, out_cap, len);
}

enum tsr_status tsr_view_packet_decode(struct tsr_view_packet_state *state, const struct tsr_view_info *info,
                                       uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet,
                                       uint8_t *view, size_t stride, uint8_t *arrived, size_t arrived_cap)
{
    if (state == NULL || bytes == NULL || packet == NULL || view == NULL || arrived == NULL ||
        tsr_view_encoded_len_max(info) == 0 || info->against_held) {
        return TSR_ERR_ARG;
    }
    const struct tsr_pixel_model model = model_of(state, info);
    const struct tsr_pixel_sink sink = {view, stride, arrived, arrived_cap, info->width, info->height};
    return tsr_pixel_packet_decode(&model, &sink, id, bytes, len, packet);
}
