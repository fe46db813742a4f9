/*
 * Prefiltered-view codec: header, checks and rows.
 *
 *   byte 0      7..4 mode, 0 = on its own, 1 = against the held view   3..0 format version, 1
 *   byte 1      7..4 prior: 0 = nothing learned, 1 = of coarse views   3 coarse   2..0 cap
 *   bytes 2..5  width, height, 16 bits each, little-endian
 *   bytes 6..7  of mode 1: check of the held view
 *   then        range-coded flags of tiles and levels
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/view.h"

#include "frame.h"
#include "tsr/base/bytes.h"
#include "view_row.h"

#define HEADER_LEN TSR_CODEC_FRAME_HEADER_LEN
#define CHECK_LEN 2u
#define MODE_AGAINST_HELD 1u
#define COARSE_BIT 0x08u
#define CAP_BITS 0x07u
#define PRIOR_OF_COARSE 1u

/* docs/codec.md, 4.6: a pixel takes at most 15 adaptive bits of 11.01, 21 bytes. */
_Static_assert(TSR_VIEW_SLACK_LEN + 1u + 21u + 1u + TSR_RANGE_FINISH_LEN_MAX <= TSR_VIEW_EXCESS_LEN,
               "the bound of a coded view");

static bool is_valid_info(const struct tsr_view_info *info)
{
    return tsr_codec_frame_is_valid_size(info->width, info->height) && info->cap >= 1 &&
           info->cap <= TSR_VIEW_CAP_MAX && (!info->coarse || info->cap == TSR_VIEW_CAP_MAX);
}

size_t tsr_view_encoded_len_max(const struct tsr_view_info *info)
{
    if (info == NULL || !is_valid_info(info)) {
        return 0;
    }
    return TSR_VIEW_ENCODED_LEN_MAX(info->width, info->height);
}

static size_t header_len_of(const struct tsr_view_info *info)
{
    return HEADER_LEN + (info->against_held ? CHECK_LEN : 0u);
}

/* TSR_OK if the view can be coded with what is held. */
static enum tsr_status check_held(const struct tsr_view_held *held, const struct tsr_view_info *info)
{
    if (info->against_held &&
        (held == NULL || !held->full || held->info.width != info->width || held->info.height != info->height ||
         held->info.cap != info->cap || held->info.coarse != info->coarse)) {
        return TSR_ERR_NOREF;
    }
    if (held != NULL && held->packed_cap < TSR_VIEW_HELD_LEN(info->width, info->height)) {
        return TSR_ERR_NOBUF;
    }
    return TSR_OK;
}

static void start_model(struct tsr_view_model *model, const struct tsr_view_info *info, struct tsr_view_held *held,
                        uint8_t *scratch)
{
    model->info = *info;
    model->held = held;
    model->scratch = scratch;
    tsr_view_model_reset(model);
    if (held != NULL) {
        held->full = false;
    }
}

enum tsr_status tsr_view_encode_start(struct tsr_view_encoder *encoder, const struct tsr_view_info *info,
                                      struct tsr_view_held *held, const uint8_t *tiles, uint8_t *out, size_t out_cap,
                                      uint8_t *scratch, size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || out == NULL || scratch == NULL || !is_valid_info(info) ||
        (info->against_held && tiles == NULL) || (held != NULL && held->packed == NULL)) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status = check_held(held, info);
    if (status != TSR_OK) {
        return status;
    }
    if (out_cap < TSR_VIEW_HEADER_LEN_MAX || scratch_cap < TSR_VIEW_SCRATCH_LEN(info->width)) {
        return TSR_ERR_NOBUF;
    }
    const struct tsr_codec_frame_header header = {
        .version_mode = (uint8_t)(TSR_VIEW_FORMAT_VERSION | (info->against_held ? MODE_AGAINST_HELD << 4 : 0u)),
        .options = (uint8_t)(info->cap | (info->coarse ? COARSE_BIT | PRIOR_OF_COARSE << 4 : 0u)),
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

static unsigned rows_left(const struct tsr_view_model *model)
{
    return (unsigned)model->info.height - model->row;
}

/* After the rows of a call: with the last one the held view is this one. */
static enum tsr_status progress(struct tsr_view_model *model, const struct tsr_range_encoder *range)
{
    const enum tsr_status status = tsr_codec_frame_progress(range, rows_left(model));
    if (status == TSR_OK && model->held != NULL) {
        model->held->info = model->info;
        model->held->check = model->check;
        model->held->full = true;
    }
    return status;
}

enum tsr_status tsr_view_encode_rows(struct tsr_view_encoder *encoder, const uint8_t *rows, size_t stride,
                                     uint16_t row_count)
{
    if (encoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_view_model *model = &encoder->model;
    const enum tsr_status status =
        tsr_codec_frame_check_rows(&encoder->range, model->info.width, rows_left(model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.encoder = &encoder->range};
    const size_t across = TSR_VIEW_TILES_ACROSS(model->info.width);
    for (uint16_t y = 0; y < row_count && !tsr_codec_frame_is_lost(&encoder->range); y++) {
        const uint8_t *tiles = encoder->tiles;
        tiles = tiles != NULL ? tiles + across * (model->row / TSR_VIEW_TILE_PX) : NULL;
        tsr_view_code_row(model, &port, NULL, rows + y * stride, tiles);
    }
    return progress(model, &encoder->range);
}

enum tsr_status tsr_view_encode_finish(struct tsr_view_encoder *encoder, size_t *len)
{
    if (encoder == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_view_model *model = &encoder->model;
    const enum tsr_status status =
        tsr_codec_frame_finish(&encoder->range, rows_left(model), header_len_of(&model->info), len);
    if (status == TSR_ERR_NOBUF && model->held != NULL) {
        model->held->full = false;
    }
    return status;
}

/* The header with the check, which is 0 without one. */
static __attribute__((noinline)) enum tsr_status read_header(const uint8_t *bytes, size_t len,
                                                             struct tsr_view_info *info, uint16_t *check)
{
    struct tsr_codec_frame_header header;
    if (!tsr_codec_frame_read_header(bytes, len, &header)) {
        return TSR_ERR_FORMAT;
    }
    const unsigned mode = header.version_mode >> 4;
    const struct tsr_view_info read = {.width = header.width,
                                       .height = header.height,
                                       .cap = header.options & CAP_BITS,
                                       .coarse = (header.options & COARSE_BIT) != 0,
                                       .against_held = mode == MODE_AGAINST_HELD};
    if ((header.version_mode & 15u) != TSR_VIEW_FORMAT_VERSION || mode > MODE_AGAINST_HELD ||
        header.options >> 4 != (read.coarse ? PRIOR_OF_COARSE : 0u)) {
        return TSR_ERR_VERSION;
    }
    if (!is_valid_info(&read) || len < header_len_of(&read)) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(bytes + HEADER_LEN, len - HEADER_LEN);
    *check = read.against_held ? tsr_read_u16(&reader) : 0u;
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_view_read_info(const uint8_t *bytes, size_t len, struct tsr_view_info *info)
{
    uint16_t check = 0;
    return bytes == NULL || info == NULL ? TSR_ERR_ARG : read_header(bytes, len, info, &check);
}

enum tsr_status tsr_view_decode_start(struct tsr_view_decoder *decoder, const uint8_t *bytes, size_t len,
                                      struct tsr_view_held *held, uint8_t *scratch, size_t scratch_cap,
                                      struct tsr_view_info *info)
{
    if (decoder == NULL || bytes == NULL || scratch == NULL || info == NULL || (held != NULL && held->packed == NULL)) {
        return TSR_ERR_ARG;
    }
    struct tsr_view_info read;
    uint16_t check = 0;
    enum tsr_status status = read_header(bytes, len, &read, &check);
    if (status == TSR_OK) {
        status = check_held(held, &read);
    }
    if (status == TSR_OK && read.against_held && check != held->check) {
        status = TSR_ERR_NOREF;
    }
    if (status == TSR_OK && scratch_cap < TSR_VIEW_SCRATCH_LEN(read.width)) {
        status = TSR_ERR_NOBUF;
    }
    if (status != TSR_OK) {
        return status;
    }
    start_model(&decoder->model, &read, held, scratch);
    const size_t header_len = header_len_of(&read);
    tsr_range_decode_start(&decoder->range, bytes + header_len, len - header_len);
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_view_decode_rows(struct tsr_view_decoder *decoder, uint8_t *rows, size_t stride, uint16_t row_count)
{
    if (decoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_view_model *model = &decoder->model;
    const enum tsr_status status =
        tsr_codec_frame_check_rows(NULL, model->info.width, rows_left(model), stride, row_count);
    if (status != TSR_OK) {
        return status;
    }
    const struct tsr_range_port port = {.decoder = &decoder->range};
    for (uint16_t y = 0; y < row_count; y++) {
        tsr_view_code_row(model, &port, rows + y * stride, NULL, NULL);
    }
    return progress(model, NULL);
}
