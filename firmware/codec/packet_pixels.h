/*
 * Packets of gray pixels, for gray images and views: what only the pixel's
 * model does is behind tsr_pixel_model, the rest is the same.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PACKET_PIXELS_H
#define TSR_CODEC_PACKET_PIXELS_H

#include "packet.h"
#include "range_port.h"

/* The model of one codec; `model` is that codec's. */
struct tsr_pixel_model {
    void *model;
    uint8_t version;      /* of the packets */
    uint8_t literal_bits; /* of a literal pixel */
    bool first_is_direct; /* the first pixel of a packet is a literal one, and what is unknown counts as it */
    /* Forget everything, as at the beginning of each packet. */
    void (*start)(void *model);
    /* Enter a strip: what no pixel has said of it counts as this one. */
    void (*enter_strip)(void *model, unsigned strip_width, uint8_t unknown);
    /* Step to row y of the strip; gives its pixels [strip_width]. */
    uint8_t *(*enter_row)(void *model, unsigned y);
    /* Code columns x .. end - 1 of the row: from its pixels, which are replaced by decoded ones, or into them. */
    void (*code)(void *model, const struct tsr_range_port *port, unsigned x, unsigned end);
    /* The pixel as a literal one comes back, whatever it is. */
    uint8_t (*admit)(const void *model, uint8_t pixel);
    uint8_t unknown; /* counts as this before the first pixel */
};

/* As tsr_gray_packets_next. */
enum tsr_status tsr_pixel_packets_next(const struct tsr_pixel_model *model, struct tsr_packet_source *source,
                                       uint8_t *out, size_t out_cap, size_t *len);

/* An image that packets are decoded into. */
struct tsr_pixel_sink {
    uint8_t *pixels;
    size_t stride;
    uint8_t *arrived;
    size_t arrived_cap;
    uint16_t width, height;
};

/* As tsr_gray_packet_decode; pointers and the image's size are checked by the caller. */
enum tsr_status tsr_pixel_packet_decode(const struct tsr_pixel_model *model, const struct tsr_pixel_sink *sink,
                                        uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet);

#endif
