/*
 * Prefiltered views in packets that decode alone (tsr/codec/packet.h): the levels
 * of tsr/codec/view.h, exact or coarse, on their own, from a trained prior. Every bit:
 * docs/codec.md, chapter 4a.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_VIEW_PACKET_H
#define TSR_CODEC_VIEW_PACKET_H

#include "tsr/codec/packet.h"
#include "tsr/codec/view.h"

/* Of the packets, of a view's levels and of their prior together. */
#define TSR_VIEW_PACKET_FORMAT_VERSION 1

/* A packet being coded. Content private to the codec; may be moved between calls. */
struct tsr_view_packet_state {
    struct tsr_view_model model;
    uint8_t rows[TSR_VIEW_SCRATCH_LEN(TSR_PACKET_STRIP_PX)];
};

struct tsr_view_packet_encoder {
    struct tsr_view_packet_state state;
    struct tsr_view_info info;
    struct tsr_packet_source source;
};

/*
 * Begin a view.
 *
 *   info     in, copied; not against_held
 *   view     [height * stride] kept until the last packet, prefiltered pixels; above 2 cap counts as 2 cap
 *   id       tells the packets of this view from those of the ones before it
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer, an info field (or against_held) or id out of range;
 * TSR_ERR_SIZE for a stride < width.
 */
enum tsr_status tsr_view_packets_start(struct tsr_view_packet_encoder *encoder, const struct tsr_view_info *info,
                                       const uint8_t *view, size_t stride, uint8_t id);

/*
 * Make the next packet: as many pixels as fit in out[out_cap], out_cap >= TSR_PACKET_LEN_MIN and the same or not the
 * same from call to call. Worst-case cost: 8192 pixels as tsr/codec/view.h says.
 *
 * Returns TSR_AGAIN with a packet of *len bytes when more follow, TSR_OK with the last one. TSR_ERR_ARG for a null
 * pointer, TSR_ERR_NOBUF for a smaller out_cap, TSR_ERR_SIZE after the last packet; then *len is untouched.
 */
enum tsr_status tsr_view_packets_next(struct tsr_view_packet_encoder *encoder, uint8_t *out, size_t out_cap,
                                      size_t *len);

/*
 * Decode a packet of the view that info describes into its pixels.
 *
 *   state     used meanwhile
 *   packet    out, filled
 *   view      [height * stride], out: only the packet's pixels
 *   arrived   [arrived_cap], in and out: the packet's groups are marked; zeroed before the first packet;
 *             arrived_cap >= TSR_PACKET_ARRIVED_LEN(width, height)
 *
 * Any bytes after a valid header decode to some pixels. Returns TSR_OK; TSR_ERR_FORMAT for fewer bytes than a header
 * or pixels beyond the view; TSR_ERR_VERSION for another version; TSR_ERR_NOREF for a packet of another id;
 * TSR_ERR_ARG for a null pointer or an info field out of range, TSR_ERR_SIZE for a stride < width, TSR_ERR_NOBUF if
 * arrived_cap is too small. On error packet, view and arrived are untouched.
 */
enum tsr_status tsr_view_packet_decode(struct tsr_view_packet_state *state, const struct tsr_view_info *info,
                                       uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet,
                                       uint8_t *view, size_t stride, uint8_t *arrived, size_t arrived_cap);

#endif
