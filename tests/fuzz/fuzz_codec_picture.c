/*
 * Any bytes as a coded picture: decode, and what decodes must survive being coded
 * again, with and without a target.
 *
 *   tools/fuzz codec_picture
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "tsr/codec/picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define PICTURE_PIXELS_MAX 4096u
#define PICTURE_ROWS_MAX 32u /* of a larger picture: enough to try its width, and quick */

static uint8_t fuzz_picture[PICTURE_PIXELS_MAX];
static uint8_t fuzz_picture_again[PICTURE_PIXELS_MAX];
static uint8_t fuzz_picture_scratch[TSR_PICTURE_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];
static uint8_t fuzz_picture_out[TSR_PICTURE_ENCODED_LEN_MAX(TSR_IMAGE_WIDTH_MAX, 16)];

static void require_picture(int condition)
{
    if (!condition) {
        abort();
    }
}

static void code_picture_again(const struct tsr_picture_info *info, uint32_t target_len)
{
    static struct tsr_picture_encoder encoder;
    static struct tsr_picture_decoder decoder;
    struct tsr_picture_info read;
    size_t len = 0;
    const size_t cap = tsr_picture_encoded_len_max(info);
    require_picture(cap <= sizeof fuzz_picture_out);
    require_picture(tsr_picture_encode_start(&encoder, info, target_len, fuzz_picture_out, cap, fuzz_picture_scratch,
                                             sizeof fuzz_picture_scratch) == TSR_OK);
    require_picture(tsr_picture_encode_rows(&encoder, fuzz_picture, info->width, info->height) == TSR_OK);
    require_picture(tsr_picture_encode_finish(&encoder, &len) == TSR_OK);
    require_picture(tsr_picture_decode_start(&decoder, fuzz_picture_out, len, fuzz_picture_scratch,
                                             sizeof fuzz_picture_scratch, &read) == TSR_OK);
    require_picture(tsr_picture_decode_rows(&decoder, fuzz_picture_again, info->width, info->height) == TSR_OK);
    require_picture(read.width == info->width && read.height == info->height && read.step == info->step);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    static struct tsr_picture_decoder decoder;
    struct tsr_picture_info info;
    if (tsr_picture_decode_start(&decoder, bytes, len, fuzz_picture_scratch, sizeof fuzz_picture_scratch, &info) !=
        TSR_OK) {
        return 0;
    }
    const int small = (size_t)info.width * info.height <= PICTURE_PIXELS_MAX;
    const unsigned row_count = small || info.height < PICTURE_ROWS_MAX ? info.height : PICTURE_ROWS_MAX;
    enum tsr_status status = TSR_AGAIN;
    for (unsigned y = 0; y < row_count; y++) {
        uint8_t *row = small ? fuzz_picture + (size_t)y * info.width : fuzz_picture;
        status = tsr_picture_decode_rows(&decoder, row, info.width, 1);
        require_picture(status == (y + 1u < info.height ? TSR_AGAIN : TSR_OK));
    }
    if (small && status == TSR_OK) {
        code_picture_again(&info, 0);
        code_picture_again(&info, (uint32_t)len);
    }
    return 0;
}
