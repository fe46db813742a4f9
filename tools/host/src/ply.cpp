/* Binary little-endian PLY. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/ply.h"

#include <bit>
#include <string>
#include <vector>

#include "tsr/host/atomic_file.h"

namespace tsr
{
namespace
{

void append_float(std::vector<std::uint8_t> &bytes, float value)
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
}

} // namespace

void write_ply(const std::filesystem::path &file, std::span<const CloudPoint> points)
{
    const std::string header = "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex " +
                               std::to_string(points.size()) +
                               "\nproperty float x\nproperty float y\nproperty float z\n"
                               "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    bytes.reserve(header.size() + 15 * points.size());
    for (const CloudPoint &point : points) {
        append_float(bytes, point.x_m);
        append_float(bytes, point.y_m);
        append_float(bytes, point.z_m);
        bytes.push_back(point.red);
        bytes.push_back(point.green);
        bytes.push_back(point.blue);
    }
    write_file_atomically(file, bytes);
}

} // namespace tsr
