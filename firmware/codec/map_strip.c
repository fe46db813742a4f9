/*
 * A packet's pixels in their order, and what is taken for its neighbours.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_strip.h"

struct tsr_packet_grid tsr_map_packet_grid(const struct tsr_map_info *info)
{
    return (struct tsr_packet_grid){info->width, info->height, TSR_MAP_PACKET_STRIP_WIDTH, TSR_MAP_PACKET_GROUP_PIXELS,
                                    TSR_PACKET_FIRST_BITS};
}

static struct tsr_packet_place place_of(const struct tsr_map_info *info, uint32_t position)
{
    const struct tsr_packet_grid grid = tsr_map_packet_grid(info);
    return tsr_packet_place_of(&grid, position);
}

/* What no pixel of the packet has said counts as this label. */
static void fill_unknown(struct tsr_map_model *model, unsigned label)
{
    for (size_t i = 0; i < TSR_MAP_PACKET_SCRATCH_COUNT; i++) {
        model->scratch[i] = (uint16_t)label;
    }
}

enum tsr_status tsr_map_strip_start(struct tsr_map_model *model, const struct tsr_map_info *info, uint32_t first,
                                    uint16_t *scratch, size_t scratch_cap)
{
    if (scratch_cap < TSR_MAP_PACKET_SCRATCH_COUNT) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_map_info strip = *info;
    strip.width = (uint16_t)place_of(info, first).strip_width;
    const enum tsr_map_coding coding = info->near > 0 ? TSR_MAP_CODING_NEAR : TSR_MAP_CODING_PACKET;
    const enum tsr_status status =
        tsr_map_model_start(model, &strip, NULL, tsr_map_prior.cells[coding], scratch, scratch_cap);
    model->coding = (uint8_t)coding;
    return status;
}

struct tsr_map_span tsr_map_strip_next(struct tsr_map_model *model, const struct tsr_map_info *info, uint32_t first,
                                       uint32_t done, uint32_t count)
{
    const struct tsr_packet_place begin = place_of(info, first), place = place_of(info, first + done);
    model->row = (uint16_t)place.y;
    model->allowed_bits = UINT32_MAX / 2u; /* a packet is literal as a whole or not at all */
    if (place.x == 0 && place.y == 0 && done > 0) {
        model->info.width = (uint16_t)place.strip_width;
        fill_unknown(model, model->last_label);
    }
    if (place.x == 0 && done > 0) {
        uint16_t *here = tsr_map_row_labels(model, 0);
        const uint16_t above = tsr_map_row_labels(model, 1)[0];
        here[-1] = above;
        here[-2] = above;
        here[-3] = above;
        model->run = 0;
    }
    const bool is_top = place.y == 0 || (place.y == begin.y && place.strip_x == begin.strip_x);
    const unsigned left = place.strip_width - place.x;
    return (struct tsr_map_span){.place = place,
                                 .end = place.x + (is_top         ? 1u
                                                   : count < left ? count
                                                                  : left),
                                 .is_top = is_top};
}

/* The rows above a top row are as it: from its last pixel on all as that one, so that a flat region looks flat. */
static void fill_above(struct tsr_map_model *model, unsigned from, unsigned strip_width)
{
    uint16_t *const up = tsr_map_row_labels(model, 1), *const up2 = tsr_map_row_labels(model, 2);
    const uint16_t label = tsr_map_row_labels(model, 0)[from];
    for (unsigned x = from; x < strip_width + TSR_MAP_PAD_RIGHT; x++) {
        up[x] = label;
        up2[x] = label;
    }
}

void tsr_map_strip_close(struct tsr_map_model *model, const struct tsr_map_span *span, uint32_t done)
{
    uint16_t *labels = tsr_map_row_labels(model, 0);
    const unsigned end = span->end;
    if (done == 0) {
        fill_unknown(model, labels[span->place.x]);
    } else if (span->is_top) {
        fill_above(model, end - 1u, span->place.strip_width);
    }
    if (end == span->place.strip_width) {
        labels[end] = labels[end - 1u];
        labels[end + 1u] = labels[end - 1u];
    }
}
