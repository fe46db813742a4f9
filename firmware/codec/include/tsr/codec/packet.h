/*
 * What packets of gray images, views and pictures have in common: they decode
 * alone, come in any order and twice, and lose nothing but their own units.
 *
 *   encode   tsr_<codec>_packets_start ─► tsr_<codec>_packets_next (TSR_AGAIN) ... (TSR_OK)
 *   decode   [arrived zeroed]          ─► tsr_<codec>_packet_decode ... ─► tsr_packets_missing
 *
 * Units are pixels of gray images and views, and blocks of 8 x 8 pixels of pictures.
 * They are counted in strips of 16 columns of pixels, of pictures 32 (the last one may be
 * narrower), a strip from top to bottom, its rows from the left. What all packets of an image
 * share (its info) travels otherwise: with a site's description, or in a file's
 * header. Messages are authenticated elsewhere; a packet that was cut is not told
 * from another, unless its header is incomplete. Every bit: docs/codec.md, 3a to 5a.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PACKET_H
#define TSR_CODEC_PACKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TSR_PACKET_HEADER_LEN 4
/* A header and a group of literal units with the range coder's end always fit. */
#define TSR_PACKET_LEN_MIN 20
#define TSR_PACKET_ID_MAX 7
/* Columns of a strip, of gray images and views, and of pictures: what measures best (docs/codec.md, 5a.4). */
#define TSR_PACKET_STRIP_PX 16
#define TSR_PICTURE_PACKET_STRIP_PX 32
/* Pixels are sent and marked in groups of so many, but at the end of the image. */
#define TSR_PACKET_GROUP_PX 8

/* What a packet says of itself. */
struct tsr_packet {
    uint8_t id;      /* of the image, 0 .. TSR_PACKET_ID_MAX */
    uint8_t coarser; /* pictures: half octaves by which the quantiser is above the picture's, else 0 */
    bool is_literal; /* units are stored, not coded */
    uint32_t first;  /* unit */
    uint32_t count;  /* units, 1 .. 4096 pixels or 512 blocks */
};

/* An image on its way into packets. Content private to the codecs. */
struct tsr_packet_source {
    const uint8_t *pixels;
    size_t stride;
    uint16_t width, height; /* px */
    uint8_t id;
    uint32_t position; /* units in earlier packets */
};

/* Bytes of `arrived` for gray images and views: a bit a group of pixels, in the order of packets, from bit 0 of each
 * byte; 1 = has come. */
#define TSR_PACKET_ARRIVED_LEN(width, height)                                                                          \
    (((size_t)(width) * (height) + 8u * TSR_PACKET_GROUP_PX - 1u) / (8u * TSR_PACKET_GROUP_PX))

/* Has the pixel come? 0 <= x < width, 0 <= y < height; arrived [TSR_PACKET_ARRIVED_LEN] in. */
bool tsr_packets_have(const uint8_t *arrived, uint16_t width, uint16_t height, uint16_t x, uint16_t y);

/* Pixels that are still missing; 0 for a null pointer. */
size_t tsr_packets_missing(const uint8_t *arrived, uint16_t width, uint16_t height);

#endif
