/*
 * Any bytes as a coded disparity map: decode, check every value, and what
 * decodes must survive being coded again.
 *
 *   tools/fuzz codec_map
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/codec/map.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define MAP_PIXELS_MAX 4096u
#define MAP_ROWS_MAX 32u /* of a larger map: enough to try its width, and quick */
#define REFERENCE_PIXELS_MAX (TSR_IMAGE_WIDTH_MAX * (MAP_ROWS_MAX + 1u))

static uint16_t fuzz_map[MAP_PIXELS_MAX];
static uint16_t fuzz_map_again[MAP_PIXELS_MAX];
static uint16_t fuzz_map_reference[REFERENCE_PIXELS_MAX];
static uint16_t fuzz_map_scratch[TSR_MAP_SCRATCH_COUNT(TSR_IMAGE_WIDTH_MAX)];
static uint8_t fuzz_map_out[TSR_MAP_ENCODED_LEN_MAX(MAP_PIXELS_MAX, 1, 128, 0)];

static void require_map(int condition)
{
    if (!condition) {
        abort();
    }
}

static void check_map_row(const struct tsr_map_info *info, const uint16_t *row)
{
    for (unsigned x = 0; x < info->width; x++) {
        require_map(row[x] == TSR_DISPARITY_INVALID ||
                    (row[x] < info->disparities * 16u && row[x] % (1u << info->step_log2) == 0));
    }
}

static void code_map_again(const struct tsr_map_info *read_info, const struct tsr_map_reference *reference)
{
    static struct tsr_map_encoder encoder;
    static struct tsr_map_decoder decoder;
    const size_t scratch_count = sizeof fuzz_map_scratch / sizeof *fuzz_map_scratch;
    struct tsr_map_info info = *read_info, read;
    const size_t cap = tsr_map_encoded_len_max(&info);
    size_t len = 0;
    info.near = 0;
    const enum tsr_status status =
        reference != NULL ? tsr_map_encode_start_against(&encoder, &info, reference, fuzz_map_out, cap,
                                                         fuzz_map_scratch, scratch_count)
                          : tsr_map_encode_start(&encoder, &info, fuzz_map_out, cap, fuzz_map_scratch, scratch_count);
    require_map(status == TSR_OK);
    require_map(tsr_map_encode_rows(&encoder, fuzz_map, info.width, info.height) == TSR_OK);
    require_map(tsr_map_encode_finish(&encoder, &len) == TSR_OK);
    require_map(tsr_map_decode_start(&decoder, fuzz_map_out, len, reference, fuzz_map_scratch, scratch_count, &read) ==
                TSR_OK);
    require_map(tsr_map_decode_rows(&decoder, fuzz_map_again, info.width, info.height) == TSR_OK);
    require_map(memcmp(fuzz_map, fuzz_map_again, (size_t)info.width * info.height * sizeof *fuzz_map) == 0);
}

/* The reference that the bytes name: their own bytes over and over, with the last one as a shift. */
static struct tsr_map_reference make_reference(const struct tsr_map_info *info, const uint8_t *bytes, size_t len)
{
    const size_t rows = info->height < MAP_ROWS_MAX + 1u ? info->height : MAP_ROWS_MAX + 1u;
    const size_t pixels = info->width * rows;
    for (size_t i = 0; i < pixels && i < REFERENCE_PIXELS_MAX; i++) {
        fuzz_map_reference[i] = (uint16_t)((unsigned)bytes[i / 7u % len] << (bytes[len - 1u] % 9u));
    }
    return (struct tsr_map_reference){fuzz_map_reference, info->width, info->reference_id};
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    static struct tsr_map_decoder decoder;
    const size_t scratch_count = sizeof fuzz_map_scratch / sizeof *fuzz_map_scratch;
    struct tsr_map_info info;
    if (tsr_map_read_info(bytes, len, &info) != TSR_OK) {
        return 0;
    }
    const int small =
        (size_t)info.width * info.height <= MAP_PIXELS_MAX && (!info.has_reference || info.height <= MAP_ROWS_MAX);
    const unsigned row_count = small || info.height < MAP_ROWS_MAX ? info.height : MAP_ROWS_MAX;
    const struct tsr_map_reference made = make_reference(&info, bytes, len);
    const struct tsr_map_reference *reference = info.has_reference ? &made : NULL;
    require_map(tsr_map_decode_start(&decoder, bytes, len, reference, fuzz_map_scratch, scratch_count, &info) ==
                TSR_OK);
    enum tsr_status status = TSR_AGAIN;
    for (unsigned y = 0; y < row_count && status >= 0; y++) {
        uint16_t *row = small ? fuzz_map + (size_t)y * info.width : fuzz_map;
        status = tsr_map_decode_rows(&decoder, row, info.width, 1);
        require_map(status == TSR_ERR_FORMAT || status == (y + 1u < info.height ? TSR_AGAIN : TSR_OK));
        check_map_row(&info, row);
    }
    if (small && status == TSR_OK) {
        code_map_again(&info, reference);
    }
    return 0;
}
