/*
 * Image files: PGM, PNG and JPEG in and out.
 *
 * The format is told by the file's first bytes, never by its name. Colour
 * becomes gray by ITU-R BT.601 luma on the stored (gamma-coded) values,
 *
 *   Y = (77 R + 150 G + 29 B + 128) / 256      (JPEG: the coded Y, same weights)
 *
 * and a file of maximum value m becomes 8-bit by (255 v + m / 2) / m, both
 * rounded down after the stated offset. Alpha is ignored. A truncated file, a
 * header that does not fit its data and a value above the stated maximum are
 * refused with InputError; outputs appear complete or not at all.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_IMAGE_FILE_H
#define TSR_HOST_IMAGE_FILE_H

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

extern "C" {
#include "tsr/base/image.h"
}

namespace tsr
{

/* Limits of a source image; the firmware's 640x480 does not apply here. */
inline constexpr std::uint32_t kImageSideMax = 65535;
inline constexpr std::uint64_t kImagePixelsMax = 64u * 1024u * 1024u;

struct ImageSize {
    int width = 0;
    int height = 0;
    bool operator==(const ImageSize &) const = default;
};

/* Row-major without padding: pixels[y * width + x], as in tsr/base/image.h. */
struct GrayImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;

    ImageSize size() const { return {width, height}; }
    tsr_gray_view view() const
    {
        const auto stride = static_cast<std::uint16_t>(width);
        return {pixels.data(), stride, static_cast<std::uint16_t>(height), stride};
    }
};

/* Values as the file stores them, not scaled (depth and disparity PNGs). */
struct GrayImage16 {
    int width = 0;
    int height = 0;
    std::uint16_t max_value = 65535; /* 255 for an 8-bit file */
    std::vector<std::uint16_t> pixels;
};

/* pixels[3 * (y * width + x)] is red, then green, then blue. */
struct RgbImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
};

/* Width and height as the header claims; the pixels are not looked at. */
ImageSize read_image_size(const std::filesystem::path &file);
GrayImage read_gray_image(const std::filesystem::path &file);
/* PGM, or PNG of gray type; colour is refused because raw values have no luma. */
GrayImage16 read_gray16_image(const std::filesystem::path &file);
/* The same reader on bytes in memory; name stands for the file in errors. */
GrayImage decode_gray_image(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);
GrayImage16 decode_gray16_image(std::span<const std::uint8_t> bytes, const std::filesystem::path &name);

/* Binary PGM (P5), maximum value 255. */
void write_pgm(const std::filesystem::path &file, tsr_gray_view image);
/* PNG without time stamps: equal pixels give equal bytes. */
void write_png(const std::filesystem::path &file, tsr_gray_view image);
void write_png(const std::filesystem::path &file, const GrayImage16 &image);
void write_png(const std::filesystem::path &file, const RgbImage &image);
/* A whole JFIF file: baseline, integer DCT (JDCT_ISLOW), the usual Huffman tables; quality 1 .. 100 as libjpeg counts.
 */
std::vector<std::uint8_t> encode_jpeg(tsr_gray_view image, int quality);

} // namespace tsr

#endif
