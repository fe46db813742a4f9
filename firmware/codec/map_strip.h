/*
 * The way of a packet through a map: strips of columns, their rows, and what
 * counts for neighbours of which the packet has said nothing (docs/codec.md, 2a.2).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_STRIP_H
#define TSR_CODEC_MAP_STRIP_H

#include "map_model.h"
#include "packet.h"
#include "tsr/codec/map_packet.h"

#define TSR_MAP_PACKET_GROUP_PIXELS 8u /* counts of pixels are multiples of it, but at the map's end */

/* Pixels of one row that are coded at once. */
struct tsr_map_span {
    struct tsr_packet_place place; /* of the first */
    unsigned end;                  /* column within the strip after the last */
    bool is_top;                   /* nothing of the packet's lies above */
};

struct tsr_packet_grid tsr_map_packet_grid(const struct tsr_map_info *info);

/* Begin a packet whose first pixel is number first; TSR_ERR_ARG, TSR_ERR_NOBUF as tsr_map_packets_start. */
enum tsr_status tsr_map_strip_start(struct tsr_map_model *model, const struct tsr_map_info *info, uint32_t first,
                                    uint16_t *scratch, size_t scratch_cap);

/* The next pixels after `done` of a packet, to the end of their row and at most count >= 1; one by one while nothing is
 * known above. Steps into their row. */
struct tsr_map_span tsr_map_strip_next(struct tsr_map_model *model, const struct tsr_map_info *info, uint32_t first,
                                       uint32_t done, uint32_t count);

/* Once the labels of a span, which began after `done` pixels, are in the scratch. */
void tsr_map_strip_close(struct tsr_map_model *model, const struct tsr_map_span *span, uint32_t done);

/* Where the span's column x of its strip lies in a map. */
static inline size_t tsr_map_strip_index(const struct tsr_map_span *span, size_t stride, unsigned x)
{
    return span->place.y * stride + span->place.strip_x + x;
}

#endif
