/*
 * Disparity-map codec: header, checks and the way between rows and labels.
 *
 *   byte 0      7..4 mode, 0 alone, 1 against a reference   3..0 format version, 3
 *   byte 1      7..4 prior   3 near                         2..0 step_log2
 *   byte 2      disparities - 1
 *   bytes 3..8  width, height, d0_q4, 16 bits each, little-endian
 *   bytes 9..10 with a reference: its id
 *   then        range-coded labels
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map.h"

#include "map_model.h"
#include "tsr/base/bytes.h"

#define MODE_ALONE 0u
#define MODE_REFERENCE 1u

/* docs/codec.md, 2.9: up to 16 pixels of at most 23 adaptive bits of 10.04 and 9 direct ones, 30 bytes, follow a check;
 * 12-bit literals lose 2^-12 of the range by rounding, 14 bytes in the largest map. */
_Static_assert(TSR_MAP_SLACK_LEN + 1u + TSR_MAP_LITERAL_PIXELS * 30u + 14u + TSR_RANGE_FINISH_LEN_MAX <=
                   TSR_MAP_EXCESS_LEN,
               "the bound of an encoded map");

size_t tsr_map_encoded_len_max(const struct tsr_map_info *info)
{
    if (info == NULL || !tsr_map_is_valid_info(info)) {
        return 0;
    }
    return TSR_MAP_ENCODED_LEN_MAX(info->width, info->height, info->disparities, info->step_log2);
}

static enum tsr_status start_encoder(struct tsr_map_encoder *encoder, const struct tsr_map_info *info,
                                     const struct tsr_map_reference *reference, const uint16_t *cells,
                                     struct tsr_writer *writer, uint16_t *scratch, size_t scratch_cap)
{
    const enum tsr_status status = tsr_map_model_start(&encoder->model, info, reference, cells, scratch, scratch_cap);
    if (status != TSR_OK) {
        return status;
    }
    const unsigned mode = reference != NULL ? MODE_REFERENCE : MODE_ALONE;
    tsr_write_u8(writer, (uint8_t)(TSR_MAP_FORMAT_VERSION | mode << 4));
    tsr_write_u8(writer, (uint8_t)(info->step_log2 | (unsigned)info->near << 3 | (unsigned)tsr_map_prior.id << 4));
    tsr_write_u8(writer, (uint8_t)(info->disparities - 1u));
    tsr_write_u16(writer, info->width);
    tsr_write_u16(writer, info->height);
    tsr_write_u16(writer, (uint16_t)info->d0_q4);
    encoder->status = TSR_OK;
    return TSR_OK;
}

enum tsr_status tsr_map_encode_start(struct tsr_map_encoder *encoder, const struct tsr_map_info *info, uint8_t *out,
                                     size_t out_cap, uint16_t *scratch, size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || out == NULL || info->near > TSR_MAP_NEAR_MAX) {
        return TSR_ERR_ARG;
    }
    if (out_cap < TSR_MAP_HEADER_LEN) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(out, TSR_MAP_HEADER_LEN);
    const enum tsr_status status =
        start_encoder(encoder, info, NULL, tsr_map_prior.cells[info->near], &writer, scratch, scratch_cap);
    if (status == TSR_OK) {
        encoder->code_row = tsr_map_encode_row;
        encoder->header_len = TSR_MAP_HEADER_LEN;
        tsr_range_encode_start(&encoder->range, out + TSR_MAP_HEADER_LEN, out_cap - TSR_MAP_HEADER_LEN);
    }
    return status;
}

enum tsr_status tsr_map_encode_start_against(struct tsr_map_encoder *encoder, const struct tsr_map_info *info,
                                             const struct tsr_map_reference *reference, uint8_t *out, size_t out_cap,
                                             uint16_t *scratch, size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || reference == NULL || out == NULL) {
        return TSR_ERR_ARG;
    }
    if (out_cap < TSR_MAP_HEADER_LEN_MAX) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(out, TSR_MAP_HEADER_LEN_MAX);
    const enum tsr_status status =
        start_encoder(encoder, info, reference, tsr_map_reference_prior.cells, &writer, scratch, scratch_cap);
    if (status == TSR_OK) {
        tsr_write_u16(&writer, reference->id);
        encoder->code_row = tsr_map_encode_reference_row;
        encoder->header_len = TSR_MAP_HEADER_LEN_MAX;
        tsr_range_encode_start(&encoder->range, out + TSR_MAP_HEADER_LEN_MAX, out_cap - TSR_MAP_HEADER_LEN_MAX);
    }
    return status;
}

static void row_from_labels(const struct tsr_map_model *model, uint16_t *row, const uint16_t *labels)
{
    for (unsigned x = 0; x < model->info.width; x++) {
        row[x] = (uint16_t)(labels[x] == model->invalid ? TSR_DISPARITY_INVALID : labels[x] << model->info.step_log2);
    }
}

static bool fits(const struct tsr_map_model *model, size_t stride, uint16_t row_count)
{
    return stride >= model->info.width && row_count <= model->info.height - model->row;
}

static enum tsr_status progress(const struct tsr_map_model *model)
{
    return model->row < model->info.height ? TSR_AGAIN : TSR_OK;
}

enum tsr_status tsr_map_encode_rows(struct tsr_map_encoder *encoder, const uint16_t *rows, size_t stride,
                                    uint16_t row_count)
{
    if (encoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    if (encoder->status != TSR_OK) {
        return encoder->status;
    }
    if (encoder->range.at > encoder->range.cap) {
        return TSR_ERR_NOBUF;
    }
    if (!fits(&encoder->model, stride, row_count)) {
        return TSR_ERR_SIZE;
    }
    for (uint16_t y = 0; y < row_count && encoder->range.at <= encoder->range.cap; y++) {
        if (!tsr_map_take_row(&encoder->model, rows + y * stride)) {
            encoder->status = TSR_ERR_ARG;
            return encoder->status;
        }
        encoder->code_row(&encoder->model, &encoder->range);
    }
    return encoder->range.at > encoder->range.cap ? TSR_ERR_NOBUF : progress(&encoder->model);
}

enum tsr_status tsr_map_encode_finish(struct tsr_map_encoder *encoder, size_t *len)
{
    if (encoder == NULL || len == NULL) {
        return TSR_ERR_ARG;
    }
    if (encoder->status != TSR_OK) {
        return encoder->status;
    }
    if (encoder->range.at > encoder->range.cap) {
        return TSR_ERR_NOBUF;
    }
    if (encoder->model.row < encoder->model.info.height) {
        return TSR_AGAIN;
    }
    size_t payload_len = 0;
    const enum tsr_status status = tsr_range_encode_finish(&encoder->range, &payload_len);
    if (status == TSR_OK) {
        *len = encoder->header_len + payload_len;
    }
    return status;
}

enum tsr_status tsr_map_read_info(const uint8_t *bytes, size_t len, struct tsr_map_info *info)
{
    if (bytes == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    if (len < TSR_MAP_HEADER_LEN) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    const uint8_t version_mode = tsr_read_u8(&reader);
    const uint8_t step_near_prior = tsr_read_u8(&reader);
    if ((version_mode & 15u) != TSR_MAP_FORMAT_VERSION || version_mode >> 4 > MODE_REFERENCE ||
        step_near_prior >> 4 != tsr_map_prior.id) {
        return TSR_ERR_VERSION;
    }
    struct tsr_map_info read = {.step_log2 = step_near_prior & 7u,
                                .near = step_near_prior >> 3 & 1u,
                                .disparities = (uint16_t)(tsr_read_u8(&reader) + 1u),
                                .has_reference = version_mode >> 4 == MODE_REFERENCE};
    read.width = tsr_read_u16(&reader);
    read.height = tsr_read_u16(&reader);
    const uint16_t d0_q4 = tsr_read_u16(&reader);
    read.d0_q4 = (int16_t)(d0_q4 < 0x8000u ? d0_q4 : (int32_t)d0_q4 - 0x10000);
    read.reference_id = read.has_reference ? tsr_read_u16(&reader) : 0;
    if (!tsr_map_is_valid_info(&read) || !tsr_reader_ok(&reader)) {
        return TSR_ERR_FORMAT;
    }
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_map_decode_start(struct tsr_map_decoder *decoder, const uint8_t *bytes, size_t len,
                                     const struct tsr_map_reference *reference, uint16_t *scratch, size_t scratch_cap,
                                     struct tsr_map_info *info)
{
    if (decoder == NULL || scratch == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_map_info read;
    const enum tsr_status status = tsr_map_read_info(bytes, len, &read);
    if (status != TSR_OK) {
        return status;
    }
    if (read.has_reference && (reference == NULL || reference->map == NULL || reference->id != read.reference_id)) {
        return TSR_ERR_NOREF;
    }
    const enum tsr_status started = tsr_map_model_start(
        &decoder->model, &read, read.has_reference ? reference : NULL,
        read.has_reference ? tsr_map_reference_prior.cells : tsr_map_prior.cells[read.near], scratch, scratch_cap);
    if (started != TSR_OK) {
        return started;
    }
    const size_t header_len = read.has_reference ? TSR_MAP_HEADER_LEN_MAX : TSR_MAP_HEADER_LEN;
    tsr_range_decode_start(&decoder->range, bytes + header_len, len - header_len);
    decoder->status = TSR_OK;
    *info = read;
    return TSR_OK;
}

static void fill_invalid(const struct tsr_map_info *info, uint16_t *rows, size_t stride, unsigned first, unsigned end)
{
    for (unsigned y = first; y < end; y++) {
        for (unsigned x = 0; x < info->width; x++) {
            rows[y * stride + x] = TSR_DISPARITY_INVALID;
        }
    }
}

enum tsr_status tsr_map_decode_rows(struct tsr_map_decoder *decoder, uint16_t *rows, size_t stride, uint16_t row_count)
{
    if (decoder == NULL || rows == NULL) {
        return TSR_ERR_ARG;
    }
    if (decoder->status != TSR_OK) {
        return decoder->status;
    }
    if (!fits(&decoder->model, stride, row_count)) {
        return TSR_ERR_SIZE;
    }
    const struct tsr_map_info *info = &decoder->model.info;
    for (uint16_t y = 0; y < row_count; y++) {
        const uint16_t *labels = tsr_map_row_labels(&decoder->model, 0);
        if (!(info->has_reference ? tsr_map_decode_reference_row : tsr_map_decode_row)(&decoder->model,
                                                                                       &decoder->range)) {
            decoder->status = TSR_ERR_FORMAT;
            fill_invalid(info, rows, stride, y, row_count);
            return decoder->status;
        }
        row_from_labels(&decoder->model, rows + y * stride, labels);
    }
    return progress(&decoder->model);
}
