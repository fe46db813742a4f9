/*
 * Gray-image codec: header, checks and rows.
 *
 *   byte 0      7..4 mode, 0 = intra              3..0 format version, 1
 *   byte 1      7..4 prior, 0 = nothing learned   3..0 near
 *   bytes 2..5  width, height, 16 bits each, little-endian
 *   bytes 6..   range-coded pixels
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray.h"

#include <string.h>

#include "frame.h"
#include "gray_row.h"

/* docs/codec.md, 3.5: a pixel takes at most 16 adaptive bits of 11.01 and 9 direct ones, 24 bytes; 8-bit literals
 * lose 2^-16 of the range by rounding, 1 byte in the largest image. */
_Static_assert(TSR_GRAY_SLACK_LEN + 1u + 24u + 1u + TSR_RANGE_FINISH_LEN_MAX <= TSR_GRAY_EXCESS_LEN,
               "the bound of an encoded image");

static bool is_valid_info(const struct tsr_gray_info *info)
{
    return tsr_codec_frame_is_valid_size(info->width, info->height) && info->near <= TSR_GRAY_NEAR_BY_ACTIVITY;
}

size_t tsr_gray_encoded_len_max(const struct tsr_gray_info *info)
{
    if (info == NULL || !is_valid_info(info)) {
        return 0;
    }
    return TSR_GRAY_ENCODED_LEN_MAX(info->width, info->height);
}

static void start_model(struct tsr_gray_model *model, const struct tsr_gray_info *info, uint8_t *scratch)
{
    model->info = *info;
    model->scratch = scratch;
    tsr_gray_model_reset(model);
}

enum tsr_status tsr_gray_encode_start(struct tsr_gray_encoder *encoder, const struct tsr_gray_info *info, uint8_t *out,
                                      size_t out_cap, uint8_t *scratch, size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || out == NULL || scratch == NULL || !is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    if (out_cap < TSR_GRAY_HEADER_LEN || scratch_cap < TSR_GRAY_SCRATCH_LEN(info->width)) {
        return TSR_ERR_NOBUF;
    }
    tsr_codec_frame_write_header(out, &(struct tsr_codec_frame_header){.version_mode = TSR_GRAY_FORMAT_VERSION,
                                                                       .options = info->near,
                                                                       .width = info->width,
                                                                       .height = info->height});
    start_model(&encoder->model, info, scratch);
    tsr_range_encode_start(&encoder->range, out + TSR_GRAY_HEADER_LEN, out_cap - TSR_GRAY_HEADER_LEN);
    return TSR_OK;
}

static unsigned rows_left(const struct tsr_gray_model *model)
{
    return (unsigned)model->info.height - model->row;
}

enum tsr_status tsr_gray_encode_rows(struct tsr_gray_encoder *encoder, const uint8_t *rows, size_t stride,
                                     uint16_t row_count)
{
    if (encoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status = tsr_codec_frame_check_rows(&encoder->range, encoder->model.info.width,
                                                              rows_left(&encoder->model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.encoder = &encoder->range};
    for (uint16_t y = 0; y < row_count && !tsr_codec_frame_is_lost(&encoder->range); y++) {
        memcpy(tsr_gray_row_pixels(&encoder->model), rows + y * stride, encoder->model.info.width);
        tsr_gray_code_row(&encoder->model, &port);
    }
    return tsr_codec_frame_progress(&encoder->range, rows_left(&encoder->model));
}

enum tsr_status tsr_gray_encode_finish(struct tsr_gray_encoder *encoder, size_t *len)
{
    if (encoder == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    return tsr_codec_frame_finish(&encoder->range, rows_left(&encoder->model), TSR_GRAY_HEADER_LEN, len);
}

enum tsr_status tsr_gray_read_info(const uint8_t *bytes, size_t len, struct tsr_gray_info *info)
{
    if (bytes == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_codec_frame_header header;
    if (!tsr_codec_frame_read_header(bytes, len, &header)) {
        return TSR_ERR_FORMAT;
    }
    if (header.version_mode != TSR_GRAY_FORMAT_VERSION || header.options >> 4 != 0) {
        return TSR_ERR_VERSION;
    }
    const struct tsr_gray_info read = {.width = header.width, .height = header.height, .near = header.options};
    if (!is_valid_info(&read)) {
        return TSR_ERR_FORMAT;
    }
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_gray_decode_start(struct tsr_gray_decoder *decoder, const uint8_t *bytes, size_t len,
                                      uint8_t *scratch, size_t scratch_cap, struct tsr_gray_info *info)
{
    if (decoder == NULL || scratch == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_gray_info read;
    const enum tsr_status status = tsr_gray_read_info(bytes, len, &read);
    if (status != TSR_OK) {
        return status;
    }
    if (scratch_cap < TSR_GRAY_SCRATCH_LEN(read.width)) {
        return TSR_ERR_NOBUF;
    }
    start_model(&decoder->model, &read, scratch);
    tsr_range_decode_start(&decoder->range, bytes + TSR_GRAY_HEADER_LEN, len - TSR_GRAY_HEADER_LEN);
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_gray_decode_rows(struct tsr_gray_decoder *decoder, uint8_t *rows, size_t stride, uint16_t row_count)
{
    if (decoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status =
        tsr_codec_frame_check_rows(NULL, decoder->model.info.width, rows_left(&decoder->model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.decoder = &decoder->range};
    for (uint16_t y = 0; y < row_count; y++) {
        const uint8_t *pixels = tsr_gray_row_pixels(&decoder->model);
        tsr_gray_code_row(&decoder->model, &port);
        memcpy(rows + y * stride, pixels, decoder->model.info.width);
    }
    return tsr_codec_frame_progress(NULL, rows_left(&decoder->model));
}
