/*
 * Header and end of a coded frame.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "frame.h"

#include "tsr/base/bytes.h"
#include "tsr/base/image.h"

#define TILE_BITS_ALLOWED 12u

bool tsr_codec_frame_is_valid_size(uint16_t width, uint16_t height)
{
    return width >= 1 && width <= TSR_IMAGE_WIDTH_MAX && height >= 1 && height <= TSR_IMAGE_HEIGHT_MAX;
}

void tsr_codec_frame_write_header(uint8_t out[TSR_CODEC_FRAME_HEADER_LEN], const struct tsr_codec_frame_header *header)
{
    struct tsr_writer writer = tsr_writer_make(out, TSR_CODEC_FRAME_HEADER_LEN);
    tsr_write_u8(&writer, header->version_mode);
    tsr_write_u8(&writer, header->options);
    tsr_write_u16(&writer, header->width);
    tsr_write_u16(&writer, header->height);
}

bool tsr_codec_frame_read_header(const uint8_t *bytes, size_t len, struct tsr_codec_frame_header *header)
{
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    header->version_mode = tsr_read_u8(&reader);
    header->options = tsr_read_u8(&reader);
    header->width = tsr_read_u16(&reader);
    header->height = tsr_read_u16(&reader);
    return tsr_reader_ok(&reader);
}

enum tsr_status tsr_codec_frame_check_rows(const struct tsr_range_encoder *range, uint16_t width, unsigned rows_left,
                                           size_t stride, uint16_t row_count)
{
    if (tsr_codec_frame_is_lost(range)) {
        return TSR_ERR_NOBUF;
    }
    return stride >= width && row_count <= rows_left ? TSR_OK : TSR_ERR_SIZE;
}

enum tsr_status tsr_codec_frame_progress(const struct tsr_range_encoder *range, unsigned rows_left)
{
    return tsr_codec_frame_is_lost(range) ? TSR_ERR_NOBUF : rows_left > 0 ? TSR_AGAIN : TSR_OK;
}

uint32_t tsr_codec_frame_code_tiles(const struct tsr_range_port *port,
                                    struct tsr_range_bit contexts[TSR_CODEC_FRAME_TILE_CONTEXTS], uint8_t *flags,
                                    const uint8_t *tiles, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        const unsigned around = flags[i] + 2u * flags[i + 1u] + 4u * flags[i + 2u];
        flags[i + 1u] = tsr_port_bit(port, &contexts[around], tiles != NULL && tiles[i] != 0) ? 1u : 0u;
    }
    return TILE_BITS_ALLOWED * count;
}

enum tsr_status tsr_codec_frame_finish(struct tsr_range_encoder *range, unsigned rows_left, size_t header_len,
                                       size_t *len)
{
    size_t payload_len = 0;
    enum tsr_status status = tsr_codec_frame_progress(range, rows_left);
    if (status == TSR_OK) {
        status = tsr_range_encode_finish(range, &payload_len);
    }
    if (status == TSR_OK) {
        *len = header_len + payload_len;
    }
    return status;
}
