/*
 * Gray-image codec, lossless or near-lossless, resumable by rows.
 *
 * Each pixel is predicted from its decoded neighbours, the prediction error is
 * quantised so that no decoded pixel differs from the original by more than
 * near,
 *
 *   |decoded - original| <= near            (near = 0: lossless)
 *
 * and the quantised error is coded bit by bit in contexts of the local
 * activity (tsr/codec/range.h). The idea is LOCO-I's (Weinberger, Seroussi,
 * Sapiro, 2000; JPEG-LS), the coding is not. Every bit: docs/codec.md, chapter 3.
 *
 *   encode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK) ─► _finish
 *   decode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK)
 *
 * The rows may be cut anywhere; the bytes do not depend on it. Encoder, decoder,
 * scratch and byte buffers belong to the caller and are *kept* from _start until
 * the last call; pixel rows are *borrowed* for one call. Worst-case cost of a
 * row: width * (16 adaptive bits and 9 direct ones).
 *
 * Messages are authenticated elsewhere: the decoder does not detect changed
 * bytes, but survives any bytes in bounded time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_GRAY_H
#define TSR_CODEC_GRAY_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"
#include "tsr/codec/range.h"

/* Version of the coded format, not of the library. */
#define TSR_GRAY_FORMAT_VERSION 1
#define TSR_GRAY_HEADER_LEN 6
#define TSR_GRAY_NEAR_MAX 7
/* In place of a near: 0 where the image is flat, 1, 2 and 4 where it is busy, by the class of local activity
 * (docs/codec.md, 3.2). For views to be matched with census descriptors: a third smaller than lossless, .004 of a map's
 * correct pixels lost, where near 1 everywhere loses .012 to .028 (docs/codec.md, 3.6). */
#define TSR_GRAY_NEAR_BY_ACTIVITY 8
#define TSR_GRAY_NEAR_BY_ACTIVITY_MAX 4

struct tsr_gray_info {
    uint16_t width;  /* 1 .. TSR_IMAGE_WIDTH_MAX */
    uint16_t height; /* 1 .. TSR_IMAGE_HEIGHT_MAX */
    uint8_t near;    /* largest error of a decoded pixel, gray levels, 0 .. 7, or TSR_GRAY_NEAR_BY_ACTIVITY */
};

/* Bytes of the scratch rows. */
#define TSR_GRAY_SCRATCH_LEN(width) (3u * (size_t)(width))

/* Bytes above the literal size that an image of any content may take. */
#define TSR_GRAY_EXCESS_LEN 320u

/* The longest coded image of this shape, whatever its content: for static buffers. */
#define TSR_GRAY_ENCODED_LEN_MAX(width, height) ((size_t)(width) * (height) + TSR_GRAY_HEADER_LEN + TSR_GRAY_EXCESS_LEN)

/* Classes of local activity. */
#define TSR_GRAY_ENERGY_COUNT 9

/* Number of adaptive bits of the model. */
#define TSR_GRAY_CONTEXT_COUNT 243

/* What both directions share. Content private to the codec. */
struct tsr_gray_model {
    struct tsr_gray_info info;
    uint8_t *scratch;
    uint16_t row;                         /* next row */
    uint8_t nears[TSR_GRAY_ENERGY_COUNT]; /* of a pixel, by its class */
    uint32_t allowed_bits;                /* spent more: store literally */
    struct tsr_range_bit contexts[TSR_GRAY_CONTEXT_COUNT];
};

struct tsr_gray_encoder {
    struct tsr_gray_model model;
    struct tsr_range_encoder range;
};

struct tsr_gray_decoder {
    struct tsr_gray_model model;
    struct tsr_range_decoder range;
};

/* The same bound at run time; 0 if info is null or out of range. */
size_t tsr_gray_encoded_len_max(const struct tsr_gray_info *info);

/*
 * Begin an image: writes the header.
 *
 *   info       in, copied
 *   out        [out_cap] filled until _finish; tsr_gray_encoded_len_max bytes always suffice
 *   scratch    [scratch_cap] kept; scratch_cap >= TSR_GRAY_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range;
 * TSR_ERR_NOBUF if scratch_cap or out_cap (< TSR_GRAY_HEADER_LEN) is too small.
 * On error nothing is touched.
 */
enum tsr_status tsr_gray_encode_start(struct tsr_gray_encoder *encoder, const struct tsr_gray_info *info, uint8_t *out,
                                      size_t out_cap, uint8_t *scratch, size_t scratch_cap);

/*
 * Code the next row_count rows.
 *
 *   rows     [row_count * stride] borrowed
 *   stride   pixels from row to row, >= width
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row.
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing: nothing was coded. TSR_ERR_NOBUF when the coded image
 * outgrew out_cap: the image is lost, every further call returns the same; no
 * byte outside out was written.
 */
enum tsr_status tsr_gray_encode_rows(struct tsr_gray_encoder *encoder, const uint8_t *rows, size_t stride,
                                     uint16_t row_count);

/*
 * End the image; call once. *len gets the length of the coded image in out.
 *
 * Returns TSR_OK; TSR_AGAIN if rows are missing; TSR_ERR_ARG for a null
 * pointer; TSR_ERR_NOBUF if the coded image did not fit. *len only with TSR_OK.
 */
enum tsr_status tsr_gray_encode_finish(struct tsr_gray_encoder *encoder, size_t *len);

/*
 * Read the header alone, to size the buffers.
 *
 * Returns TSR_OK with *info filled; TSR_ERR_ARG for a null pointer;
 * TSR_ERR_FORMAT for fewer than TSR_GRAY_HEADER_LEN bytes or a field out of
 * range; TSR_ERR_VERSION for a version, mode or prior this build does not
 * know. On error *info is untouched.
 */
enum tsr_status tsr_gray_read_info(const uint8_t *bytes, size_t len, struct tsr_gray_info *info);

/*
 * Begin decoding bytes[len], kept until the last row.
 *
 *   info     out, filled
 *
 * Returns TSR_OK; TSR_ERR_NOBUF if scratch_cap <
 * TSR_GRAY_SCRATCH_LEN(info.width); else as tsr_gray_read_info. On error
 * decoder, scratch and info are untouched.
 */
enum tsr_status tsr_gray_decode_start(struct tsr_gray_decoder *decoder, const uint8_t *bytes, size_t len,
                                      uint8_t *scratch, size_t scratch_cap, struct tsr_gray_info *info);

/*
 * Decode the next row_count rows.
 *
 *   rows     [row_count * stride] out, width pixels of each row filled
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row;
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing; on error rows and decoder are untouched.
 */
enum tsr_status tsr_gray_decode_rows(struct tsr_gray_decoder *decoder, uint8_t *rows, size_t stride,
                                     uint16_t row_count);

#endif
