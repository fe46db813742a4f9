/*
 * What gray images, views and pictures have in common: a header that begins
 * alike, rows that come in any portions, and the end of the stream.
 *
 *   byte 0      7..4 mode   3..0 format version
 *   byte 1      the codec's own
 *   bytes 2..5  width, height, 16 bits each, little-endian
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_FRAME_H
#define TSR_CODEC_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "range_port.h"
#include "tsr/base/status.h"

#define TSR_CODEC_FRAME_HEADER_LEN 6u

struct tsr_codec_frame_header {
    uint8_t version_mode;
    uint8_t options; /* byte 1 */
    uint16_t width, height;
};

/* Width and height that every format admits. */
bool tsr_codec_frame_is_valid_size(uint16_t width, uint16_t height);

void tsr_codec_frame_write_header(uint8_t out[TSR_CODEC_FRAME_HEADER_LEN], const struct tsr_codec_frame_header *header);

/* False for fewer than TSR_CODEC_FRAME_HEADER_LEN bytes; no field is judged. */
bool tsr_codec_frame_read_header(const uint8_t *bytes, size_t len, struct tsr_codec_frame_header *header);

/* The stream outgrew its buffer: the frame is lost. A decoder has no such stream: null. */
static inline bool tsr_codec_frame_is_lost(const struct tsr_range_encoder *range)
{
    return range != NULL && range->at > range->cap;
}

/* May row_count rows follow when rows_left of the frame are left? TSR_ERR_NOBUF if it is lost, TSR_ERR_SIZE if not. */
enum tsr_status tsr_codec_frame_check_rows(const struct tsr_range_encoder *range, uint16_t width, unsigned rows_left,
                                           size_t stride, uint16_t row_count);

/* What a call of rows returns once they are coded. */
enum tsr_status tsr_codec_frame_progress(const struct tsr_range_encoder *range, unsigned rows_left);

/* Contexts of the flags of tiles, docs/codec.md, 4.4. */
#define TSR_CODEC_FRAME_TILE_CONTEXTS 8u

/*
 * Code the flags of a row of count tiles.
 *
 *   flags   [count + 2] in and out: of the row above, then of this one, at 1 .. count; the first and the last stay 0
 *   tiles   [count] in, 1 = coded; null in a decoder
 *
 * Returns the bits by which what may be spent grows.
 */
uint32_t tsr_codec_frame_code_tiles(const struct tsr_range_port *port,
                                    struct tsr_range_bit contexts[TSR_CODEC_FRAME_TILE_CONTEXTS], uint8_t *flags,
                                    const uint8_t *tiles, unsigned count);

/*
 * End the stream of a frame whose payload follows header_len bytes; *len, the length of both, only with TSR_OK.
 * TSR_ERR_NOBUF if it is lost or does not fit, TSR_AGAIN if rows are left.
 */
enum tsr_status tsr_codec_frame_finish(struct tsr_range_encoder *range, unsigned rows_left, size_t header_len,
                                       size_t *len);

#endif
