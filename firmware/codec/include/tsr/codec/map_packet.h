/*
 * Disparity maps in packets that decode alone.
 *
 * For links without a way back, and for showing a map while it arrives: every
 * packet says which pixels it holds, starts from the trained prior and holds as
 * many pixels as fit. Losing packets loses their pixels and no others; they may
 * come in any order, and twice. What all packets of a map share (struct
 * tsr_map_info) travels otherwise: with a site's description, or in a file's header.
 * Every bit: docs/codec.md, chapter 2a.
 *
 *   encode   tsr_map_packets_start ─► tsr_map_packets_next (TSR_AGAIN) ... (TSR_OK)
 *   decode   tsr_map_packets_clear ─► tsr_map_packet_decode ... ─► tsr_map_packets_missing
 *
 * Pixels are counted in strips of 40 columns (the last one may be narrower), a
 * strip from top to bottom, its rows from the left. All buffers are the caller's.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_PACKET_H
#define TSR_CODEC_MAP_PACKET_H

#include "tsr/codec/map.h"

/* Of the packets, of a map's labels and of their prior together: 2 is map format 3 with prior 2. */
#define TSR_MAP_PACKET_FORMAT_VERSION 2
#define TSR_MAP_PACKET_HEADER_LEN 4
/* A header and eight literal pixels with the range coder's end always fit. */
#define TSR_MAP_PACKET_LEN_MIN 20
#define TSR_MAP_PACKET_MAP_ID_MAX 7
#define TSR_MAP_PACKET_STRIP_WIDTH 40
/* Elements of the uint16_t scratch rows. */
#define TSR_MAP_PACKET_SCRATCH_COUNT TSR_MAP_SCRATCH_COUNT(TSR_MAP_PACKET_STRIP_WIDTH)

/* Marks a pixel of a map of which no packet has come; no value and not TSR_DISPARITY_INVALID:
 * make it that one before the map is coded, held or restored. */
#define TSR_MAP_PIXEL_MISSING UINT16_C(0xfffe)

/* What a packet says of itself. */
struct tsr_map_packet {
    uint8_t map_id;  /* 0 .. TSR_MAP_PACKET_MAP_ID_MAX */
    bool is_literal; /* labels are stored, not coded */
    uint32_t first;  /* pixel, a multiple of 8 */
    uint32_t count;  /* 1 .. 4096 pixels */
};

/* Content private to the codec. */
struct tsr_map_packet_encoder {
    struct tsr_map_model model;
    struct tsr_map_info info;
    const uint16_t *map;
    size_t stride;
    uint16_t *scratch;
    uint8_t map_id;
    uint32_t position; /* pixels in earlier packets */
};

/*
 * Begin a map.
 *
 *   info      in, copied; near may be 1; coded alone
 *   map       [height * stride] kept until the last packet; UQ12.4 px
 *   map_id    tells the packets of this map from those of the maps before it
 *   scratch   [scratch_cap] kept; scratch_cap >= TSR_MAP_PACKET_SCRATCH_COUNT
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer, an info field or map_id out of range; TSR_ERR_SIZE for a
 * stride < width; TSR_ERR_NOBUF if scratch_cap is too small.
 */
enum tsr_status tsr_map_packets_start(struct tsr_map_packet_encoder *encoder, const struct tsr_map_info *info,
                                      const uint16_t *map, size_t stride, uint8_t map_id, uint16_t *scratch,
                                      size_t scratch_cap);

/*
 * Make the next packet: as many pixels as fit in out[out_cap], out_cap >= TSR_MAP_PACKET_LEN_MIN and the same or not
 * the same from call to call. Worst-case cost: 8192 pixels as tsr/codec/map.h says.
 *
 * Returns TSR_AGAIN with a packet of *len bytes when more follow, TSR_OK with the last one. TSR_ERR_ARG for a null
 * pointer or a value that the map's info does not admit, TSR_ERR_NOBUF for a smaller out_cap, TSR_ERR_SIZE after the
 * last packet; then *len is untouched.
 */
enum tsr_status tsr_map_packets_next(struct tsr_map_packet_encoder *encoder, uint8_t *out, size_t out_cap, size_t *len);

/* Mark every pixel as missing; TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width. */
enum tsr_status tsr_map_packets_clear(const struct tsr_map_info *info, uint16_t *map, size_t stride);

/*
 * Decode a packet of the map that info describes into its pixels of the map.
 *
 *   model     used meanwhile
 *   packet    out, filled; count is that of the pixels decoded
 *   map       [height * stride], out: only the packet's pixels
 *
 * Returns TSR_OK; TSR_ERR_FORMAT for fewer bytes than a header or pixels beyond the map, and for bytes that ask for a
 * value out of range (the pixels before are decoded, packet->count of them); TSR_ERR_VERSION for another version or
 * prior; TSR_ERR_NOREF for a packet of another map_id; TSR_ERR_ARG, TSR_ERR_SIZE, TSR_ERR_NOBUF as
 * tsr_map_packets_start.
 */
enum tsr_status tsr_map_packet_decode(struct tsr_map_model *model, const struct tsr_map_info *info, uint8_t map_id,
                                      const uint8_t *bytes, size_t len, uint16_t *scratch, size_t scratch_cap,
                                      struct tsr_map_packet *packet, uint16_t *map, size_t stride);

/* Pixels that are still missing; 0 for a null pointer. */
size_t tsr_map_packets_missing(const struct tsr_map_info *info, const uint16_t *map, size_t stride);

#endif
