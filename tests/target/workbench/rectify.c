/*
 * A view rectified in place, as a barrel lens asks: the table is made here.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"
#include "tsr/vision/rectify.h"
#include "workbench.h"

#define ROWS_PER_STEP 4u
#define STEP_LOG2 4u
#define ROWS_ABOVE_AT 14u
#define TABLE_CAP TSR_RECTIFY_TABLE_LEN(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX, STEP_LOG2)

static uint8_t table_bytes[TABLE_CAP];
static uint8_t frame[WORKBENCH_PIXELS_MAX];
static uint8_t kept[WORKBENCH_PIXELS_MAX];

/* Points at distance r from the middle move inward by r^2 / (W^2 + H^2) / 4 of r. */
static int32_t barrel(int32_t offset, int32_t radius2, int32_t diagonal2)
{
    return offset * 64 - (int32_t)((int64_t)offset * 16 * radius2 / diagonal2);
}

static void write_grids(const struct workbench_case *bench, struct tsr_writer *writer)
{
    const int32_t middle[2] = {bench->width / 2, bench->height / 2};
    const int32_t diagonal2 = middle[0] * middle[0] + middle[1] * middle[1];
    for (unsigned side = 0; side < 2; side++) {
        for (size_t j = 0; j < TSR_RECTIFY_POINTS(bench->height, STEP_LOG2); j++) {
            for (size_t i = 0; i < TSR_RECTIFY_POINTS(bench->width, STEP_LOG2); i++) {
                const int32_t x = ((int32_t)i - 1) * 16 - middle[0];
                const int32_t y = ((int32_t)j - 1) * 16 - middle[1];
                tsr_write_u16(writer, (uint16_t)barrel(x, x * x + y * y, diagonal2));
                tsr_write_u16(writer, (uint16_t)barrel(y, x * x + y * y, diagonal2));
            }
        }
    }
}

static size_t make_table(const struct workbench_case *bench)
{
    const size_t len = TSR_RECTIFY_TABLE_LEN(bench->width, bench->height, STEP_LOG2);
    const size_t grid_len = (len - TSR_RECTIFY_HEADER_LEN - TSR_RECTIFY_CRC_LEN) / 2u;
    struct tsr_rectify_table table = {
        .grid = {table_bytes + TSR_RECTIFY_HEADER_LEN, table_bytes + TSR_RECTIFY_HEADER_LEN + grid_len},
        .width = bench->width,
        .height = bench->height,
        .source_width = bench->width,
        .source_height = bench->height,
        .step_log2 = STEP_LOG2};
    struct tsr_writer writer = tsr_writer_make(table_bytes + TSR_RECTIFY_HEADER_LEN, len - TSR_RECTIFY_HEADER_LEN);
    write_grids(bench, &writer);
    writer = tsr_writer_make(table_bytes, TSR_RECTIFY_HEADER_LEN);
    const uint8_t magic[] = {'T', 'S', 'R', 'M', TSR_RECTIFY_VERSION, STEP_LOG2};
    tsr_write_span(&writer, magic, sizeof magic);
    for (unsigned i = 0; i < 2; i++) {
        tsr_write_u16(&writer, bench->width);
        tsr_write_u16(&writer, bench->height);
    }
    tsr_write_u16(&writer, tsr_rectify_measure_rows_above(&table, TSR_RECTIFY_LEFT));
    tsr_write_u16(&writer, tsr_rectify_measure_rows_above(&table, TSR_RECTIFY_RIGHT));
    tsr_write_u32(&writer, 0);
    for (unsigned i = 0; i < 4; i++) {
        tsr_write_u32(&writer, 1u << 16);
    }
    const unsigned crc = tsr_crc16(TSR_CRC16_START_HDLC, table_bytes, len - TSR_RECTIFY_CRC_LEN) ^ 0xffffu;
    writer = tsr_writer_make(table_bytes + len - TSR_RECTIFY_CRC_LEN, TSR_RECTIFY_CRC_LEN);
    tsr_write_u16(&writer, (uint16_t)crc);
    return len;
}

void workbench_run_rectify(const struct workbench_case *bench, const uint8_t *view)
{
    const size_t pixels = (size_t)bench->width * bench->height;
    const size_t len = make_table(bench);
    struct tsr_rectify_table table;
    struct tsr_rectify rectify;
    workbench_begin();
    enum tsr_status status = tsr_rectify_open(&table, table_bytes, len);
    workbench_end("rectify_open", pixels);
    workbench_expect(status == TSR_OK, "rectify open");
    memcpy(frame, view, pixels);
    const struct tsr_gray gray = {frame, bench->width, bench->height, bench->width};
    workbench_begin();
    status = tsr_rectify_start_in_place(&rectify, &table, TSR_RECTIFY_LEFT, gray, kept, sizeof kept);
    workbench_expect(status == TSR_OK, "rectify start");
    do {
        status = tsr_rectify_run(&rectify, ROWS_PER_STEP);
    } while (status == TSR_AGAIN);
    workbench_end("rectify", pixels);
    workbench_expect(status == TSR_OK, "rectify");
    workbench_store("rectified.out", frame, pixels);
}
