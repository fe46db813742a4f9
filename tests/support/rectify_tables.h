/*
 * Small rectification tables made in the test, without the host's fit: a spline
 * whose control points lie on a plane is that plane.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_RECTIFY_TABLES_H
#define TSR_TEST_RECTIFY_TABLES_H

#include <stdint.h>
#include <string.h>

#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"
#include "tsr/vision/rectify.h"

struct table_plan {
    uint16_t width;
    uint16_t height;
    uint16_t source_width;
    uint16_t source_height;
    uint8_t step_log2;
    int32_t shift_q6[2][2]; /* by side and axis, px, Q10.6 */
    int32_t stretch_q6[2];  /* by axis: source px per target px; 64 = 1 */
    uint32_t wobble_q6;     /* each point is off by up to this, pseudo-random */
};

static inline void table_seal(uint8_t *bytes, size_t len)
{
    const unsigned crc = tsr_crc16(TSR_CRC16_START_HDLC, bytes, len - TSR_RECTIFY_CRC_LEN) ^ 0xffffu;
    bytes[len - 2u] = (uint8_t)crc;
    bytes[len - 1u] = (uint8_t)(crc >> 8);
}

static inline int32_t table_noise(uint32_t *state, uint32_t amplitude)
{
    *state = *state * 1664525u + 1013904223u;
    return (int32_t)((*state >> 8) % (2u * amplitude + 1u)) - (int32_t)amplitude;
}

/* The table's length; bytes has room for it. */
static inline size_t table_make(const struct table_plan *plan, uint8_t *bytes)
{
    const size_t len = TSR_RECTIFY_TABLE_LEN(plan->width, plan->height, plan->step_log2);
    struct tsr_writer writer = tsr_writer_make(bytes, len);
    const uint8_t magic[] = {'T', 'S', 'R', 'M'};
    tsr_write_span(&writer, magic, sizeof magic);
    tsr_write_u8(&writer, TSR_RECTIFY_VERSION);
    tsr_write_u8(&writer, plan->step_log2);
    tsr_write_u16(&writer, plan->width);
    tsr_write_u16(&writer, plan->height);
    tsr_write_u16(&writer, plan->source_width);
    tsr_write_u16(&writer, plan->source_height);
    tsr_write_u32(&writer, 0); /* rows above, below */
    tsr_write_u16(&writer, (uint16_t)-24);
    tsr_write_u16(&writer, 0);
    tsr_write_u32(&writer, 240u << 16);
    tsr_write_u32(&writer, 60u << 16);
    tsr_write_u32(&writer, 80u << 16);
    tsr_write_u32(&writer, 60u << 16);
    struct tsr_rectify_table table = {.width = plan->width,
                                      .height = plan->height,
                                      .source_width = plan->source_width,
                                      .source_height = plan->source_height,
                                      .step_log2 = plan->step_log2};
    uint32_t noise = 1;
    for (unsigned side = 0; side < 2; side++) {
        table.grid[side] = bytes + writer.at;
        for (size_t j = 0; j < TSR_RECTIFY_POINTS(plan->height, plan->step_log2); j++) {
            for (size_t i = 0; i < TSR_RECTIFY_POINTS(plan->width, plan->step_log2); i++) {
                const int32_t step = 1 << plan->step_log2;
                const int32_t at[2] = {((int32_t)i - 1) * step, ((int32_t)j - 1) * step};
                const int32_t middle[2] = {plan->source_width / 2, plan->source_height / 2};
                for (unsigned axis = 0; axis < 2; axis++) {
                    const int32_t point = at[axis] * plan->stretch_q6[axis] - 64 * middle[axis] +
                                          plan->shift_q6[side][axis] + table_noise(&noise, plan->wobble_q6);
                    tsr_write_u16(&writer, (uint16_t)point);
                }
            }
        }
        const uint16_t rows_above = tsr_rectify_measure_rows_above(&table, (enum tsr_rectify_side)side);
        bytes[14u + 2u * side] = (uint8_t)rows_above;
        bytes[15u + 2u * side] = (uint8_t)(rows_above >> 8);
    }
    table_seal(bytes, len);
    return len;
}

#endif
