/*
 * PFM and 16-bit PNG.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/stereo/disparity_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

constexpr int kPngMax = 65535;
constexpr std::array<std::uint8_t, 4> kPngMagic = {0x89, 'P', 'N', 'G'};

FloatImage float_of_png(const GrayImage16 &image)
{
    FloatImage map{image.width, image.height, std::vector<float>(image.pixels.size(), kFloatInvalid)};
    for (std::size_t i = 0; i < map.pixels.size(); i++) {
        if (image.pixels[i] != 0) {
            map.pixels[i] = static_cast<float>(image.pixels[i]) / kDisparityPngScale;
        }
    }
    return map;
}

GrayImage16 png_of_float(const FloatImage &map)
{
    GrayImage16 image{map.width, map.height, kPngMax, std::vector<std::uint16_t>(map.pixels.size(), 0)};
    for (std::size_t i = 0; i < image.pixels.size(); i++) {
        if (std::isfinite(map.pixels[i])) {
            const long value = std::lround(kDisparityPngScale * static_cast<double>(map.pixels[i]));
            if (value < 0 || value > kPngMax) {
                throw std::invalid_argument("a disparity outside 0 .. 256 px does not fit a PNG");
            }
            image.pixels[i] = static_cast<std::uint16_t>(std::max(value, 1L));
        }
    }
    return image;
}

} // namespace

DisparityFormat disparity_format(const std::filesystem::path &file, const char *field)
{
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending != ".pfm" && ending != ".png") {
        throw InputError(file.string(), field, "the name ends in neither .pfm nor .png");
    }
    return ending == ".pfm" ? DisparityFormat::kPfm : DisparityFormat::kPng;
}

FloatImage read_disparity_file(const std::filesystem::path &file)
{
    const std::vector<std::uint8_t> bytes = read_file(file);
    if (bytes.size() >= 2 && bytes[0] == 'P' && (bytes[1] == 'f' || bytes[1] == 'F')) {
        return decode_pfm(bytes, file);
    }
    if (bytes.size() < kPngMagic.size() || !std::equal(kPngMagic.begin(), kPngMagic.end(), bytes.begin())) {
        throw InputError(file.string(), "magic", "not a PFM (Pf) or PNG");
    }
    const GrayImage16 image = decode_gray16_image(bytes, file);
    if (image.max_value != kPngMax) {
        throw InputError(file.string(), "depth", "8 bits; a PNG of disparities has 16 (px = value / 256)");
    }
    return float_of_png(image);
}

void write_disparity_file(const std::filesystem::path &file, const FloatImage &map)
{
    if (disparity_format(file, "format") == DisparityFormat::kPfm) {
        write_pfm(file, map);
    } else {
        write_png(file, png_of_float(map));
    }
}

} // namespace tsr
