/*
 * PNG and JPEG behind image_file.h: the two libraries that report errors by
 * longjmp() stay in their own files.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_IMAGE_CODECS_H
#define TSR_HOST_IMAGE_CODECS_H

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "tsr/host/image_file.h"

namespace tsr
{

/* Refuses sides and areas beyond the limits of image_file.h. */
ImageSize checked_size(std::uint64_t width, std::uint64_t height, const std::filesystem::path &name);

struct PngPixels {
    ImageSize size;
    int channels = 1; /* 1 gray, 3 red green blue */
    int depth = 8;    /* bits a sample: 8 or 16 (big-endian, as PNG stores them) */
    std::vector<std::uint8_t> bytes;
};

bool is_png(std::span<const std::uint8_t> bytes);
ImageSize png_size(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);
PngPixels decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);
std::vector<std::uint8_t> encode_png(const PngPixels &image);

bool is_jpeg(std::span<const std::uint8_t> bytes);
ImageSize jpeg_size(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);
GrayImage decode_jpeg(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);

} // namespace tsr

#endif
