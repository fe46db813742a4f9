/*
 * The rectification table: parsed once, then trusted.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <string.h>

#include "rectify_spline.h"
#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"
#include "tsr/vision/rectify.h"

#define MAGIC_LEN 4u

static const uint8_t magic[MAGIC_LEN] = {'T', 'S', 'R', 'M'};

static bool is_side(uint16_t length, uint16_t max)
{
    return length >= TSR_RECTIFY_SIDE_MIN && length <= max;
}

static bool has_sizes(const struct tsr_rectify_table *table)
{
    return table->step_log2 >= TSR_RECTIFY_STEP_LOG2_MIN && table->step_log2 <= TSR_RECTIFY_STEP_LOG2_MAX &&
           is_side(table->width, TSR_IMAGE_WIDTH_MAX) && is_side(table->height, TSR_IMAGE_HEIGHT_MAX) &&
           is_side(table->source_width, TSR_IMAGE_WIDTH_MAX) && is_side(table->source_height, TSR_IMAGE_HEIGHT_MAX);
}

static bool has_crc(const uint8_t *bytes, size_t len)
{
    size_t covered = len - TSR_RECTIFY_CRC_LEN;
    unsigned crc = tsr_crc16(TSR_CRC16_START_HDLC, bytes, covered) ^ 0xffffu;
    return bytes[covered] == (crc & 0xffu) && bytes[covered + 1u] == crc >> 8;
}

/* The first source row that target row y reads, px, clipped to the source. */
static int32_t first_row_read(const struct tsr_rectify_table *table, enum tsr_rectify_side side, unsigned y)
{
    const unsigned step = 1u << table->step_log2;
    int32_t least = INT32_MAX;
    struct tsr_rectify_row row;
    struct tsr_rectify_cubic cubic[2];
    tsr_rectify_row_start(&row, table, side, y);
    for (unsigned first = 0; first < table->width; first += step) {
        const unsigned count = table->width - first < step ? table->width - first : step;
        tsr_rectify_row_next_span(&row, cubic);
        struct tsr_rectify_cubic down = cubic[1];
        for (unsigned i = 0; i < count; i++) {
            const int32_t position = (int32_t)down.position;
            least = least < position ? least : position;
            tsr_rectify_step(&down);
        }
    }
    return tsr_rectify_clip_position((uint32_t)least, (table->source_height - 1) * 256) >> 8;
}

uint16_t tsr_rectify_measure_rows_above(const struct tsr_rectify_table *table, enum tsr_rectify_side side)
{
    int32_t rows_above = 0;
    for (unsigned y = 0; y < table->height; y++) {
        int32_t above = (int32_t)y - first_row_read(table, side, y);
        rows_above = rows_above > above ? rows_above : above;
    }
    return (uint16_t)rows_above;
}

static void read_header(struct tsr_rectify_table *table, struct tsr_reader *reader, uint16_t *reserved)
{
    table->step_log2 = tsr_read_u8(reader);
    table->width = tsr_read_u16(reader);
    table->height = tsr_read_u16(reader);
    table->source_width = tsr_read_u16(reader);
    table->source_height = tsr_read_u16(reader);
    table->rows_above[TSR_RECTIFY_LEFT] = tsr_read_u16(reader);
    table->rows_above[TSR_RECTIFY_RIGHT] = tsr_read_u16(reader);
    table->d0_q4 = (int16_t)tsr_read_u16(reader);
    *reserved = tsr_read_u16(reader);
    table->focal_q16 = tsr_read_u32(reader);
    table->baseline_q16 = tsr_read_u32(reader);
    table->cx_q16 = (int32_t)tsr_read_u32(reader);
    table->cy_q16 = (int32_t)tsr_read_u32(reader);
}

enum tsr_status tsr_rectify_open(struct tsr_rectify_table *table, const uint8_t *bytes, size_t len)
{
    if (table == NULL || bytes == NULL) {
        return TSR_ERR_ARG;
    }
    if (len < MAGIC_LEN || memcmp(bytes, magic, MAGIC_LEN) != 0) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(bytes + MAGIC_LEN, len - MAGIC_LEN);
    if (tsr_read_u8(&reader) != TSR_RECTIFY_VERSION) {
        return tsr_reader_ok(&reader) ? TSR_ERR_VERSION : TSR_ERR_SIZE;
    }
    struct tsr_rectify_table found;
    uint16_t reserved = 0;
    read_header(&found, &reader, &reserved);
    if (!tsr_reader_ok(&reader) || !has_sizes(&found) ||
        len != TSR_RECTIFY_TABLE_LEN(found.width, found.height, found.step_log2)) {
        return TSR_ERR_SIZE;
    }
    if (!has_crc(bytes, len) || reserved != 0 || found.focal_q16 == 0 || found.baseline_q16 == 0) {
        return TSR_ERR_FORMAT;
    }
    size_t grid_len = (len - TSR_RECTIFY_HEADER_LEN - TSR_RECTIFY_CRC_LEN) / 2u;
    found.grid[TSR_RECTIFY_LEFT] = bytes + TSR_RECTIFY_HEADER_LEN;
    found.grid[TSR_RECTIFY_RIGHT] = bytes + TSR_RECTIFY_HEADER_LEN + grid_len;
    for (unsigned side = 0; side < 2; side++) {
        if (found.rows_above[side] != tsr_rectify_measure_rows_above(&found, (enum tsr_rectify_side)side)) {
            return TSR_ERR_FORMAT;
        }
    }
    *table = found;
    return TSR_OK;
}
