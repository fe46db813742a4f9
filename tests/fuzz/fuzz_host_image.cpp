/*
 * Any bytes as an image or float image: read or refused, never a crash.
 *
 *   tools/fuzz host_image
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/pfm.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *bytes, std::size_t len);

int LLVMFuzzerTestOneInput(const std::uint8_t *bytes, std::size_t len)
{
    try {
        const tsr::GrayImage image = tsr::decode_gray_image({bytes, len}, "input");
        if (image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
            std::abort();
        }
    } catch (const tsr::InputError &) {
    }
    try {
        tsr::decode_gray16_image({bytes, len}, "input");
    } catch (const tsr::InputError &) {
    }
    try {
        tsr::decode_pfm({bytes, len}, "input");
    } catch (const tsr::InputError &) {
    }
    return 0;
}
