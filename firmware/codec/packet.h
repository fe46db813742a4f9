/*
 * Mechanics of packets, docs/codec.md, 2a.1, 3a.1 and 5a.1: the header, where units
 * lie, and filling a packet with as many groups of units as fit.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PACKET_PRIVATE_H
#define TSR_CODEC_PACKET_PRIVATE_H

#include "tsr/base/status.h"
#include "tsr/codec/packet.h"
#include "tsr/codec/range.h"

#define TSR_PACKET_FIRST_BITS 17u

/* Of the units of one image. */
struct tsr_packet_grid {
    uint16_t width, height; /* units */
    uint8_t strip_width;    /* units, but for the last strip */
    uint8_t group;          /* units; first and count are multiples of it, but at the image's end */
    uint8_t first_bits;     /* of the header's field, at most TSR_PACKET_FIRST_BITS; `coarser` has the others */
};

/* Where a unit lies. */
struct tsr_packet_place {
    unsigned strip_x, strip_width; /* columns of the strip */
    unsigned x, y;                 /* x within the strip */
};

static inline uint32_t tsr_packet_units(const struct tsr_packet_grid *grid)
{
    return (uint32_t)grid->width * grid->height;
}

struct tsr_packet_place tsr_packet_place_of(const struct tsr_packet_grid *grid, uint32_t position);

void tsr_packet_write_header(uint8_t out[TSR_PACKET_HEADER_LEN], const struct tsr_packet_grid *grid, unsigned version,
                             const struct tsr_packet *packet);

/*
 * TSR_ERR_FORMAT for fewer bytes than a header or units beyond the grid, TSR_ERR_VERSION for another version,
 * TSR_ERR_NOREF for another id, in the order of docs/codec.md; on error packet is untouched.
 */
enum tsr_status tsr_packet_read_header(const uint8_t *bytes, size_t len, const struct tsr_packet_grid *grid,
                                       unsigned version, unsigned id, struct tsr_packet *packet);

/* TSR_ERR_ARG for an id out of range, TSR_ERR_SIZE for a stride < width; pointers and sizes are checked by the caller.
 */
enum tsr_status tsr_packet_source_start(struct tsr_packet_source *source, const uint8_t *pixels, size_t stride,
                                        uint16_t width, uint16_t height, uint8_t id);

/* May a packet of out_cap bytes follow? TSR_ERR_NOBUF if they are too few, TSR_ERR_SIZE after the last packet. */
enum tsr_status tsr_packet_check_next(const struct tsr_packet_source *source, const struct tsr_packet_grid *grid,
                                      size_t out_cap);

/* End the stream that begins after the header of out, write the header and go on to the next packet: TSR_AGAIN, TSR_OK
 * with the last one. *len only then. */
enum tsr_status tsr_packet_finish(struct tsr_packet_source *source, const struct tsr_packet_grid *grid,
                                  struct tsr_range_encoder *range, unsigned version, const struct tsr_packet *packet,
                                  uint8_t *out, size_t *len);

/* Codes count units after the first `done` of a packet; false if a unit cannot be coded at all. */
typedef bool tsr_packet_code_units(void *codec, struct tsr_range_encoder *range, uint32_t done, uint32_t count);

/* As many groups as fit in the fresh stream, at most limit units; false if `code` gave up. */
bool tsr_packet_fill(struct tsr_range_encoder *range, uint32_t limit, uint32_t group, tsr_packet_code_units *code,
                     void *codec, uint32_t *count);

/* Groups of this many units of so many direct bits that fit whatever they are, in units. */
uint32_t tsr_packet_literal_count(size_t payload_cap, unsigned unit_bits, uint32_t group);

#endif
