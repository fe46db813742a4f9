/*
 * Picture codec: header, checks, rows to bands and back, rate.
 *
 *   byte 0      7..4 mode, 0 = one picture     3..0 format version, 1
 *   byte 1      7..6 prior                     5..0 step of the first band
 *   bytes 2..5  width, height, 16 bits each, little-endian
 *   bytes 6..   range-coded bands
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/picture.h"

#include <string.h>

#include "frame.h"
#include "picture_block.h"

#define RATE_CHANGE_MAX 6

/* docs/codec.md, 5.10: a block takes at most 64 (16 * 11.01 + 10) + 20 * 11.01 + 3 bits, 1516 bytes, a band 4 bytes
 * more; direct bits lose less than 2^-11 of a bit each by rounding. */
_Static_assert(TSR_PICTURE_SLACK_LEN + 1u + 1516u + 4u + 64u + TSR_RANGE_FINISH_LEN_MAX <= TSR_PICTURE_EXCESS_LEN,
               "the bound of an encoded picture");

static bool is_valid_info(const struct tsr_picture_info *info)
{
    return tsr_codec_frame_is_valid_size(info->width, info->height) && info->step <= TSR_PICTURE_STEP_MAX &&
           info->prior <= TSR_PICTURE_PRIOR_TRAINED;
}

size_t tsr_picture_encoded_len_max(const struct tsr_picture_info *info)
{
    if (info == NULL || !is_valid_info(info)) {
        return 0;
    }
    return TSR_PICTURE_ENCODED_LEN_MAX(info->width, info->height);
}

static void start_model(struct tsr_picture_model *model, const struct tsr_picture_info *info, uint8_t *scratch)
{
    model->info = *info;
    model->scratch = scratch;
    tsr_picture_model_reset(model);
}

enum tsr_status tsr_picture_encode_start(struct tsr_picture_encoder *encoder, const struct tsr_picture_info *info,
                                         uint32_t target_len, uint8_t *out, size_t out_cap, uint8_t *scratch,
                                         size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || out == NULL || scratch == NULL || !is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    if (out_cap < TSR_PICTURE_HEADER_LEN || scratch_cap < TSR_PICTURE_SCRATCH_LEN(info->width)) {
        return TSR_ERR_NOBUF;
    }
    tsr_codec_frame_write_header(out,
                                 &(struct tsr_codec_frame_header){.version_mode = TSR_PICTURE_FORMAT_VERSION,
                                                                  .options = (uint8_t)(info->prior << 6 | info->step),
                                                                  .width = info->width,
                                                                  .height = info->height});
    start_model(&encoder->model, info, scratch);
    tsr_range_encode_start(&encoder->range, out + TSR_PICTURE_HEADER_LEN, out_cap - TSR_PICTURE_HEADER_LEN);
    encoder->target_len = target_len;
    encoder->band_start_len = 0;
    encoder->band_len = 0;
    return TSR_OK;
}

static unsigned rows_left(const struct tsr_picture_model *model)
{
    return (unsigned)model->info.height - model->row;
}

static unsigned bands_of(const struct tsr_picture_model *model)
{
    return (unsigned)TSR_PICTURE_BLOCKS(model->info.height);
}

/* How the step shall change so that the bytes left last for the bands left, each as long as those before. */
static int steer(struct tsr_picture_encoder *encoder)
{
    const unsigned bands_left = bands_of(&encoder->model) - encoder->model.band;
    if (encoder->target_len == 0 || encoder->model.band == 0) {
        return 0;
    }
    const uint32_t spent = (uint32_t)encoder->range.at + TSR_PICTURE_HEADER_LEN;
    const uint32_t wanted = spent < encoder->target_len ? (encoder->target_len - spent) / bands_left : 0;
    /* One step is about 1/14 of the bytes; half of that is not worth a change. */
    uint32_t more = encoder->band_len;
    uint32_t less = more;
    int change = 0;
    while (change < RATE_CHANGE_MAX && more > wanted + wanted / 32u) {
        more -= more / 14u + 1u;
        change++;
    }
    while (change > -RATE_CHANGE_MAX && less + less / 32u < wanted) {
        less += less / 14u + 1u;
        change--;
    }
    encoder->band_len = change > 0 ? more : less; /* as it would have been with the new step */
    return change;
}

/* Fill the band beyond the picture with its last column and row. */
static void extend(const struct tsr_picture_rows *rows, unsigned width, unsigned row_count)
{
    uint8_t *const band = rows->pixels + 2u * rows->stride;
    for (unsigned y = 0; y < row_count; y++) {
        uint8_t *const row = band + y * rows->stride;
        memset(row + width, row[width - 1u], rows->stride - width);
    }
    for (unsigned y = row_count; y < TSR_PICTURE_BLOCK; y++) {
        memcpy(band + y * rows->stride, band + (row_count - 1u) * rows->stride, rows->stride);
    }
}

static void encode_band(struct tsr_picture_encoder *encoder, const struct tsr_picture_rows *rows, unsigned row_count)
{
    const struct tsr_range_port port = {.encoder = &encoder->range};
    extend(rows, encoder->model.info.width, row_count);
    const int change = steer(encoder);
    encoder->band_start_len = (uint32_t)encoder->range.at;
    tsr_picture_code_band(&encoder->model, &port, change);
    const uint32_t len = (uint32_t)encoder->range.at - encoder->band_start_len;
    encoder->band_len = encoder->model.band == 1u ? len : (encoder->band_len + len + 1u) / 2u;
    tsr_picture_keep_last_rows(rows);
}

enum tsr_status tsr_picture_encode_rows(struct tsr_picture_encoder *encoder, const uint8_t *rows, size_t stride,
                                        uint16_t row_count)
{
    if (encoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_picture_model *const model = &encoder->model;
    const enum tsr_status status =
        tsr_codec_frame_check_rows(&encoder->range, model->info.width, rows_left(model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_picture_rows band = tsr_picture_rows_of(model);
    for (uint16_t y = 0; y < row_count && !tsr_codec_frame_is_lost(&encoder->range); y++) {
        const unsigned in_band = model->row % TSR_PICTURE_BLOCK;
        memcpy(band.pixels + (2u + in_band) * band.stride, rows + y * stride, model->info.width);
        model->row++;
        if (in_band == TSR_PICTURE_BLOCK - 1u || model->row == model->info.height) {
            encode_band(encoder, &band, in_band + 1u);
        }
    }
    return tsr_codec_frame_progress(&encoder->range, rows_left(model));
}

enum tsr_status tsr_picture_encode_finish(struct tsr_picture_encoder *encoder, size_t *len)
{
    if (encoder == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    return tsr_codec_frame_finish(&encoder->range, rows_left(&encoder->model), TSR_PICTURE_HEADER_LEN, len);
}

enum tsr_status tsr_picture_read_info(const uint8_t *bytes, size_t len, struct tsr_picture_info *info)
{
    if (bytes == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_codec_frame_header header;
    if (!tsr_codec_frame_read_header(bytes, len, &header)) {
        return TSR_ERR_FORMAT;
    }
    if (header.version_mode != TSR_PICTURE_FORMAT_VERSION || header.options >> 6 > TSR_PICTURE_PRIOR_TRAINED) {
        return TSR_ERR_VERSION;
    }
    const struct tsr_picture_info read = {.width = header.width,
                                          .height = header.height,
                                          .step = header.options & 63u,
                                          .prior = (uint8_t)(header.options >> 6)};
    if (!is_valid_info(&read)) {
        return TSR_ERR_FORMAT;
    }
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_picture_decode_start(struct tsr_picture_decoder *decoder, const uint8_t *bytes, size_t len,
                                         uint8_t *scratch, size_t scratch_cap, struct tsr_picture_info *info)
{
    if (decoder == NULL || scratch == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_picture_info read;
    const enum tsr_status status = tsr_picture_read_info(bytes, len, &read);
    if (status != TSR_OK) {
        return status;
    }
    if (scratch_cap < TSR_PICTURE_SCRATCH_LEN(read.width)) {
        return TSR_ERR_NOBUF;
    }
    start_model(&decoder->model, &read, scratch);
    tsr_range_decode_start(&decoder->range, bytes + TSR_PICTURE_HEADER_LEN, len - TSR_PICTURE_HEADER_LEN);
    *info = read;
    return TSR_OK;
}

/* Smoothing a row needs the row below it. */
static bool needs_band(const struct tsr_picture_model *model)
{
    return model->band < bands_of(model) && model->row + 1u >= TSR_PICTURE_BLOCK * (unsigned)model->band;
}

enum tsr_status tsr_picture_decode_rows(struct tsr_picture_decoder *decoder, uint8_t *rows, size_t stride,
                                        uint16_t row_count)
{
    if (decoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_picture_model *const model = &decoder->model;
    const enum tsr_status status =
        tsr_codec_frame_check_rows(NULL, model->info.width, rows_left(model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.decoder = &decoder->range};
    const struct tsr_picture_rows band = tsr_picture_rows_of(model);
    for (uint16_t y = 0; y < row_count; y++, model->row++) {
        while (needs_band(model)) {
            tsr_picture_keep_last_rows(&band);
            tsr_picture_code_band(model, &port, 0);
        }
        tsr_picture_smooth_row(model, model->row, rows + y * stride);
    }
    return tsr_codec_frame_progress(NULL, rows_left(model));
}
