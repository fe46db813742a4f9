/* Binary little-endian PLY. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr std::string_view kBeforeCount = "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex ";
constexpr std::string_view kAfterCount = "\nproperty float x\nproperty float y\nproperty float z\n"
                                         "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
constexpr std::size_t kHeaderLenMax = 256;
constexpr std::size_t kPointLen = 15;

std::string header_of(std::size_t count)
{
    return std::string(kBeforeCount) + std::to_string(count) + std::string(kAfterCount);
}

void append_float(std::vector<std::uint8_t> &bytes, float value)
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
}

float float_at(const std::uint8_t *bytes)
{
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; ++i) {
        bits |= std::uint32_t{bytes[i]} << 8 * i;
    }
    return std::bit_cast<float>(bits);
}

/* The number of points of a file that begins so and is so long. */
std::size_t count_of(const std::filesystem::path &file, std::string_view start, std::uintmax_t len)
{
    std::size_t count = 0;
    const std::size_t digits = std::min(start.size(), kBeforeCount.size());
    std::from_chars(start.data() + digits, start.data() + start.size(), count);
    const std::string header = header_of(count);
    if (!start.starts_with(header)) {
        throw InputError(file.string(), "header", "is not that of a cloud of the sink");
    }
    if ((len - header.size()) % kPointLen != 0 || (len - header.size()) / kPointLen != count) {
        throw InputError(file.string(), "size", "does not fit the number of points, " + std::to_string(count));
    }
    return count;
}

} // namespace

PlyWriter::PlyWriter(const std::filesystem::path &file, std::size_t count) : out_(file), missing_(count)
{
    const std::string header = header_of(count);
    out_.write({reinterpret_cast<const std::uint8_t *>(header.data()), header.size()});
}

void PlyWriter::add(std::span<const CloudPoint> points)
{
    if (points.size() > missing_) {
        throw std::logic_error("PlyWriter: more points than the header says");
    }
    missing_ -= points.size();
    bytes_.clear();
    bytes_.reserve(kPointLen * points.size());
    for (const CloudPoint &point : points) {
        append_float(bytes_, point.x_m);
        append_float(bytes_, point.y_m);
        append_float(bytes_, point.z_m);
        bytes_.push_back(point.red);
        bytes_.push_back(point.green);
        bytes_.push_back(point.blue);
    }
    out_.write(bytes_);
}

void PlyWriter::complete()
{
    if (missing_ != 0) {
        throw std::logic_error("PlyWriter: fewer points than the header says");
    }
    out_.complete();
}

PlySample sample_ply(const std::filesystem::path &file, std::size_t most)
{
    std::ifstream in;
    in.rdbuf()->pubsetbuf(nullptr, 0); /* points lie far apart: nothing is read beside them */
    in.open(file, std::ios::binary);
    std::error_code error;
    const std::uintmax_t len = std::filesystem::file_size(file, error);
    if (!in || error) {
        throw InputError(file.string(), "", "cannot be read");
    }
    std::string start(std::min<std::uintmax_t>(len, kHeaderLenMax), '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    PlySample sample;
    sample.of = count_of(file, start, len);
    sample.points.resize(std::min(sample.of, most));
    const std::size_t first = header_of(sample.of).size();
    std::array<std::uint8_t, kPointLen> bytes{};
    for (std::size_t i = 0; i < sample.points.size(); ++i) {
        const std::size_t index = i * sample.of / sample.points.size();
        in.seekg(static_cast<std::streamoff>(first + index * kPointLen));
        in.read(reinterpret_cast<char *>(bytes.data()), bytes.size());
        sample.points[i] = {float_at(bytes.data()),
                            float_at(bytes.data() + 4),
                            float_at(bytes.data() + 8),
                            bytes[12],
                            bytes[13],
                            bytes[14]};
    }
    if (!in) {
        throw InputError(file.string(), "", "cannot be read");
    }
    return sample;
}

} // namespace tsr
