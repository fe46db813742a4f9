/*
 * Any bytes as a coded gray image: decode, and what decodes must survive being
 * coded again, within near.
 *
 *   tools/fuzz codec_gray
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "tsr/codec/gray.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define GRAY_PIXELS_MAX 4096u
#define GRAY_ROWS_MAX 32u /* of a larger image: enough to try its width, and quick */

static uint8_t fuzz_gray[GRAY_PIXELS_MAX];
static uint8_t fuzz_gray_again[GRAY_PIXELS_MAX];
static uint8_t fuzz_gray_scratch[TSR_GRAY_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];
static uint8_t fuzz_gray_out[TSR_GRAY_ENCODED_LEN_MAX(GRAY_PIXELS_MAX, 1)];

static void require_gray(int condition)
{
    if (!condition) {
        abort();
    }
}

static void code_gray_again(const struct tsr_gray_info *info)
{
    static struct tsr_gray_encoder encoder;
    static struct tsr_gray_decoder decoder;
    struct tsr_gray_info read;
    size_t len = 0;
    require_gray(tsr_gray_encode_start(&encoder, info, fuzz_gray_out, tsr_gray_encoded_len_max(info), fuzz_gray_scratch,
                                       sizeof fuzz_gray_scratch) == TSR_OK);
    require_gray(tsr_gray_encode_rows(&encoder, fuzz_gray, info->width, info->height) == TSR_OK);
    require_gray(tsr_gray_encode_finish(&encoder, &len) == TSR_OK);
    require_gray(tsr_gray_decode_start(&decoder, fuzz_gray_out, len, fuzz_gray_scratch, sizeof fuzz_gray_scratch,
                                       &read) == TSR_OK);
    require_gray(tsr_gray_decode_rows(&decoder, fuzz_gray_again, info->width, info->height) == TSR_OK);
    for (size_t i = 0; i < (size_t)info->width * info->height; i++) {
        require_gray(abs((int)fuzz_gray[i] - (int)fuzz_gray_again[i]) <= info->near); /* by activity: 4, below its 8 */
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    static struct tsr_gray_decoder decoder;
    struct tsr_gray_info info;
    if (tsr_gray_decode_start(&decoder, bytes, len, fuzz_gray_scratch, sizeof fuzz_gray_scratch, &info) != TSR_OK) {
        return 0;
    }
    const int small = (size_t)info.width * info.height <= GRAY_PIXELS_MAX;
    const unsigned row_count = small || info.height < GRAY_ROWS_MAX ? info.height : GRAY_ROWS_MAX;
    enum tsr_status status = TSR_AGAIN;
    for (unsigned y = 0; y < row_count; y++) {
        uint8_t *row = small ? fuzz_gray + (size_t)y * info.width : fuzz_gray;
        status = tsr_gray_decode_rows(&decoder, row, info.width, 1);
        require_gray(status == (y + 1u < info.height ? TSR_AGAIN : TSR_OK));
    }
    if (small && status == TSR_OK) {
        code_gray_again(&info);
    }
    return 0;
}
