/*
 * Any bytes as a rectification table: opened or refused, and what opens
 * rectifies without leaving its frames, in place as into another frame.
 *
 * The CRC would refuse nearly every mutation, so it is made anew first, and the
 * rows above are set to what the grid says when they are the one thing wrong.
 *
 *   tools/fuzz vision_rectify
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "rectify_tables.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define FUZZ_SIDE_MAX 64u /* of the views that are rectified: enough, and quick */
#define ROWS_ABOVE_AT 14u

static void require_rectify(int condition)
{
    if (!condition) {
        abort();
    }
}

/* A block of exactly len bytes, so that a sanitizer sees every overrun. */
static uint8_t *fuzz_block(size_t len, uint8_t seed)
{
    uint8_t *block = malloc(len);
    require_rectify(block != NULL);
    for (size_t i = 0; i < len; i++) {
        block[i] = (uint8_t)(seed + i * 7u + i / 5u);
    }
    return block;
}

static void rectify_both_ways(const struct tsr_rectify_table *table, enum tsr_rectify_side side)
{
    const size_t source_len = (size_t)table->source_width * table->source_height;
    const size_t target_len = (size_t)table->width * table->height;
    uint8_t *source = fuzz_block(source_len, 1);
    uint8_t *target = fuzz_block(target_len, 0);
    const struct tsr_gray_view in = {source, table->source_width, table->source_height, table->source_width};
    const struct tsr_gray out = {target, table->width, table->height, table->width};
    struct tsr_rectify rectify;
    require_rectify(tsr_rectify_start(&rectify, table, side, in, out) == TSR_OK);
    require_rectify(tsr_rectify_run(&rectify, table->height) == TSR_OK);
    if (table->width == table->source_width && table->height == table->source_height) {
        const size_t kept_len = TSR_RECTIFY_KEPT_LEN(table->width, table->rows_above[side]);
        uint8_t *kept = fuzz_block(kept_len, 9);
        const struct tsr_gray frame = {source, table->width, table->height, table->width};
        require_rectify(tsr_rectify_start_in_place(&rectify, table, side, frame, kept, kept_len) == TSR_OK);
        while (tsr_rectify_run(&rectify, 3) == TSR_AGAIN) {
        }
        require_rectify(memcmp(source, target, target_len) == 0);
        free(kept);
    }
    free(source);
    free(target);
}

static void open_and_use(const uint8_t *bytes, size_t len)
{
    struct tsr_rectify_table table;
    if (tsr_rectify_open(&table, bytes, len) != TSR_OK) {
        return;
    }
    if (table.width <= FUZZ_SIDE_MAX && table.height <= FUZZ_SIDE_MAX) {
        rectify_both_ways(&table, TSR_RECTIFY_LEFT);
        rectify_both_ways(&table, TSR_RECTIFY_RIGHT);
    }
}

static void correct_rows_above(uint8_t *bytes, size_t len)
{
    const size_t points_len = (len - TSR_RECTIFY_HEADER_LEN - TSR_RECTIFY_CRC_LEN) / 2u;
    struct tsr_rectify_table table = {
        .grid = {bytes + TSR_RECTIFY_HEADER_LEN, bytes + TSR_RECTIFY_HEADER_LEN + points_len},
        .step_log2 = bytes[5],
        .width = (uint16_t)(bytes[6] | bytes[7] << 8),
        .height = (uint16_t)(bytes[8] | bytes[9] << 8),
        .source_width = (uint16_t)(bytes[10] | bytes[11] << 8),
        .source_height = (uint16_t)(bytes[12] | bytes[13] << 8)};
    const int fits = table.step_log2 >= TSR_RECTIFY_STEP_LOG2_MIN && table.step_log2 <= TSR_RECTIFY_STEP_LOG2_MAX &&
                     table.width >= TSR_RECTIFY_SIDE_MIN && table.width <= TSR_IMAGE_WIDTH_MAX &&
                     table.height >= TSR_RECTIFY_SIDE_MIN && table.height <= TSR_IMAGE_HEIGHT_MAX &&
                     table.source_height >= TSR_RECTIFY_SIDE_MIN && table.source_height <= TSR_IMAGE_HEIGHT_MAX &&
                     table.source_width >= TSR_RECTIFY_SIDE_MIN && table.source_width <= TSR_IMAGE_WIDTH_MAX &&
                     len == TSR_RECTIFY_TABLE_LEN(table.width, table.height, table.step_log2);
    for (unsigned side = 0; fits && side < 2; side++) {
        const uint16_t rows_above = tsr_rectify_measure_rows_above(&table, (enum tsr_rectify_side)side);
        bytes[ROWS_ABOVE_AT + 2u * side] = (uint8_t)rows_above;
        bytes[ROWS_ABOVE_AT + 2u * side + 1u] = (uint8_t)(rows_above >> 8);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    open_and_use(bytes, len);
    if (len < TSR_RECTIFY_HEADER_LEN + TSR_RECTIFY_CRC_LEN) {
        return 0;
    }
    uint8_t *sealed = malloc(len);
    require_rectify(sealed != NULL);
    memcpy(sealed, bytes, len);
    table_seal(sealed, len);
    open_and_use(sealed, len);
    correct_rows_above(sealed, len);
    table_seal(sealed, len);
    open_and_use(sealed, len);
    free(sealed);
    return 0;
}
