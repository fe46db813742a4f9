/*
 * Gray images against a held one: header, tiles, rows. docs/codec.md, 3.7.
 *
 *   byte 0      7..4 mode, 0 = on its own, 1 = against the held image   3..0 format version, 1
 *   byte 1      7..4 prior, 0   3..0 near
 *   bytes 2..5  width, height, 16 bits each, little-endian
 *   bytes 6..7  of mode 1: check of the held image
 *   then        range-coded flags of tiles and pixels
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray_history.h"

#include <string.h>

#include "frame.h"
#include "gray_row.h"
#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"

#define HEADER_LEN TSR_CODEC_FRAME_HEADER_LEN
#define CHECK_LEN 2u
#define MODE_AGAINST_HELD 1u

static bool is_valid_info(const struct tsr_gray_history_info *info)
{
    return tsr_codec_frame_is_valid_size(info->width, info->height) && info->near <= TSR_GRAY_NEAR_BY_ACTIVITY;
}

size_t tsr_gray_history_encoded_len_max(const struct tsr_gray_history_info *info)
{
    if (info == NULL || !is_valid_info(info)) {
        return 0;
    }
    return TSR_GRAY_HISTORY_ENCODED_LEN_MAX(info->width, info->height);
}

static size_t header_len_of(const struct tsr_gray_history_info *info)
{
    return HEADER_LEN + (info->against_held ? CHECK_LEN : 0u);
}

static enum tsr_status check_held(const struct tsr_gray_held *held, const struct tsr_gray_history_info *info)
{
    if (info->against_held && (!held->full || held->width != info->width || held->height != info->height)) {
        return TSR_ERR_NOREF;
    }
    return held->pixels_cap < (size_t)info->width * info->height ? TSR_ERR_NOBUF : TSR_OK;
}

/* Flags of the row of tiles above, with one in front and one behind that stay 0. */
static uint8_t *flags_of(const struct tsr_gray_history_model *model)
{
    return model->gray.scratch + TSR_GRAY_SCRATCH_LEN(model->gray.info.width);
}

static void start_model(struct tsr_gray_history_model *model, const struct tsr_gray_history_info *info,
                        struct tsr_gray_held *held, uint8_t *scratch)
{
    model->gray.info = (struct tsr_gray_info){info->width, info->height, info->near};
    model->gray.scratch = scratch;
    tsr_gray_model_reset(&model->gray);
    memset(flags_of(model), 0, TSR_VIEW_TILES_ACROSS(info->width) + 2u);
    tsr_range_bits_reset(model->tile_contexts, TSR_CODEC_FRAME_TILE_CONTEXTS);
    model->held = held;
    model->against_held = info->against_held;
    model->check = TSR_CRC16_START_HDLC;
    held->full = false;
}

enum tsr_status tsr_gray_history_encode_start(struct tsr_gray_history_encoder *encoder,
                                              const struct tsr_gray_history_info *info, struct tsr_gray_held *held,
                                              const uint8_t *tiles, uint8_t *out, size_t out_cap, uint8_t *scratch,
                                              size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || held == NULL || held->pixels == NULL || out == NULL || scratch == NULL ||
        !is_valid_info(info) || (info->against_held && tiles == NULL)) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status = check_held(held, info);
    if (status != TSR_OK) {
        return status;
    }
    if (out_cap < TSR_GRAY_HISTORY_HEADER_LEN_MAX || scratch_cap < TSR_GRAY_HISTORY_SCRATCH_LEN(info->width)) {
        return TSR_ERR_NOBUF;
    }
    const struct tsr_codec_frame_header header = {
        .version_mode = (uint8_t)(TSR_GRAY_FORMAT_VERSION | (info->against_held ? MODE_AGAINST_HELD << 4 : 0u)),
        .options = info->near,
        .width = info->width,
        .height = info->height};
    tsr_codec_frame_write_header(out, &header);
    if (info->against_held) {
        struct tsr_writer writer = tsr_writer_make(out + HEADER_LEN, CHECK_LEN);
        tsr_write_u16(&writer, held->check);
    }
    const size_t header_len = header_len_of(info);
    encoder->tiles = info->against_held ? tiles : NULL;
    start_model(&encoder->model, info, held, scratch);
    tsr_range_encode_start(&encoder->range, out + header_len, out_cap - header_len);
    return TSR_OK;
}

static unsigned rows_left(const struct tsr_gray_history_model *model)
{
    return (unsigned)model->gray.info.height - model->gray.row;
}

static void code_row(struct tsr_gray_history_model *model, const struct tsr_range_port *port, const uint8_t *tiles)
{
    struct tsr_gray_model *gray = &model->gray;
    const unsigned width = gray->info.width;
    uint8_t *const pixels = tsr_gray_row_pixels(gray);
    uint8_t *const held = model->held->pixels + (size_t)width * gray->row;
    if (model->against_held && gray->row % TSR_VIEW_TILE_PX == 0) {
        const unsigned count = (unsigned)TSR_VIEW_TILES_ACROSS(width);
        gray->allowed_bits += tsr_codec_frame_code_tiles(port, model->tile_contexts, flags_of(model), tiles, count);
    }
    for (unsigned x = 0; x < width; x += TSR_VIEW_TILE_PX) {
        const unsigned end = x + TSR_VIEW_TILE_PX < width ? x + TSR_VIEW_TILE_PX : width;
        if (!model->against_held || flags_of(model)[x / TSR_VIEW_TILE_PX + 1u] != 0) {
            tsr_gray_code_span(gray, port, x, end);
        } else {
            memcpy(pixels + x, held + x, end - x);
            memset(tsr_gray_row_errors(gray) + x, 0, end - x);
            gray->allowed_bits += 8u * (end - x);
        }
    }
    memcpy(held, pixels, width);
    model->check = tsr_crc16(model->check, held, width);
    gray->row++;
}

/* After the rows of a call: with the last one the held image is this one. */
static enum tsr_status progress(struct tsr_gray_history_model *model, const struct tsr_range_encoder *range)
{
    const enum tsr_status status = tsr_codec_frame_progress(range, rows_left(model));
    if (status == TSR_OK) {
        model->held->width = model->gray.info.width;
        model->held->height = model->gray.info.height;
        model->held->check = model->check;
        model->held->full = true;
    }
    return status;
}

enum tsr_status tsr_gray_history_encode_rows(struct tsr_gray_history_encoder *encoder, const uint8_t *rows,
                                             size_t stride, uint16_t row_count)
{
    if (encoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_gray_model *gray = &encoder->model.gray;
    const enum tsr_status status =
        tsr_codec_frame_check_rows(&encoder->range, gray->info.width, rows_left(&encoder->model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.encoder = &encoder->range};
    const size_t across = TSR_VIEW_TILES_ACROSS(gray->info.width);
    for (uint16_t y = 0; y < row_count && !tsr_codec_frame_is_lost(&encoder->range); y++) {
        memcpy(tsr_gray_row_pixels(gray), rows + y * stride, gray->info.width);
        const uint8_t *tiles = encoder->tiles;
        code_row(&encoder->model, &port, tiles != NULL ? tiles + across * (gray->row / TSR_VIEW_TILE_PX) : NULL);
    }
    return progress(&encoder->model, &encoder->range);
}

enum tsr_status tsr_gray_history_encode_finish(struct tsr_gray_history_encoder *encoder, size_t *len)
{
    if (encoder == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    const size_t header_len = HEADER_LEN + (encoder->model.against_held ? CHECK_LEN : 0u);
    const enum tsr_status status = tsr_codec_frame_finish(&encoder->range, rows_left(&encoder->model), header_len, len);
    if (status == TSR_ERR_NOBUF) {
        encoder->model.held->full = false;
    }
    return status;
}

/* The header with the check, which is 0 without one. */
static enum tsr_status read_header(const uint8_t *bytes, size_t len, struct tsr_gray_history_info *info,
                                   uint16_t *check)
{
    struct tsr_codec_frame_header header;
    if (!tsr_codec_frame_read_header(bytes, len, &header)) {
        return TSR_ERR_FORMAT;
    }
    const unsigned mode = header.version_mode >> 4;
    if ((header.version_mode & 15u) != TSR_GRAY_FORMAT_VERSION || mode > MODE_AGAINST_HELD ||
        header.options >> 4 != 0) {
        return TSR_ERR_VERSION;
    }
    const struct tsr_gray_history_info read = {.width = header.width,
                                               .height = header.height,
                                               .near = header.options,
                                               .against_held = mode == MODE_AGAINST_HELD};
    if (!is_valid_info(&read) || len < header_len_of(&read)) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(bytes + HEADER_LEN, len - HEADER_LEN);
    *check = read.against_held ? tsr_read_u16(&reader) : 0u;
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_gray_history_read_info(const uint8_t *bytes, size_t len, struct tsr_gray_history_info *info)
{
    uint16_t check = 0;
    return bytes == NULL || info == NULL ? TSR_ERR_ARG : read_header(bytes, len, info, &check);
}

enum tsr_status tsr_gray_history_decode_start(struct tsr_gray_history_decoder *decoder, const uint8_t *bytes,
                                              size_t len, struct tsr_gray_held *held, uint8_t *scratch,
                                              size_t scratch_cap, struct tsr_gray_history_info *info)
{
    if (decoder == NULL || bytes == NULL || held == NULL || held->pixels == NULL || scratch == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_gray_history_info read;
    uint16_t check = 0;
    enum tsr_status status = read_header(bytes, len, &read, &check);
    if (status == TSR_OK) {
        status = check_held(held, &read);
    }
    if (status == TSR_OK && read.against_held && check != held->check) {
        status = TSR_ERR_NOREF;
    }
    if (status == TSR_OK && scratch_cap < TSR_GRAY_HISTORY_SCRATCH_LEN(read.width)) {
        status = TSR_ERR_NOBUF;
    }
    if (status != TSR_OK) {
        return status;
    }
    const size_t header_len = header_len_of(&read);
    start_model(&decoder->model, &read, held, scratch);
    tsr_range_decode_start(&decoder->range, bytes + header_len, len - header_len);
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_gray_history_decode_rows(struct tsr_gray_history_decoder *decoder, uint8_t *rows, size_t stride,
                                             uint16_t row_count)
{
    if (decoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_gray_model *gray = &decoder->model.gray;
    const enum tsr_status status =
        tsr_codec_frame_check_rows(NULL, gray->info.width, rows_left(&decoder->model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.decoder = &decoder->range};
    for (uint16_t y = 0; y < row_count; y++) {
        const uint8_t *pixels = tsr_gray_row_pixels(gray);
        code_row(&decoder->model, &port, NULL);
        memcpy(rows + y * stride, pixels, gray->info.width);
    }
    return progress(&decoder->model, NULL);
}
