/*
 * Packets of gray images: the pixel model of gray_row.c in strips.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray_packet.h"

#include <string.h>

#include "gray_row.h"
#include "packet_pixels.h"

#define MIDDLE_GRAY 128
#define LITERAL_BITS 8

static void start_packet(void *model)
{
    struct tsr_gray_model *gray = model;
    tsr_gray_model_reset(gray);
    const unsigned kind = gray->info.near == 0 ? 0u : gray->info.near <= TSR_GRAY_NEAR_MAX ? 1u : 2u;
    tsr_range_bits_load(gray->contexts, tsr_gray_packet_prior[kind], TSR_GRAY_CONTEXT_COUNT);
    gray->allowed_bits = UINT32_MAX / 2u; /* a packet is literal as a whole or not at all */
}

static void enter_strip(void *model, unsigned strip_width, uint8_t unknown)
{
    struct tsr_gray_model *gray = model;
    gray->info.width = (uint16_t)strip_width;
    memset(gray->scratch, unknown, 2u * strip_width);
    memset(gray->scratch + 2u * strip_width, 0, strip_width);
}

static uint8_t *enter_row(void *model, unsigned y)
{
    struct tsr_gray_model *gray = model;
    gray->row = (uint16_t)y;
    return tsr_gray_row_pixels(gray);
}

static void code_span(void *model, const struct tsr_range_port *port, unsigned x, unsigned end)
{
    tsr_gray_code_span(model, port, x, end);
}

static uint8_t admit(const void *model, uint8_t pixel)
{
    (void)model;
    return pixel;
}

static struct tsr_pixel_model model_of(struct tsr_gray_packet_state *state, const struct tsr_gray_info *info)
{
    state->model.info = *info;
    state->model.info.width = TSR_PACKET_STRIP_PX;
    state->model.scratch = state->rows;
    return (struct tsr_pixel_model){.model = &state->model,
                                    .version = TSR_GRAY_PACKET_FORMAT_VERSION,
                                    .literal_bits = LITERAL_BITS,
                                    .first_is_direct = true,
                                    .start = start_packet,
                                    .enter_strip = enter_strip,
                                    .enter_row = enter_row,
                                    .code = code_span,
                                    .admit = admit,
                                    .unknown = MIDDLE_GRAY};
}

enum tsr_status tsr_gray_packets_start(struct tsr_gray_packet_encoder *encoder, const struct tsr_gray_info *info,
                                       const uint8_t *image, size_t stride, uint8_t id)
{
    if (encoder == NULL || image == NULL || tsr_gray_encoded_len_max(info) == 0) {
        return TSR_ERR_ARG;
    }
    encoder->info = *info;
    return tsr_packet_source_start(&encoder->source, image, stride, info->width, info->height, id);
}

enum tsr_status tsr_gray_packets_next(struct tsr_gray_packet_encoder *encoder, uint8_t *out, size_t out_cap,
                                      size_t *len)
{
    if (encoder == NULL || out == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    const struct tsr_pixel_model model = model_of(&encoder->state, &encoder->info);
    return tsr_pixel_packets_next(&model, &encoder->source, out, out_cap, len);
}

enum tsr_status tsr_gray_packet_decode(struct tsr_gray_packet_state *state, const struct tsr_gray_info *info,
                                       uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet,
                                       uint8_t *image, size_t stride, uint8_t *arrived, size_t arrived_cap)
{
    if (state == NULL || bytes == NULL || packet == NULL || image == NULL || arrived == NULL ||
        tsr_gray_encoded_len_max(info) == 0) {
        return TSR_ERR_ARG;
    }
    const struct tsr_pixel_model model = model_of(state, info);
    const struct tsr_pixel_sink sink = {image, stride, arrived, arrived_cap, info->width, info->height};
    return tsr_pixel_packet_decode(&model, &sink, id, bytes, len, packet);
}
