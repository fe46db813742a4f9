/*
 * Disparity-map codec: header, checks and the way between rows and labels.
 *
 *   byte 0      7..4 mode, 0 = intra lossless     3..0 format version, 1
 *   byte 1      7..4 prior, 0 = nothing learned   3..0 step_log2
 *   byte 2      disparities - 1
 *   bytes 3..8  width, height, d0_q4, 16 bits each, little-endian
 *   bytes 9..   range-coded labels
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map.h"

#include "map_row.h"
#include "tsr/base/bytes.h"

/* docs/codec.md, 2.8: a pixel takes at most 22 adaptive bits of 11.01 and 9 direct ones, 32 bytes; 12-bit literals
 * lose 2^-12 of the range by rounding, 14 bytes in the largest map. */
_Static_assert(TSR_MAP_SLACK_LEN + 1u + 32u + 14u + TSR_RANGE_FINISH_LEN_MAX <= TSR_MAP_EXCESS_LEN,
               "the bound of an encoded map");

static bool is_valid_info(const struct tsr_map_info *info)
{
    return info->width >= 1 && info->width <= TSR_IMAGE_WIDTH_MAX && info->height >= 1 &&
           info->height <= TSR_IMAGE_HEIGHT_MAX && info->disparities >= 1 &&
           info->disparities <= TSR_DISPARITY_COUNT_MAX && info->step_log2 <= TSR_MAP_STEP_LOG2_MAX;
}

size_t tsr_map_encoded_len_max(const struct tsr_map_info *info)
{
    if (info == NULL || !is_valid_info(info)) {
        return 0;
    }
    return TSR_MAP_ENCODED_LEN_MAX(info->width, info->height, info->disparities, info->step_log2);
}

static void start_model(struct tsr_map_model *model, const struct tsr_map_info *info, uint16_t *scratch)
{
    model->info = *info;
    model->scratch = scratch;
    model->label_count = (uint16_t)(1u + ((info->disparities * TSR_DISPARITY_ONE_Q4) >> info->step_log2));
    model->label_bits = (uint8_t)TSR_MAP_LABEL_BITS(info->disparities, info->step_log2);
    tsr_map_model_reset(model);
}

enum tsr_status tsr_map_encode_start(struct tsr_map_encoder *encoder, const struct tsr_map_info *info, uint8_t *out,
                                     size_t out_cap, uint16_t *scratch, size_t scratch_cap)
{
    if (encoder == NULL || info == NULL || out == NULL || scratch == NULL || !is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    if (out_cap < TSR_MAP_HEADER_LEN || scratch_cap < TSR_MAP_SCRATCH_COUNT(info->width)) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(out, TSR_MAP_HEADER_LEN);
    tsr_write_u8(&writer, TSR_MAP_FORMAT_VERSION);
    tsr_write_u8(&writer, info->step_log2);
    tsr_write_u8(&writer, (uint8_t)(info->disparities - 1u));
    tsr_write_u16(&writer, info->width);
    tsr_write_u16(&writer, info->height);
    tsr_write_u16(&writer, (uint16_t)info->d0_q4);
    start_model(&encoder->model, info, scratch);
    tsr_range_encode_start(&encoder->range, out + TSR_MAP_HEADER_LEN, out_cap - TSR_MAP_HEADER_LEN);
    return TSR_OK;
}

static bool is_valid_row(const struct tsr_map_info *info, const uint16_t *row)
{
    const unsigned end = info->disparities * TSR_DISPARITY_ONE_Q4;
    const unsigned below_step = (1u << info->step_log2) - 1u;
    for (unsigned x = 0; x < info->width; x++) {
        if (row[x] != TSR_DISPARITY_INVALID && (row[x] >= end || (row[x] & below_step) != 0)) {
            return false;
        }
    }
    return true;
}

static void labels_from_row(const struct tsr_map_info *info, uint16_t *labels, const uint16_t *row)
{
    for (unsigned x = 0; x < info->width; x++) {
        labels[x] = TSR_LABEL_INVALID;
        if (row[x] != TSR_DISPARITY_INVALID) {
            labels[x] = (uint16_t)(1u + ((unsigned)row[x] >> info->step_log2));
        }
    }
}

static void row_from_labels(const struct tsr_map_info *info, uint16_t *row, const uint16_t *labels)
{
    for (unsigned x = 0; x < info->width; x++) {
        row[x] = TSR_DISPARITY_INVALID;
        if (labels[x] != TSR_LABEL_INVALID) {
            row[x] = (uint16_t)((labels[x] - 1u) << info->step_log2);
        }
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
    if (encoder->range.at > encoder->range.cap) {
        return TSR_ERR_NOBUF;
    }
    if (!fits(&encoder->model, stride, row_count)) {
        return TSR_ERR_SIZE;
    }
    const struct tsr_map_info *info = &encoder->model.info;
    for (uint16_t y = 0; y < row_count; y++) {
        if (!is_valid_row(info, rows + y * stride)) {
            return TSR_ERR_ARG;
        }
    }
    const struct tsr_range_port port = {.encoder = &encoder->range};
    for (uint16_t y = 0; y < row_count && encoder->range.at <= encoder->range.cap; y++) {
        labels_from_row(info, tsr_map_row_labels(&encoder->model), rows + y * stride);
        (void)tsr_map_code_row(&encoder->model, &port); /* an encoder's labels exist */
    }
    return encoder->range.at > encoder->range.cap ? TSR_ERR_NOBUF : progress(&encoder->model);
}

enum tsr_status tsr_map_encode_finish(struct tsr_map_encoder *encoder, size_t *len)
{
    if (encoder == NULL || len == NULL) {
        return TSR_ERR_ARG;
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
        *len = TSR_MAP_HEADER_LEN + payload_len;
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
    const uint8_t step_prior = tsr_read_u8(&reader);
    if (version_mode != TSR_MAP_FORMAT_VERSION || step_prior >> 4 != 0) {
        return TSR_ERR_VERSION;
    }
    struct tsr_map_info read = {.step_log2 = step_prior, .disparities = (uint16_t)(tsr_read_u8(&reader) + 1u)};
    read.width = tsr_read_u16(&reader);
    read.height = tsr_read_u16(&reader);
    const uint16_t d0_q4 = tsr_read_u16(&reader);
    read.d0_q4 = (int16_t)(d0_q4 < 0x8000u ? d0_q4 : (int32_t)d0_q4 - 0x10000);
    if (!is_valid_info(&read)) {
        return TSR_ERR_FORMAT;
    }
    *info = read;
    return TSR_OK;
}

enum tsr_status tsr_map_decode_start(struct tsr_map_decoder *decoder, const uint8_t *bytes, size_t len,
                                     uint16_t *scratch, size_t scratch_cap, struct tsr_map_info *info)
{
    if (decoder == NULL || scratch == NULL || info == NULL) {
        return TSR_ERR_ARG;
    }
    struct tsr_map_info read;
    const enum tsr_status status = tsr_map_read_info(bytes, len, &read);
    if (status != TSR_OK) {
        return status;
    }
    if (scratch_cap < TSR_MAP_SCRATCH_COUNT(read.width)) {
        return TSR_ERR_NOBUF;
    }
    start_model(&decoder->model, &read, scratch);
    tsr_range_decode_start(&decoder->range, bytes + TSR_MAP_HEADER_LEN, len - TSR_MAP_HEADER_LEN);
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
    const struct tsr_range_port port = {.decoder = &decoder->range};
    for (uint16_t y = 0; y < row_count; y++) {
        const uint16_t *labels = tsr_map_row_labels(&decoder->model);
        if (!tsr_map_code_row(&decoder->model, &port)) {
            decoder->status = TSR_ERR_FORMAT;
            fill_invalid(info, rows, stride, y, row_count);
            return decoder->status;
        }
        row_from_labels(info, rows + y * stride, labels);
    }
    return progress(&decoder->model);
}
