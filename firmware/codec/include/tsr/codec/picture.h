/*
 * Lossy picture codec: the gray picture that colours a map, resumable by rows.
 *
 * Blocks of 8 x 8 pixels are transformed (the 8 x 8 integer transform of ITU-T
 * H.264, 8.5.13), predicted from the decoded pixels above and on their left,
 * quantised with a step that grows with the block's own activity, and coded bit
 * by bit (tsr/codec/range.h) in contexts that start from a trained prior. The
 * decoder smooths what the quantiser broke. Every bit: docs/codec.md, chapter 5.
 *
 *   encode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK) ─► _finish
 *   decode   _start ─► _rows (TSR_AGAIN) ... _rows (TSR_OK)
 *
 * Quantiser: step k is 2^(k/8) gray levels of an orthonormal transform, 0 .. 63;
 * a block of high activity takes up to 4 half octaves more. Each step of k is
 * worth 7 to 9 per cent of the bytes; an SSIM of 0.9 takes 30 to 42, mostly 36.
 * Smoothing limits how close the finest steps come: use gray.h for that.
 *
 * Rate: with target_len, the step changes by at most 6 a band of 8 rows so that
 * the bytes left last for the bands left; docs/codec.md, 5.9, says how close
 * that comes. It steers and does not bound: out_cap bounds.
 *
 * The rows may be cut anywhere; the bytes do not depend on it. Encoder, decoder,
 * scratch and byte buffers belong to the caller and are *kept* from _start until
 * the last call; pixel rows are *borrowed* for one call. Call from task context;
 * different pictures may be coded at the same time with different states.
 * Worst-case cost: at each eighth row, 16 adaptive bits and 10 direct ones a
 * pixel of the band, and 20 a block.
 *
 * Messages are authenticated elsewhere: the decoder does not detect changed
 * bytes, but survives any bytes in bounded time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PICTURE_H
#define TSR_CODEC_PICTURE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"
#include "tsr/codec/range.h"

/* Version of the coded format, not of the library. */
#define TSR_PICTURE_FORMAT_VERSION 1
#define TSR_PICTURE_HEADER_LEN 6
#define TSR_PICTURE_STEP_MAX 63
/* What contexts start from: nothing learned, or the table of picture_prior.c. */
#define TSR_PICTURE_PRIOR_NONE 0
#define TSR_PICTURE_PRIOR_TRAINED 1
#define TSR_PICTURE_BLOCK 8u

struct tsr_picture_info {
    uint16_t width;  /* 1 .. TSR_IMAGE_WIDTH_MAX */
    uint16_t height; /* 1 .. TSR_IMAGE_HEIGHT_MAX */
    uint8_t step;    /* quantiser of the first band, 0 .. TSR_PICTURE_STEP_MAX */
    uint8_t prior;   /* TSR_PICTURE_PRIOR_NONE or _TRAINED; the product sends _TRAINED */
};

/* Blocks in a row of them. */
#define TSR_PICTURE_BLOCKS(pixels) (((size_t)(pixels) + TSR_PICTURE_BLOCK - 1u) / TSR_PICTURE_BLOCK)

/* Bytes of scratch: two rows and a band of pixels, five bytes a block. */
#define TSR_PICTURE_SCRATCH_LEN(width) (TSR_PICTURE_BLOCKS(width) * (10u * TSR_PICTURE_BLOCK + 5u))

/* Bytes above one a pixel that a picture of any content may take. */
#define TSR_PICTURE_EXCESS_LEN 1920u

/* The longest coded picture of this shape, whatever its content; a useful one takes a tenth of that. */
#define TSR_PICTURE_ENCODED_LEN_MAX(width, height)                                                                     \
    (TSR_PICTURE_BLOCKS(width) * TSR_PICTURE_BLOCKS(height) * TSR_PICTURE_BLOCK * TSR_PICTURE_BLOCK +                  \
     TSR_PICTURE_HEADER_LEN + TSR_PICTURE_EXCESS_LEN)

/* Number of adaptive bits of the model. */
#define TSR_PICTURE_CONTEXT_COUNT 381

/* What both directions share. Content private to the codec. */
struct tsr_picture_model {
    struct tsr_picture_info info;
    uint8_t *scratch;
    uint16_t row;          /* rows taken or handed out */
    uint16_t band;         /* bands coded */
    uint8_t step;          /* of the band coded last */
    uint32_t allowed_bits; /* spent more: blocks are only predicted */
    struct tsr_range_bit contexts[TSR_PICTURE_CONTEXT_COUNT];
};

struct tsr_picture_encoder {
    struct tsr_picture_model model;
    struct tsr_range_encoder range;
    uint32_t target_len;
    uint32_t band_start_len; /* bytes before the band coded last */
    uint32_t band_len;       /* of a band, smoothed */
};

struct tsr_picture_decoder {
    struct tsr_picture_model model;
    struct tsr_range_decoder range;
};

/* The bound of a picture's bytes at run time; 0 if info is null or out of range. */
size_t tsr_picture_encoded_len_max(const struct tsr_picture_info *info);

/*
 * Begin a picture: writes the header.
 *
 *   info         in, copied
 *   target_len   bytes that the picture shall take about, 0 for a constant step
 *   out          [out_cap] filled until _finish; tsr_picture_encoded_len_max bytes always suffice
 *   scratch      [scratch_cap] kept; scratch_cap >= TSR_PICTURE_SCRATCH_LEN(width)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or an info field out of range;
 * TSR_ERR_NOBUF if scratch_cap or out_cap (< TSR_PICTURE_HEADER_LEN) is too small.
 * On error nothing is touched.
 */
enum tsr_status tsr_picture_encode_start(struct tsr_picture_encoder *encoder, const struct tsr_picture_info *info,
                                         uint32_t target_len, uint8_t *out, size_t out_cap, uint8_t *scratch,
                                         size_t scratch_cap);

/*
 * Take the next row_count rows; every eighth row and the last code a band.
 *
 *   rows     [row_count * stride] borrowed
 *   stride   pixels from row to row, >= width
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row.
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing: nothing was taken. TSR_ERR_NOBUF when the coded picture
 * outgrew out_cap: the picture is lost, every further call returns the same; no
 * byte outside out was written.
 */
enum tsr_status tsr_picture_encode_rows(struct tsr_picture_encoder *encoder, const uint8_t *rows, size_t stride,
                                        uint16_t row_count);

/*
 * End the picture; call once. *len gets the length of the coded picture in out.
 *
 * Returns TSR_OK; TSR_AGAIN if rows are missing; TSR_ERR_ARG for a null
 * pointer; TSR_ERR_NOBUF if the coded picture did not fit. *len only with TSR_OK.
 */
enum tsr_status tsr_picture_encode_finish(struct tsr_picture_encoder *encoder, size_t *len);

/*
 * Read the header alone, to size the buffers.
 *
 * Returns TSR_OK with *info filled; TSR_ERR_ARG for a null pointer;
 * TSR_ERR_FORMAT for fewer than TSR_PICTURE_HEADER_LEN bytes or a width or height
 * out of range; TSR_ERR_VERSION for a version, mode or prior this build does not
 * know. On error *info is untouched.
 */
enum tsr_status tsr_picture_read_info(const uint8_t *bytes, size_t len, struct tsr_picture_info *info);

/*
 * Begin decoding bytes[len], kept until the last row.
 *
 *   info     out, filled
 *
 * Returns TSR_OK; TSR_ERR_NOBUF if scratch_cap <
 * TSR_PICTURE_SCRATCH_LEN(info.width); else as tsr_picture_read_info. On error
 * decoder, scratch and info are untouched.
 */
enum tsr_status tsr_picture_decode_start(struct tsr_picture_decoder *decoder, const uint8_t *bytes, size_t len,
                                         uint8_t *scratch, size_t scratch_cap, struct tsr_picture_info *info);

/*
 * Decode the next row_count rows.
 *
 *   rows     [row_count * stride] out, width pixels of each row filled
 *
 * Returns TSR_AGAIN while rows are missing, TSR_OK with the last row;
 * TSR_ERR_ARG for a null pointer, TSR_ERR_SIZE for a stride < width or more
 * rows than are missing; on error rows and decoder are untouched.
 */
enum tsr_status tsr_picture_decode_rows(struct tsr_picture_decoder *decoder, uint8_t *rows, size_t stride,
                                        uint16_t row_count);

#endif
