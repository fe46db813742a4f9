/*
 * Any bytes as two coded views, the second against the first if it says so:
 * decode, and what decodes must survive being coded again.
 *
 *   bytes 0..1   length of the first view, 16 bits, little-endian; the second is the rest
 *
 *   tools/fuzz codec_view
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/codec/view.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define VIEW_PIXELS_MAX 4096u
#define VIEW_ROWS_MAX 32u /* of a larger view: enough to try its width, and quick */
#define VIEW_TILES_MAX TSR_VIEW_TILE_COUNT(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)

static uint8_t fuzz_view[VIEW_PIXELS_MAX];
static uint8_t fuzz_view_again[VIEW_PIXELS_MAX];
static uint8_t fuzz_view_scratch[TSR_VIEW_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];
static uint8_t fuzz_view_out[TSR_VIEW_ENCODED_LEN_MAX(VIEW_PIXELS_MAX, 8)];
static uint8_t fuzz_view_tiles[VIEW_TILES_MAX];
static uint8_t fuzz_view_packed[2][TSR_VIEW_HELD_LEN(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)];

static void require_view(int condition)
{
    if (!condition) {
        abort();
    }
}

static struct tsr_view_held hold_in(uint8_t *packed)
{
    return (struct tsr_view_held){.packed = packed, .packed_cap = sizeof fuzz_view_packed[0]};
}

/* Code what held has decoded, on its own and then against itself with some tiles. */
static void code_view_again(const struct tsr_view_held *held)
{
    static struct tsr_view_encoder encoder;
    static struct tsr_view_decoder decoder;
    static uint8_t copy[sizeof fuzz_view_packed[0]];
    struct tsr_view_info info = held->info, read;
    struct tsr_view_held sent = *held, got = hold_in(fuzz_view_packed[1]);
    sent.packed = copy;
    size_t len = 0;
    for (unsigned turn = 0; turn < 2; turn++) {
        info.against_held = turn == 1;
        require_view(tsr_view_encode_start(&encoder, &info, &sent, fuzz_view_tiles, fuzz_view_out,
                                           tsr_view_encoded_len_max(&info), fuzz_view_scratch,
                                           sizeof fuzz_view_scratch) == TSR_OK);
        require_view(tsr_view_encode_rows(&encoder, fuzz_view, info.width, info.height) == TSR_OK);
        require_view(tsr_view_encode_finish(&encoder, &len) == TSR_OK);
        require_view(tsr_view_decode_start(&decoder, fuzz_view_out, len, &got, fuzz_view_scratch,
                                           sizeof fuzz_view_scratch, &read) == TSR_OK);
        require_view(tsr_view_decode_rows(&decoder, fuzz_view_again, info.width, info.height) == TSR_OK);
        require_view(memcmp(fuzz_view, fuzz_view_again, (size_t)info.width * info.height) == 0);
        require_view(sent.check == held->check && got.check == held->check);
    }
}

static void decode_view(const uint8_t *bytes, size_t len, struct tsr_view_held *held)
{
    static struct tsr_view_decoder decoder;
    struct tsr_view_info info;
    enum tsr_status status =
        tsr_view_decode_start(&decoder, bytes, len, held, fuzz_view_scratch, sizeof fuzz_view_scratch, &info);
    if (status == TSR_ERR_NOREF) { /* let the check be right */
        held->check = (uint16_t)(bytes[6] | bytes[7] << 8);
        status = tsr_view_decode_start(&decoder, bytes, len, held, fuzz_view_scratch, sizeof fuzz_view_scratch, &info);
    }
    if (status != TSR_OK) {
        return;
    }
    const int small = (size_t)info.width * info.height <= VIEW_PIXELS_MAX;
    const unsigned row_count = small || info.height < VIEW_ROWS_MAX ? info.height : VIEW_ROWS_MAX;
    for (unsigned y = 0; y < row_count; y++) {
        uint8_t *row = small ? fuzz_view + (size_t)y * info.width : fuzz_view;
        status = tsr_view_decode_rows(&decoder, row, info.width, 1);
        require_view(status == (y + 1u < info.height ? TSR_AGAIN : TSR_OK));
        for (unsigned x = 0; x < info.width; x++) {
            require_view(row[x] <= 2 * info.cap);
        }
    }
    require_view(held->full == (row_count == info.height));
    if (small) {
        const size_t tiles = TSR_VIEW_TILE_COUNT(info.width, info.height);
        for (size_t i = 0; i < tiles; i++) {
            fuzz_view_tiles[i] = bytes[i % len] & 1u;
        }
        code_view_again(held);
        struct tsr_view_change change = {.tiles = fuzz_view_tiles, .tiles_cap = tiles};
        require_view(tsr_view_compare(held, fuzz_view, info.width, 0, info.height, &change) == TSR_OK);
        require_view(tsr_view_choose(&change, tiles, 0) == 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    struct tsr_view_held held = hold_in(fuzz_view_packed[0]);
    if (len < 2) {
        return 0;
    }
    size_t first_len = (size_t)(bytes[0] | bytes[1] << 8);
    first_len = first_len < len - 2u ? first_len : len - 2u;
    decode_view(bytes + 2, first_len, &held);
    decode_view(bytes + 2 + first_len, len - 2u - first_len, &held);
    return 0;
}
