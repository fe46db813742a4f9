/*
 * Gray images against the one before, which both sides hold: tiles of 8x8 pixels
 * that have not changed are taken from it, the rest is coded as tsr/codec/gray.h does.
 *
 * For views of a static camera whose matcher needs gray values (modes smooth and
 * census), as tsr/codec/view.h is for the others. An image on its own is coded to
 * the same bytes as by gray.h. Every bit: docs/codec.md, 3.7.
 *
 *   encode   [_compare ... ─► tsr_view_choose] ─► _encode_start ─► _encode_rows ... ─► _encode_finish
 *   decode                                        _decode_start ─► _decode_rows ...
 *
 * The rows may be cut anywhere; the bytes do not depend on it. Coders, scratch, held
 * image, tiles and byte buffers belong to the caller and are *kept* from _start until
 * the last call; pixel rows are *borrowed* for one call. Worst-case cost: that of
 * gray.h and an adaptive bit a tile.
 *
 * Messages are authenticated elsewhere: the decoder does not detect changed
 * bytes, but survives any bytes in bounded time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_GRAY_HISTORY_H
#define TSR_CODEC_GRAY_HISTORY_H

#include "tsr/codec/gray.h"
#include "tsr/codec/view.h"

#define TSR_GRAY_HISTORY_HEADER_LEN_MAX 8 /* 6 of an image on its own */

struct tsr_gray_history_info {
    uint16_t width;    /* as of gray.h */
    uint16_t height;   /* as of gray.h */
    uint8_t near;      /* as of gray.h, of the coded tiles */
    bool against_held; /* unchanged tiles are those of the held image */
};

/*
 * The image that both sides hold: the one decoded last. Zeroed, with pixels and
 * pixels_cap set, it is empty. A coder replaces it by its own image row by row, and
 * it is empty from _start until the last row.
 */
struct tsr_gray_held {
    uint8_t *pixels;   /* [pixels_cap] kept, rows of width pixels */
    size_t pixels_cap; /* bytes, >= width * height of every image */
    uint16_t width, height;
    uint16_t check; /* CRC-16 of its pixels (tsr_crc16 from TSR_CRC16_START_HDLC) */
    bool full;      /* there is one; its owner may clear it, to forget */
};

#define TSR_GRAY_HISTORY_SCRATCH_LEN(width) (TSR_GRAY_SCRATCH_LEN(width) + TSR_VIEW_TILES_ACROSS(width) + 2u)

/* The longest coded image of this shape, whatever its content: for static buffers. */
#define TSR_GRAY_HISTORY_ENCODED_LEN_MAX(width, height)                                                                \
    ((size_t)(width) * (height) + (3u * TSR_VIEW_TILE_COUNT(width, height) + 1u) / 2u +                                \
     TSR_GRAY_HISTORY_HEADER_LEN_MAX + TSR_GRAY_EXCESS_LEN)

/* What both directions share. Content private to the codec. */
struct tsr_gray_history_model {
    struct tsr_gray_model gray;
    struct tsr_gray_held *held;
    bool against_held;
    uint16_t check; /* of the rows so far */
    struct tsr_range_bit tile_contexts[8];
};

struct tsr_gray_history_encoder {
    struct tsr_gray_history_model model;
    struct tsr_range_encoder range;
    const uint8_t *tiles;
};

struct tsr_gray_history_decoder {
    struct tsr_gray_history_model model;
    struct tsr_range_decoder range;
};

/* The same bound at run time; 0 if info is null or out of range. */
size_t tsr_gray_history_encoded_len_max(const struct tsr_gray_history_info *info);

/*
 * Compare rows of a fresh image with the held one, from the top, for tsr_view_choose:
 *
 *   excess   = sum over the tile of max(0, |P - P_held| - 1), as of 64 pixels, at most 255
 *
 * and a tile is stronger (weaker) unless the mean of its pixels has fallen (grown) by half a level or more: most are
 * both. So tsr_view_choose codes all tiles if those that grew are more than those that stayed and twice those that
 * fell, or the other way round: another light.
 *
 * Arguments, statuses and what is left on error: as tsr_view_compare.
 */
enum tsr_status tsr_gray_history_compare(const struct tsr_gray_held *held, const uint8_t *rows, size_t stride,
                                         uint16_t first_row, uint16_t row_count, struct tsr_view_change *change);

/*
 * Begin an image: writes the header.
 *
 *   info         in, copied
 *   held         in and out, kept
 *   tiles        [TSR_VIEW_TILE_COUNT] kept, 1 = coded, 0 = held, row by row; null unless against_held
 *   out          [out_cap] filled until _finish; tsr_gray_history_encoded_len_max bytes always suffice
 *   scratch      [scratch_cap] kept; scratch_cap >= TSR_GRAY_HISTORY_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range; TSR_ERR_NOREF if the image is
 * against_held and held is empty or of another size; TSR_ERR_NOBUF if scratch_cap, held->pixels_cap or out_cap
 * (< TSR_GRAY_HISTORY_HEADER_LEN_MAX) is too small. On error nothing is touched.
 */
enum tsr_status tsr_gray_history_encode_start(struct tsr_gray_history_encoder *encoder,
                                              const struct tsr_gray_history_info *info, struct tsr_gray_held *held,
                                              const uint8_t *tiles, uint8_t *out, size_t out_cap, uint8_t *scratch,
                                              size_t scratch_cap);

/* As tsr_gray_encode_rows; a lost image leaves held empty. */
enum tsr_status tsr_gray_history_encode_rows(struct tsr_gray_history_encoder *encoder, const uint8_t *rows,
                                             size_t stride, uint16_t row_count);

/* As tsr_gray_encode_finish. */
enum tsr_status tsr_gray_history_encode_finish(struct tsr_gray_history_encoder *encoder, size_t *len);

/* Read the header alone, to size the buffers: as tsr_gray_read_info, of images against a held one too. */
enum tsr_status tsr_gray_history_read_info(const uint8_t *bytes, size_t len, struct tsr_gray_history_info *info);

/*
 * Begin decoding bytes[len], kept until the last row.
 *
 *   held     in and out, kept
 *   info     out, filled
 *
 * Returns TSR_OK; TSR_ERR_NOREF if the image is against a held one and held is empty or another; TSR_ERR_NOBUF if
 * held->pixels_cap or scratch_cap is too small for info; else as tsr_gray_history_read_info. On error nothing is
 * touched.
 */
enum tsr_status tsr_gray_history_decode_start(struct tsr_gray_history_decoder *decoder, const uint8_t *bytes,
                                              size_t len, struct tsr_gray_held *held, uint8_t *scratch,
                                              size_t scratch_cap, struct tsr_gray_history_info *info);

/* As tsr_gray_decode_rows; with the last row held is this image. */
enum tsr_status tsr_gray_history_decode_rows(struct tsr_gray_history_decoder *decoder, uint8_t *rows, size_t stride,
                                             uint16_t row_count);

#endif
