/*
 * Pictures in packets that decode alone (tsr/codec/packet.h): the blocks of
 * tsr/codec/picture.h, from the trained prior. Every bit: docs/codec.md, chapter 5a.
 *
 * Packets hold whole blocks. A block that would not fit in a packet of its own is
 * coded with a coarser quantiser, in the end as its mean, so any picture can be sent.
 * The decoder's filter comes last and for all that has arrived, so that it does
 * not depend on the order of the packets:
 *
 *   decode   [marks zeroed] ─► tsr_picture_packet_decode ... ─► tsr_picture_packets_smooth
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PICTURE_PACKET_H
#define TSR_CODEC_PICTURE_PACKET_H

#include "tsr/codec/packet.h"
#include "tsr/codec/picture.h"

/* Of the packets, of a picture's blocks and of their prior together. */
#define TSR_PICTURE_PACKET_FORMAT_VERSION 1

/* Bytes of `marks`: one a block, row by row: 0 = has not come, else 1 + its limit (docs/codec.md, 5.3). */
#define TSR_PICTURE_MARKS_LEN(width, height) (TSR_PICTURE_BLOCKS(width) * TSR_PICTURE_BLOCKS(height))

/* A packet being coded. Content private to the codec; may be moved between calls. */
struct tsr_picture_packet_state {
    struct tsr_picture_model model;
    uint8_t rows[TSR_PICTURE_SCRATCH_LEN(TSR_PICTURE_PACKET_STRIP_PX)];
};

struct tsr_picture_packet_encoder {
    struct tsr_picture_packet_state state;
    struct tsr_picture_info info;
    struct tsr_packet_source source;
};

/*
 * Begin a picture.
 *
 *   info     in, copied; step is that of all packets; prior is TSR_PICTURE_PRIOR_TRAINED
 *   picture  [height * stride] kept until the last packet
 *   id       tells the packets of this picture from those of the ones before it
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer, an info field or id out of range; TSR_ERR_SIZE for a stride < width.
 */
enum tsr_status tsr_picture_packets_start(struct tsr_picture_packet_encoder *encoder,
                                          const struct tsr_picture_info *info, const uint8_t *picture, size_t stride,
                                          uint8_t id);

/*
 * Make the next packet: as many blocks as fit in out[out_cap], out_cap >= TSR_PACKET_LEN_MIN and the same or not the
 * same from call to call. Worst-case cost: 528 blocks as tsr/codec/picture.h says.
 *
 * Returns TSR_AGAIN with a packet of *len bytes when more follow, TSR_OK with the last one. TSR_ERR_ARG for a null
 * pointer, TSR_ERR_NOBUF for a smaller out_cap, TSR_ERR_SIZE after the last packet; then *len is untouched.
 */
enum tsr_status tsr_picture_packets_next(struct tsr_picture_packet_encoder *encoder, uint8_t *out, size_t out_cap,
                                         size_t *len);

/*
 * Decode a packet of the picture that info describes into its blocks, not yet smoothed.
 *
 *   state     used meanwhile
 *   packet    out, filled
 *   picture   [height * stride], out: only the packet's blocks
 *   marks     [marks_cap], in and out: the packet's blocks are marked; zeroed before the first packet;
 *             marks_cap >= TSR_PICTURE_MARKS_LEN(width, height)
 *
 * Any bytes after a valid header decode to some blocks. Returns TSR_OK; TSR_ERR_FORMAT for fewer bytes than a header
 * or blocks beyond the picture; TSR_ERR_VERSION for another version; TSR_ERR_NOREF for a packet of another id;
 * TSR_ERR_ARG for a null pointer or an info field out of range, TSR_ERR_SIZE for a stride < width, TSR_ERR_NOBUF if
 * marks_cap is too small. On error packet, picture and marks are untouched.
 */
enum tsr_status tsr_picture_packet_decode(struct tsr_picture_packet_state *state, const struct tsr_picture_info *info,
                                          uint8_t id, const uint8_t *bytes, size_t len, struct tsr_packet *packet,
                                          uint8_t *picture, size_t stride, uint8_t *marks, size_t marks_cap);

/* Blocks that are still missing; 0 for a null pointer. */
size_t tsr_picture_packets_missing(const struct tsr_picture_info *info, const uint8_t *marks);

/*
 * Smooth the blocks that have come, as the codec of whole pictures does; missing blocks do not pull and are copied. May
 * be called at any time and again: picture and marks stay as they are.
 *
 *   picture   [height * stride] in, of tsr_picture_packet_decode
 *   marks     [TSR_PICTURE_MARKS_LEN] in
 *   out       [height * out_stride] out, another array than picture
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range, TSR_ERR_SIZE for a stride < width.
 */
enum tsr_status tsr_picture_packets_smooth(const struct tsr_picture_info *info, const uint8_t *picture, size_t stride,
                                           const uint8_t *marks, uint8_t *out, size_t out_stride);

#endif
