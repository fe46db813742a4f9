/*
 * Before a harness of one coded image: inputs whose header, with width and
 * height at WIDTH_AT, announces more than 256 pixels are turned down. The
 * harness is compiled as fuzz_any_image().
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>

int fuzz_any_image(const uint8_t *bytes, size_t len);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define PIXELS_MAX 256u

static uint32_t u16_at(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    if (len >= WIDTH_AT + 4u && u16_at(bytes + WIDTH_AT) * u16_at(bytes + WIDTH_AT + 2u) > PIXELS_MAX) {
        return -1; /* not for the corpus */
    }
    return fuzz_any_image(bytes, len);
}
