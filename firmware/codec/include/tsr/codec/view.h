/*
 * Prefiltered-view codec: what a board with the right camera sends to the one that
 * matches (tsr/vision/prefilter.h), resumable by rows.
 *
 * A pixel P is 0 .. 2 cap, its value v = P - cap a clipped horizontal derivative.
 * Exactly, or coarsely (cap 7 only):
 *
 *   |v|       0  1  2  3  4  5  6  7
 *   decoded   0  1  2  2  4  4  7  7
 *
 * Steps grow with the value: where the picture is flat, noise decides a match and
 * every level counts; at an edge none does. Coarse views cost a fifth fewer bytes
 * and .001 of the correct pixels of a map (docs/codec.md, 4.7).
 *
 * Each value is expected from its decoded neighbours and coded bit by bit in
 * contexts of that expectation and the local activity (tsr/codec/range.h). A view
 * may be coded against the one before it, which both boards hold: tiles of 8x8
 * pixels that have not changed are taken from it. Every bit: docs/codec.md, chapter 4.
 *
 *   encode   [_compare ... ─► _choose] ─► _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK) ─► _finish
 *   decode                                _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK)
 *
 * The rows may be cut anywhere; the bytes do not depend on it. Coders, scratch,
 * held view, tiles and byte buffers belong to the caller and are *kept* from _start
 * until the last call; pixel rows are *borrowed* for one call. Worst-case cost of a
 * row: width * 15 adaptive bits.
 *
 * Messages are authenticated elsewhere: the decoder does not detect changed
 * bytes, but survives any bytes in bounded time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_VIEW_H
#define TSR_CODEC_VIEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"
#include "tsr/codec/range.h"

/* Version of the coded format, not of the library. */
#define TSR_VIEW_FORMAT_VERSION 1
#define TSR_VIEW_HEADER_LEN_MAX 8 /* 6 of a view on its own */
#define TSR_VIEW_CAP_MAX 7
#define TSR_VIEW_TILE_PX 8

struct tsr_view_info {
    uint16_t width;    /* 1 .. TSR_IMAGE_WIDTH_MAX */
    uint16_t height;   /* 1 .. TSR_IMAGE_HEIGHT_MAX */
    uint8_t cap;       /* of the prefilter, 1 .. 7 */
    bool coarse;       /* values as above; cap 7 only */
    bool against_held; /* unchanged tiles are those of the held view */
};

/*
 * The view that both boards hold: the one decoded last. Two pixels a byte, the left
 * one in bits 3..0; a row begins a byte. Zeroed, with packed and packed_cap set, it is
 * empty. A coder that is given it replaces it by its own view row by row, and it is
 * empty from _start until the last row.
 */
struct tsr_view_held {
    uint8_t *packed;           /* [packed_cap] kept */
    size_t packed_cap;         /* bytes, >= TSR_VIEW_HELD_LEN of every view */
    struct tsr_view_info info; /* of the view */
    uint16_t check;            /* CRC-16 of its bytes (tsr_crc16 from TSR_CRC16_START_HDLC) */
    bool full;                 /* there is one; its owner may clear it, to forget */
};

#define TSR_VIEW_HELD_LEN(width, height) (((size_t)(width) + 1u) / 2u * (size_t)(height))

#define TSR_VIEW_TILES_ACROSS(px) (((size_t)(px) + TSR_VIEW_TILE_PX - 1u) / TSR_VIEW_TILE_PX)
#define TSR_VIEW_TILE_COUNT(width, height) (TSR_VIEW_TILES_ACROSS(width) * TSR_VIEW_TILES_ACROSS(height))

/* Bytes of the scratch rows: three of values and one of errors with their borders, one of tiles. */
#define TSR_VIEW_SCRATCH_LEN(width) (4u * ((size_t)(width) + 3u) + TSR_VIEW_TILES_ACROSS(width) + 2u)

/* Bytes above 4 bits a pixel and 12 bits a tile that a view of any content may take. */
#define TSR_VIEW_EXCESS_LEN 320u

/* The longest coded view of this shape, whatever its content: for static buffers. */
#define TSR_VIEW_ENCODED_LEN_MAX(width, height)                                                                        \
    (((size_t)(width) * (height) + 3u * TSR_VIEW_TILE_COUNT(width, height) + 1u) / 2u + TSR_VIEW_HEADER_LEN_MAX +      \
     TSR_VIEW_EXCESS_LEN)

/* Number of adaptive bits of the model. */
#define TSR_VIEW_CONTEXT_COUNT 392

/* What both directions share. Content private to the codec. */
struct tsr_view_model {
    struct tsr_view_info info;
    struct tsr_view_held *held; /* null: none */
    uint8_t *scratch;
    const uint8_t *level_of; /* [8] by |v| */
    const uint8_t *value_of; /* [8] by level */
    uint16_t row;            /* next row */
    uint16_t check;          /* of the rows so far */
    uint8_t level_max;
    uint32_t allowed_bits; /* spent more: store literally */
    struct tsr_range_bit contexts[TSR_VIEW_CONTEXT_COUNT];
};

struct tsr_view_encoder {
    struct tsr_view_model model;
    struct tsr_range_encoder range;
    const uint8_t *tiles;
};

struct tsr_view_decoder {
    struct tsr_view_model model;
    struct tsr_range_decoder range;
};

/* The same bound at run time; 0 if info is null or out of range. */
size_t tsr_view_encoded_len_max(const struct tsr_view_info *info);

/* How a fresh view differs from the held one, tile by tile. */
struct tsr_view_change {
    uint8_t *tiles;    /* [tiles_cap] kept, row by row */
    size_t tiles_cap;  /* >= TSR_VIEW_TILE_COUNT of the view */
    uint16_t stronger; /* tiles with more contrast than held */
    uint16_t weaker;   /* and with less */
};

/*
 * Compare rows of a fresh view with the held one, from the top:
 *
 *   excess   = sum over the tile of max(0, |P - P_held| - 1), as of 64 pixels, at most 255
 *   contrast = sum over the tile of |v|, of the fresh view as it would be decoded
 *
 *   held        in, full
 *   rows        [row_count * stride] borrowed, prefiltered pixels of rows first_row and on
 *   first_row   a multiple of TSR_VIEW_TILE_PX; with 0 the counts begin anew
 *   row_count   a multiple of it too, or what is left of the view
 *   change      in and out: the excess of these rows' tiles filled in, the counts continued
 *
 * About 37 instructions a pixel (Cortex-M4).
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or a held view that is empty;
 * TSR_ERR_SIZE for rows outside the view or that cut a tile, or a stride < width;
 * TSR_ERR_NOBUF if tiles_cap is too small. On error change is untouched.
 */
enum tsr_status tsr_view_compare(const struct tsr_view_held *held, const uint8_t *rows, size_t stride,
                                 uint16_t first_row, uint16_t row_count, struct tsr_view_change *change);

/*
 * From excess to what is coded: change->tiles[i] becomes 1 if it is above the
 * threshold, else 0, the tile that is kept. threshold 0 chooses it from the count
 * tiles themselves: three times their median, 20 at least and 120 at most, so that
 * the noise of the camera need not be known.
 *
 * All become 1 if more than two thirds of at least 32 tiles whose contrast
 * differs lean to one side: noise and objects do not do that, another light does,
 * and what is kept would be matched against the left view's new one.
 *
 * Returns the number of tiles that are coded; 0 for null arguments.
 */
size_t tsr_view_choose(struct tsr_view_change *change, size_t count, uint8_t threshold);

/*
 * Begin a view: writes the header.
 *
 *   info         in, copied
 *   held         in and out, kept; null if nothing is to be held (then not against_held)
 *   tiles        [TSR_VIEW_TILE_COUNT] kept, 1 = coded, 0 = held, row by row; null unless against_held
 *   out          [out_cap] filled until _finish; tsr_view_encoded_len_max bytes always suffice
 *   scratch      [scratch_cap] kept; scratch_cap >= TSR_VIEW_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range;
 * TSR_ERR_NOREF if the view is against_held and held is empty or not of the same
 * shape, cap and coarseness; TSR_ERR_NOBUF if scratch_cap, held->packed_cap or out_cap (<
 * TSR_VIEW_HEADER_LEN_MAX) is too small. On error nothing is touched.
 */
enum tsr_status tsr_view_encode_start(struct tsr_view_encoder *encoder, const struct tsr_view_info *info,
                                      struct tsr_view_held *held, const uint8_t *tiles, uint8_t *out, size_t out_cap,
                                      uint8_t *scratch, size_t scratch_cap);

/*
 * Code the next row_count rows.
 *
 *   rows     [row_count * stride] borrowed, prefiltered pixels; above 2 cap counts as 2 cap
 *   stride   pixels from row to row, >= width
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row.
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing: nothing was coded. TSR_ERR_NOBUF when the coded view
 * outgrew out_cap: the view is lost, every further call returns the same, held
 * stays empty; no byte outside out was written.
 */
enum tsr_status tsr_view_encode_rows(struct tsr_view_encoder *encoder, const uint8_t *rows, size_t stride,
                                     uint16_t row_count);

/*
 * End the view; call once. *len gets the length of the coded view in out.
 *
 * Returns TSR_OK; TSR_AGAIN if rows are missing; TSR_ERR_ARG for a null
 * pointer; TSR_ERR_NOBUF if the coded view did not fit. *len only with TSR_OK.
 */
enum tsr_status tsr_view_encode_finish(struct tsr_view_encoder *encoder, size_t *len);

/*
 * Read the header alone, to size the buffers.
 *
 * Returns TSR_OK with *info filled; TSR_ERR_ARG for a null pointer;
 * TSR_ERR_FORMAT for fewer bytes than the header has or a field out of
 * range; TSR_ERR_VERSION for a version, mode or prior this build does not
 * know. On error *info is untouched.
 */
enum tsr_status tsr_view_read_info(const uint8_t *bytes, size_t len, struct tsr_view_info *info);

/*
 * Begin decoding bytes[len], kept until the last row.
 *
 *   held     in and out, kept; null if nothing is held
 *   info     out, filled
 *
 * Returns TSR_OK; TSR_ERR_NOREF if the view is against a held one and held is
 * null, empty or another; TSR_ERR_NOBUF if held->packed_cap or scratch_cap is too
 * small for info; else as tsr_view_read_info. On error nothing is touched.
 */
enum tsr_status tsr_view_decode_start(struct tsr_view_decoder *decoder, const uint8_t *bytes, size_t len,
                                      struct tsr_view_held *held, uint8_t *scratch, size_t scratch_cap,
                                      struct tsr_view_info *info);

/*
 * Decode the next row_count rows.
 *
 *   rows     [row_count * stride] out, prefiltered pixels 0 .. 2 cap, width of each row filled
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row;
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing; on error rows and decoder are untouched.
 */
enum tsr_status tsr_view_decode_rows(struct tsr_view_decoder *decoder, uint8_t *rows, size_t stride,
                                     uint16_t row_count);

#endif
