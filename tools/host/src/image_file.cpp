/* PGM, and the way from every format to gray. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/image_file.h"

#include <stdexcept>
#include <string>

#include "image_codecs.h"
#include "netpbm_header.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

bool is_pgm(std::span<const std::uint8_t> bytes)
{
    return bytes.size() >= 2 && bytes[0] == 'P' && bytes[1] == '5';
}

[[noreturn]] void refuse_format(const std::filesystem::path &name)
{
    throw InputError(name.string(), "magic", "not a binary PGM (P5), PNG or JPEG");
}

ImageSize pgm_size(NetpbmHeader &header, const std::filesystem::path &name)
{
    const std::uint32_t width = header.number("width", 1, kImageSideMax);
    const std::uint32_t height = header.number("height", 1, kImageSideMax);
    return checked_size(width, height, name);
}

GrayImage16 decode_pgm(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    NetpbmHeader header(bytes, name);
    const ImageSize size = pgm_size(header, name);
    const std::uint32_t max_value = header.number("maximum", 1, 65535);
    const auto data = header.data();
    const std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    const std::size_t sample_len = max_value > 255 ? 2 : 1;
    if (data.size() != count * sample_len) {
        throw InputError(name.string(), "pixels",
                         std::to_string(data.size()) + " bytes, the header promises " +
                             std::to_string(count * sample_len));
    }
    GrayImage16 image{size.width, size.height, static_cast<std::uint16_t>(max_value), {}};
    image.pixels.resize(count);
    for (std::size_t i = 0; i < count; i++) {
        const unsigned value = sample_len == 1 ? data[i] : (data[2 * i] << 8 | data[2 * i + 1]);
        if (value > max_value) {
            throw InputError(name.string(), "pixels",
                             "the value " + std::to_string(value) + " is above the maximum " +
                                 std::to_string(max_value));
        }
        image.pixels[i] = static_cast<std::uint16_t>(value);
    }
    return image;
}

GrayImage eight_bit(const GrayImage16 &image)
{
    GrayImage gray{image.width, image.height, std::vector<std::uint8_t>(image.pixels.size())};
    const std::uint32_t max_value = image.max_value;
    for (std::size_t i = 0; i < gray.pixels.size(); i++) {
        gray.pixels[i] = static_cast<std::uint8_t>((255u * image.pixels[i] + max_value / 2) / max_value);
    }
    return gray;
}

/* Gray samples as stored, or the luma of colour ones. */
GrayImage16 gray_of_png(const PngPixels &png)
{
    const auto channels = static_cast<std::size_t>(png.channels);
    const bool wide = png.depth == 16;
    GrayImage16 image{png.size.width, png.size.height, static_cast<std::uint16_t>(wide ? 65535 : 255), {}};
    image.pixels.resize(static_cast<std::size_t>(png.size.width) * static_cast<std::size_t>(png.size.height));
    const auto sample = [&](std::size_t i) -> std::uint32_t {
        return wide ? static_cast<std::uint32_t>(png.bytes[2 * i] << 8 | png.bytes[2 * i + 1]) : png.bytes[i];
    };
    for (std::size_t i = 0; i < image.pixels.size(); i++) {
        const std::size_t first = channels * i;
        const std::uint32_t value =
            channels == 1 ? sample(first)
                          : (77 * sample(first) + 150 * sample(first + 1) + 29 * sample(first + 2) + 128) >> 8;
        image.pixels[i] = static_cast<std::uint16_t>(value);
    }
    return image;
}

void check_shape(int width, int height, std::size_t samples, std::size_t channels)
{
    if (width < 1 || height < 1 ||
        samples != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels) {
        throw std::invalid_argument("an image to be written does not hold width * height pixels");
    }
}

std::vector<std::uint8_t> packed(tsr_gray_view image)
{
    std::vector<std::uint8_t> bytes;
    bytes.reserve(std::size_t{image.width} * image.height);
    for (std::size_t y = 0; y < image.height; y++) {
        const std::uint8_t *row = image.pixels + y * image.stride;
        bytes.insert(bytes.end(), row, row + image.width);
    }
    return bytes;
}

} // namespace

ImageSize checked_size(std::uint64_t width, std::uint64_t height, const std::filesystem::path &name)
{
    if (width < 1 || height < 1 || width > kImageSideMax || height > kImageSideMax ||
        width * height > kImagePixelsMax) {
        throw InputError(name.string(), "size",
                         std::to_string(width) + "x" + std::to_string(height) + ", at most " +
                             std::to_string(kImageSideMax) + " a side and " + std::to_string(kImagePixelsMax) +
                             " pixels");
    }
    return {static_cast<int>(width), static_cast<int>(height)};
}

ImageSize read_image_size(const std::filesystem::path &file)
{
    const std::vector<std::uint8_t> bytes = read_file(file);
    if (is_pgm(bytes)) {
        NetpbmHeader header(bytes, file);
        return pgm_size(header, file);
    }
    if (is_png(bytes)) {
        return png_size(bytes, file);
    }
    if (is_jpeg(bytes)) {
        return jpeg_size(bytes, file);
    }
    refuse_format(file);
}

GrayImage decode_gray_image(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    if (is_pgm(bytes)) {
        return eight_bit(decode_pgm(bytes, name));
    }
    if (is_png(bytes)) {
        return eight_bit(gray_of_png(decode_png(bytes, name)));
    }
    if (is_jpeg(bytes)) {
        return decode_jpeg(bytes, name);
    }
    refuse_format(name);
}

GrayImage16 decode_gray16_image(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    if (is_pgm(bytes)) {
        return decode_pgm(bytes, name);
    }
    if (!is_png(bytes)) {
        throw InputError(name.string(), "magic", "not a binary PGM (P5) or PNG");
    }
    const PngPixels png = decode_png(bytes, name);
    if (png.channels != 1) {
        throw InputError(name.string(), "colour", "raw values need a gray PNG");
    }
    return gray_of_png(png);
}

GrayImage read_gray_image(const std::filesystem::path &file)
{
    return decode_gray_image(read_file(file), file);
}

GrayImage16 read_gray16_image(const std::filesystem::path &file)
{
    return decode_gray16_image(read_file(file), file);
}

void write_pgm(const std::filesystem::path &file, tsr_gray_view image)
{
    const std::string header = "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    const std::vector<std::uint8_t> pixels = packed(image);
    bytes.insert(bytes.end(), pixels.begin(), pixels.end());
    write_file_atomically(file, bytes);
}

void write_png(const std::filesystem::path &file, tsr_gray_view image)
{
    write_file_atomically(file, encode_png({{image.width, image.height}, 1, 8, packed(image)}));
}

void write_png(const std::filesystem::path &file, const GrayImage16 &image)
{
    check_shape(image.width, image.height, image.pixels.size(), 1);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(2 * image.pixels.size());
    for (const std::uint16_t value : image.pixels) {
        bytes.push_back(static_cast<std::uint8_t>(value >> 8));
        bytes.push_back(static_cast<std::uint8_t>(value));
    }
    write_file_atomically(file, encode_png({{image.width, image.height}, 1, 16, std::move(bytes)}));
}

void write_png(const std::filesystem::path &file, const RgbImage &image)
{
    check_shape(image.width, image.height, image.pixels.size(), 3);
    write_file_atomically(file, encode_png({{image.width, image.height}, 3, 8, image.pixels}));
}

} // namespace tsr
