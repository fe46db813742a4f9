/*
 * A pair made from a formula, matched as a node does.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/coding/matcher_fingerprint.h"

#include <vector>

#include "tsr/stereo/stereo_pipeline.h"

extern "C" {
#include "tsr/base/crc.h"
}

namespace tsr
{
namespace
{

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr int kDisparities = 32;

/* A hash of a place, 0 .. 255 (multipliers: M. E. O'Neill's and D. Knuth's; any odd ones do). */
std::uint8_t grain(std::uint32_t x, std::uint32_t y, std::uint32_t seed)
{
    std::uint32_t hash = x * 2654435761U ^ y * 2246822519U ^ seed * 3266489917U;
    hash ^= hash >> 15;
    hash *= 2246822519U;
    return static_cast<std::uint8_t>(hash >> 13);
}

/* Texture in coordinates of the left view, coarse and fine; a wall without texture at the bottom right. */
int texture(int x, int y)
{
    if (x > 110 && y > 80) {
        return 128;
    }
    const auto coarse = grain(static_cast<std::uint32_t>(x + 64) / 4, static_cast<std::uint32_t>(y) / 3, 1);
    const auto fine = grain(static_cast<std::uint32_t>(x + 64), static_cast<std::uint32_t>(y), 2);
    return (2 * coarse + fine) / 3;
}

/* Sixteenths: a floor that slopes, with a box in front. */
int disparity_q4(int x, int y)
{
    const bool box = x >= 60 && x < 100 && y >= 30 && y < 80;
    return box ? 20 * 16 + 5 : 5 * 16 + y + x / 8;
}

std::uint8_t with_noise(int value, int x, int y, std::uint32_t seed)
{
    const int noisy = value + grain(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed) % 7 - 3;
    return static_cast<std::uint8_t>(noisy < 0 ? 0 : noisy > 255 ? 255 : noisy);
}

/* What the right view sees at x: the nearest left pixel that lands there, between whole pixels interpolated. */
int right_view(int x, int y)
{
    for (int d = kDisparities - 1; d >= 0; d--) {
        const int left = disparity_q4(x + d, y);
        if (left / 16 == d) {
            const int fraction = left % 16;
            return (texture(x + d, y) * (16 - fraction) + texture(x + d + 1, y) * fraction) / 16;
        }
    }
    return texture(x, y);
}

} // namespace

std::uint16_t matcher_fingerprint()
{
    GrayImage left{kWidth, kHeight, std::vector<std::uint8_t>(std::size_t{kWidth} * kHeight)};
    GrayImage right = left;
    for (int y = 0; y < kHeight; y++) {
        for (int x = 0; x < kWidth; x++) {
            const std::size_t at = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
            left.pixels[at] = with_noise(texture(x, y), x, y, 3);
            right.pixels[at] = with_noise(right_view(x, y), x, y, 4);
        }
    }
    StereoOptions options;
    options.match.width = kWidth;
    options.match.height = kHeight;
    options.match.disparities = kDisparities;
    options.refine.steps[0] = TSR_REFINE_MEDIAN3;
    const StereoResult result = StereoPipeline(options).run(left, right);
    std::uint16_t crc = TSR_CRC16_START_HDLC;
    for (const std::uint16_t value : result.disparity_q4) {
        const std::uint8_t bytes[2] = {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
        crc = tsr_crc16(crc, bytes, sizeof bytes);
    }
    return crc;
}

} // namespace tsr
