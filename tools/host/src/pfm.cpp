/* PFM in and out. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/pfm.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "netpbm_header.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

extern "C" {
#include "tsr/base/disparity.h"
}

namespace tsr
{
namespace
{

float float_at(const std::uint8_t *bytes, bool little_endian)
{
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; i++) {
        bits |= static_cast<std::uint32_t>(bytes[i]) << (8 * (little_endian ? i : 3 - i));
    }
    return std::bit_cast<float>(bits);
}

/* strtod follows the locale; the sites this runs at use "C" because no main() calls setlocale(). */
double read_scale(NetpbmHeader &header)
{
    const std::string text = header.token("scale");
    char *end = nullptr;
    const double scale = std::strtod(text.c_str(), &end);
    if (end != text.c_str() + text.size() || !std::isfinite(scale) || scale == 0.0) {
        header.refuse("scale", "'" + text + "' is not a number other than 0");
    }
    return scale;
}

} // namespace

FloatImage decode_pfm(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    if (bytes.size() < 2 || bytes[0] != 'P' || bytes[1] != 'f') {
        throw InputError(name.string(), "magic", "not a gray PFM (Pf)");
    }
    NetpbmHeader header(bytes, name);
    const std::uint32_t width = header.number("width", 1, kImageSideMax);
    const std::uint32_t height = header.number("height", 1, kImageSideMax);
    const double scale = read_scale(header);
    const auto data = header.data();
    const std::uint64_t count = std::uint64_t{width} * height;
    if (count > kImagePixelsMax) {
        header.refuse("size", std::to_string(count) + " pixels, at most " + std::to_string(kImagePixelsMax));
    }
    if (data.size() != 4 * count) {
        header.refuse("pixels",
                      std::to_string(data.size()) + " bytes, the header promises " + std::to_string(4 * count));
    }
    FloatImage image{static_cast<int>(width), static_cast<int>(height), std::vector<float>(count)};
    for (std::size_t y = 0; y < height; y++) {
        const std::uint8_t *row = data.data() + 4 * (height - 1 - y) * width;
        for (std::size_t x = 0; x < width; x++) {
            const float value = float_at(row + 4 * x, scale < 0.0);
            image.pixels[y * width + x] = std::isfinite(value) ? value : kFloatInvalid;
        }
    }
    return image;
}

FloatImage read_pfm(const std::filesystem::path &file)
{
    return decode_pfm(read_file(file), file);
}

void write_pfm(const std::filesystem::path &file, const FloatImage &image)
{
    const auto width = static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    if (image.pixels.size() != width * height) {
        throw std::invalid_argument("write_pfm: the image does not hold width * height values");
    }
    const std::string header = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    bytes.reserve(header.size() + 4 * width * height);
    for (std::size_t y = height; y-- > 0;) {
        for (std::size_t x = 0; x < width; x++) {
            const auto bits = std::bit_cast<std::uint32_t>(image.pixels[y * width + x]);
            for (unsigned shift = 0; shift < 32; shift += 8) {
                bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
            }
        }
    }
    write_file_atomically(file, bytes);
}

FloatImage float_disparity(std::span<const std::uint16_t> disparity_q4, int width, int height)
{
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (disparity_q4.size() != count) {
        throw std::invalid_argument("float_disparity: the map does not hold width * height values");
    }
    FloatImage image{width, height, std::vector<float>(count, kFloatInvalid)};
    for (std::size_t i = 0; i < count; i++) {
        if (disparity_q4[i] != TSR_DISPARITY_INVALID) {
            image.pixels[i] = static_cast<float>(disparity_q4[i]) / TSR_DISPARITY_ONE_Q4;
        }
    }
    return image;
}

} // namespace tsr
