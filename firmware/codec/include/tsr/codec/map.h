/*
 * Disparity-map codec, lossless or near-lossless, resumable by rows.
 *
 * A map of UQ12.4 disparities that are multiples of the step 2^step_log2 / 16
 * px becomes labels (disparity / step, or "no match"), and each label is coded
 * by asking, in order, "as in the reference? the left, the upper, ... neighbour?", then by a
 * small signed difference, then literally; every question is one adaptive bit
 * of the range coder (tsr/codec/range.h), whose context a table trained on maps
 * of our own matcher chooses. A map that does not compress is stored literally
 * from there on. Every bit: docs/codec.md, chapter 2.
 *
 *   encode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK) ─► _finish
 *   decode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK)
 *
 * With near = 1 a decoded disparity may be one step off, and a pixel has a match exactly
 * where it had one. With a reference (the map that the receiver is known to hold) what
 * stayed as it was costs next to nothing.
 *
 * The rows may be cut anywhere; the bytes do not depend on it. Encoder, decoder,
 * scratch rows, byte buffers and the reference map belong to the caller and are *kept* from _start
 * until the last call; pixel rows are *borrowed* for one call. Call from task
 * context; different maps may be coded at the same time with different states.
 * Worst-case cost of a row: width * (23 adaptive bits and 9 direct ones).
 *
 * Messages are authenticated elsewhere: the decoder does not detect every
 * changed byte, but survives any bytes, in bounded time, and yields only valid
 * values: multiples of the step below 16 * disparities, or invalid.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_H
#define TSR_CODEC_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"
#include "tsr/codec/range.h"

/* Version of the coded format, not of the library. */
#define TSR_MAP_FORMAT_VERSION 3
#define TSR_MAP_HEADER_LEN 9
/* With a reference its id follows the header. */
#define TSR_MAP_HEADER_LEN_MAX 11
#define TSR_MAP_STEP_LOG2_MAX 4
#define TSR_MAP_NEAR_MAX 1

struct tsr_map_info {
    uint16_t width;        /* 1 .. TSR_IMAGE_WIDTH_MAX */
    uint16_t height;       /* 1 .. TSR_IMAGE_HEIGHT_MAX */
    uint16_t disparities;  /* 1 .. TSR_DISPARITY_COUNT_MAX; every disparity is < this many px */
    uint8_t step_log2;     /* step = 2^step_log2 sixteenths of a px, 0 .. 4; the product sends 3 (1/2 px) */
    uint8_t near;          /* largest error of a decoded disparity, steps, 0 .. TSR_MAP_NEAR_MAX */
    int16_t d0_q4;         /* the pair's offset, px, Q12.4, signed; carried, not used */
    bool has_reference;    /* coded against the map of reference_id; an encoder does not read these two */
    uint16_t reference_id; /* what sender and receiver call that map */
};

/* A map that both sides hold: UQ12.4 px, of the shape of the coded one, kept. */
struct tsr_map_reference {
    const uint16_t *map; /* [height * stride] */
    size_t stride;       /* elements from row to row, >= width */
    uint16_t id;
};

/* Elements of the uint16_t scratch rows. */
#define TSR_MAP_SCRATCH_COUNT(width) (3u * ((size_t)(width) + 5u))

/* Bits of a label stored literally: those of disparities * 16 / step, which stands for "no match". */
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
#define TSR_MAP_EXCESS_LEN 784u

/* The longest coded map of this shape, whatever its content: for static buffers. */
#define TSR_MAP_ENCODED_LEN_MAX(width, height, disparities, step_log2)                                                 \
    (((size_t)(width) * (height)*TSR_MAP_LABEL_BITS(disparities, step_log2) + 7u) / 8u + TSR_MAP_HEADER_LEN_MAX +      \
     TSR_MAP_EXCESS_LEN)

/* Number of adaptive bits of the model. */
#define TSR_MAP_CELL_COUNT 658

/* What both directions share. Content private to the codec. */
struct tsr_map_model {
    struct tsr_map_info info;
    struct tsr_map_reference reference; /* .map NULL: none */
    uint16_t *scratch;
    uint16_t row;          /* next row */
    uint16_t invalid;      /* the label of "no match" */
    uint16_t last_label;   /* last label coded that was a match */
    uint16_t label_count;  /* of matches: 0 .. label_count - 1 */
    uint32_t allowed_bits; /* spent more: store literally */
    uint8_t label_bits;
    uint8_t coding;                     /* enum tsr_map_coding */
    uint8_t run;                        /* where the row was left; docs/codec.md, 2.3 */
    uint16_t cells[TSR_MAP_CELL_COUNT]; /* P(1), UQ0.16 */
};

struct tsr_map_encoder {
    struct tsr_map_model model;
    struct tsr_range_encoder range;
    enum tsr_status status; /* TSR_ERR_ARG is sticky */
    void (*code_row)(struct tsr_map_model *model, struct tsr_range_encoder *range);
    uint8_t header_len;
};

struct tsr_map_decoder {
    struct tsr_map_model model;
    struct tsr_range_decoder range;
    enum tsr_status status; /* TSR_ERR_FORMAT is sticky */
};

/* The same bound at run time; 0 if info is null or out of range. */
size_t tsr_map_encoded_len_max(const struct tsr_map_info *info);

/*
 * Begin a map that is coded alone, or against a reference: writes the header.
 *
 *   info         in, copied, but for has_reference and reference_id
 *   reference    the map to code against; it must be one that a decoder will have bit by bit (with near > 0: the
 *                decoded one). Disparities that this map cannot have count as no match
 *   out          [out_cap] filled until _finish; tsr_map_encoded_len_max bytes always suffice, a typical map
 *                at 1/2 px takes a fifteenth of that
 *   scratch      [scratch_cap] kept; scratch_cap >= TSR_MAP_SCRATCH_COUNT(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range; TSR_ERR_SIZE for a reference's
 * stride < width; TSR_ERR_NOBUF if scratch_cap or out_cap (< the header) is too small. On error nothing is
 * touched. Who never calls the second links no table for it.
 */
enum tsr_status tsr_map_encode_start(struct tsr_map_encoder *encoder, const struct tsr_map_info *info, uint8_t *out,
                                     size_t out_cap, uint16_t *scratch, size_t scratch_cap);
enum tsr_status tsr_map_encode_start_against(struct tsr_map_encoder *encoder, const struct tsr_map_info *info,
                                             const struct tsr_map_reference *reference, uint8_t *out, size_t out_cap,
                                             uint16_t *scratch, size_t scratch_cap);

/*
 * Code the next row_count rows.
 *
 *   rows     [row_count * stride] borrowed, UQ12.4 px, TSR_DISPARITY_INVALID = no match
 *   stride   elements from row to row, >= width
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row.
 * TSR_ERR_SIZE for a stride < width or more rows than are missing, TSR_ERR_ARG for a null pointer: nothing was coded.
 * TSR_ERR_ARG for a value that is neither invalid nor a multiple of the step below 16 * disparities, TSR_ERR_NOBUF when
 * the coded map outgrew out_cap: the map is lost, every further call returns the same; no byte outside out was written.
 */
enum tsr_status tsr_map_encode_rows(struct tsr_map_encoder *encoder, const uint16_t *rows, size_t stride,
                                    uint16_t row_count);

/*
 * End the map; call once. *len gets the length of the coded map in out.
 *
 * Returns TSR_OK; TSR_AGAIN if rows are missing; TSR_ERR_ARG for a null
 * pointer or after a bad value; TSR_ERR_NOBUF if the coded map did not fit. *len only with TSR_OK.
 */
enum tsr_status tsr_map_encode_finish(struct tsr_map_encoder *encoder, size_t *len);

/*
 * Read the header alone, to size the buffers.
 *
 * Returns TSR_OK with *info filled; TSR_ERR_ARG for a null pointer;
 * TSR_ERR_FORMAT for fewer bytes than the header or a field out of
 * range; TSR_ERR_VERSION for a version, mode or prior this build does not
 * know. On error *info is untouched.
 */
enum tsr_status tsr_map_read_info(const uint8_t *bytes, size_t len, struct tsr_map_info *info);

/*
 * Begin decoding bytes[len], kept until the last row.
 *
 *   reference   the map that info.reference_id names, or NULL; not used if the map was coded alone
 *   info        out, filled
 *
 * Returns TSR_OK; TSR_ERR_NOREF if the map needs a reference and this is none or another;
 * TSR_ERR_SIZE if its stride is < width; TSR_ERR_NOBUF if scratch_cap <
 * TSR_MAP_SCRATCH_COUNT(info.width); else as tsr_map_read_info. On error
 * decoder, scratch and info are untouched.
 */
enum tsr_status tsr_map_decode_start(struct tsr_map_decoder *decoder, const uint8_t *bytes, size_t len,
                                     const struct tsr_map_reference *reference, uint16_t *scratch, size_t scratch_cap,
                                     struct tsr_map_info *info);

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
