/*
 * Lossless disparity-map codec, resumable by rows.
 *
 * A map of UQ12.4 disparities that are multiples of the step 2^step_log2 / 16
 * px becomes labels (0 = invalid, else 1 + disparity / step), and each label is
 * coded by asking, in order, "is it the left, the upper, ... neighbour?", then
 * by a small signed difference, then literally; every question is one adaptive
 * bit of the range coder (tsr/codec/range.h). A map that does not compress is
 * stored literally from there on. Every bit: docs/codec.md, chapter 2.
 *
 *   encode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK) ─► _finish
 *   decode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK)
 *
 * The rows may be cut anywhere; the bytes do not depend on it. Encoder, decoder,
 * scratch rows and byte buffers belong to the caller and are *kept* from _start
 * until the last call; pixel rows are *borrowed* for one call. Call from task
 * context; different maps may be coded at the same time with different states.
 * Worst-case cost of a row: width * (22 adaptive bits and 9 direct ones).
 *
 * Messages are authenticated elsewhere: the decoder does not detect every
 * changed byte, but survives any bytes, in bounded time, and yields only valid
 * values: multiples of the step below 16 * disparities, or invalid.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_H
#define TSR_CODEC_MAP_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"
#include "tsr/codec/range.h"

/* Version of the coded format, not of the library. */
#define TSR_MAP_FORMAT_VERSION 1
#define TSR_MAP_HEADER_LEN 9
#define TSR_MAP_STEP_LOG2_MAX 4

struct tsr_map_info {
    uint16_t width;       /* 1 .. TSR_IMAGE_WIDTH_MAX */
    uint16_t height;      /* 1 .. TSR_IMAGE_HEIGHT_MAX */
    uint16_t disparities; /* 1 .. TSR_DISPARITY_COUNT_MAX; every disparity is < this many px */
    uint8_t step_log2;    /* step = 2^step_log2 sixteenths of a px, 0 .. 4; the product sends 2 (1/4 px) */
    int16_t d0_q4;        /* the pair's offset, px, Q12.4, signed; carried, not used */
};

/* Elements of the uint16_t scratch rows. */
#define TSR_MAP_SCRATCH_COUNT(width) (3u * ((size_t)(width) + 4u))

/* Bits of a label stored literally: ceil(log2(labels)), labels = 1 + disparities * 16 / step. */
#define TSR_MAP_LABEL_BITS(disparities, step_log2) TSR_MAP_BITS_(((disparities)*16u) >> (step_log2))
#define TSR_MAP_BITS_(last)                                                                                            \
    ((last) >= 2048u   ? 12u                                                                                           \
     : (last) >= 1024u ? 11u                                                                                           \
     : (last) >= 512u  ? 10u                                                                                           \
     : (last) >= 256u  ? 9u                                                                                            \
     : (last) >= 128u  ? 8u                                                                                            \
     : (last) >= 64u   ? 7u                                                                                            \
     : (last) >= 32u   ? 6u                                                                                            \
     : (last) >= 16u   ? 5u                                                                                            \
     : (last) >= 8u    ? 4u                                                                                            \
     : (last) >= 4u    ? 3u                                                                                            \
     : (last) >= 2u    ? 2u                                                                                            \
                       : 1u)

/* Bytes above the literal size that a map of any content may take. */
#define TSR_MAP_EXCESS_LEN 320u

/* The longest coded map of this shape, whatever its content: for static buffers. */
#define TSR_MAP_ENCODED_LEN_MAX(width, height, disparities, step_log2)                                                 \
    (((size_t)(width) * (height)*TSR_MAP_LABEL_BITS(disparities, step_log2) + 7u) / 8u + TSR_MAP_HEADER_LEN +          \
     TSR_MAP_EXCESS_LEN)

/* Number of adaptive bits of the model. */
#define TSR_MAP_CONTEXT_COUNT 1094

/* What both directions share. Content private to the codec. */
struct tsr_map_model {
    struct tsr_map_info info;
    uint16_t *scratch;
    uint16_t row;         /* next row */
    uint16_t last_label;  /* last valid label coded */
    uint16_t label_count; /* labels 0 .. label_count - 1 */
    uint8_t label_bits;
    uint32_t allowed_bits; /* spent more: store literally */
    struct tsr_range_bit contexts[TSR_MAP_CONTEXT_COUNT];
};

struct tsr_map_encoder {
    struct tsr_map_model model;
    struct tsr_range_encoder range;
};

struct tsr_map_decoder {
    struct tsr_map_model model;
    struct tsr_range_decoder range;
    enum tsr_status status; /* TSR_ERR_FORMAT is sticky */
};

/* The same bound at run time; 0 if info is null or out of range. */
size_t tsr_map_encoded_len_max(const struct tsr_map_info *info);

/*
 * Begin a map: writes the header.
 *
 *   info         in, copied
 *   out          [out_cap] filled until _finish; tsr_map_encoded_len_max bytes always suffice, a typical map
 *                at 1/4 px takes a tenth of that
 *   scratch      [scratch_cap] kept; scratch_cap >= TSR_MAP_SCRATCH_COUNT(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range;
 * TSR_ERR_NOBUF if scratch_cap or out_cap (< TSR_MAP_HEADER_LEN) is too small.
 * On error nothing is touched.
 */
enum tsr_status tsr_map_encode_start(struct tsr_map_encoder *encoder, const struct tsr_map_info *info, uint8_t *out,
                                     size_t out_cap, uint16_t *scratch, size_t scratch_cap);

/*
 * Code the next row_count rows.
 *
 *   rows     [row_count * stride] borrowed, UQ12.4 px, TSR_DISPARITY_INVALID = no match
 *   stride   elements from row to row, >= width
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row.
 * TSR_ERR_ARG for a null pointer or a value that is not a multiple of the step
 * below 16 * disparities, TSR_ERR_SIZE for a stride < width or more rows than
 * are missing: nothing was coded, the call may be repeated with better rows.
 * TSR_ERR_NOBUF when the coded map outgrew out_cap: the map is lost, every
 * further call returns the same; no byte outside out was written.
 */
enum tsr_status tsr_map_encode_rows(struct tsr_map_encoder *encoder, const uint16_t *rows, size_t stride,
                                    uint16_t row_count);

/*
 * End the map; call once. *len gets the length of the coded map in out.
 *
 * Returns TSR_OK; TSR_AGAIN if rows are missing; TSR_ERR_ARG for a null
 * pointer; TSR_ERR_NOBUF if the coded map did not fit. *len only with TSR_OK.
 */
enum tsr_status tsr_map_encode_finish(struct tsr_map_encoder *encoder, size_t *len);

/*
 * Read the header alone, to size the buffers.
 *
 * Returns TSR_OK with *info filled; TSR_ERR_ARG for a null pointer;
 * TSR_ERR_FORMAT for fewer than TSR_MAP_HEADER_LEN bytes or a field out of
 * range; TSR_ERR_VERSION for a version, mode or prior this build does not
 * know. On error *info is untouched.
 */
enum tsr_status tsr_map_read_info(const uint8_t *bytes, size_t len, struct tsr_map_info *info);

/*
 * Begin decoding bytes[len], kept until the last row.
 *
 *   info     out, filled
 *
 * Returns TSR_OK; TSR_ERR_NOBUF if scratch_cap <
 * TSR_MAP_SCRATCH_COUNT(info.width); else as tsr_map_read_info. On error
 * decoder, scratch and info are untouched.
 */
enum tsr_status tsr_map_decode_start(struct tsr_map_decoder *decoder, const uint8_t *bytes, size_t len,
                                     uint16_t *scratch, size_t scratch_cap, struct tsr_map_info *info);

/*
 * Decode the next row_count rows.
 *
 *   rows     [row_count * stride] out, UQ12.4 px, width elements of each row filled
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row;
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing (rows and decoder untouched). TSR_ERR_FORMAT if the bytes ask for a
 * value out of range: the rest of these rows is filled with
 * TSR_DISPARITY_INVALID and every further call returns the same, rows untouched.
 */
enum tsr_status tsr_map_decode_rows(struct tsr_map_decoder *decoder, uint16_t *rows, size_t stride, uint16_t row_count);

#endif
