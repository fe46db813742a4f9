/*
 * Any bytes as a gray image against the one that they name: decode, with what is held equal to what was decoded.
 *
 *   tools/fuzz codec_gray_history
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/codec/gray_history.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define HISTORY_PIXELS_MAX 4096u
#define HISTORY_HELD 0x37

static uint8_t fuzz_history_image[HISTORY_PIXELS_MAX];
static uint8_t fuzz_history_held[HISTORY_PIXELS_MAX];
static uint8_t fuzz_history_scratch[TSR_GRAY_HISTORY_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];

static void require_history(int condition)
{
    if (!condition) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    static struct tsr_gray_history_decoder decoder;
    struct tsr_gray_history_info info;
    if (tsr_gray_history_read_info(bytes, len, &info) != TSR_OK) {
        return 0;
    }
    struct tsr_gray_held held = {.pixels = fuzz_history_held,
                                 .pixels_cap = sizeof fuzz_history_held,
                                 .width = info.width,
                                 .height = info.height,
                                 .check = info.against_held ? (uint16_t)(bytes[6] | bytes[7] << 8) : 0,
                                 .full = true};
    memset(fuzz_history_held, HISTORY_HELD, sizeof fuzz_history_held);
    const size_t pixels = (size_t)info.width * info.height;
    const enum tsr_status status = tsr_gray_history_decode_start(&decoder, bytes, len, &held, fuzz_history_scratch,
                                                                 sizeof fuzz_history_scratch, &info);
    require_history(status == (pixels <= HISTORY_PIXELS_MAX ? TSR_OK : TSR_ERR_NOBUF));
    if (status != TSR_OK) {
        return 0;
    }
    require_history(!held.full);
    require_history(tsr_gray_history_decode_rows(&decoder, fuzz_history_image, info.width, info.height) == TSR_OK);
    require_history(held.full && memcmp(fuzz_history_image, fuzz_history_held, pixels) == 0);
    return 0;
}
