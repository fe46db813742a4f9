/*
 * Chance without a state: numbers are hashes of what they belong to, so no
 * draw depends on how many others came before it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_CHANCE_H
#define TSR_HAL_AIR_CHANCE_H

#include <algorithm>
#include <cstdint>

namespace tsr::air
{

/* SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). */
constexpr std::uint64_t mix(std::uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Where the normal distribution is cut: 0.27 % of the draws. What is drawn has a bound, so a link has a range. */
inline constexpr int kNormalMax = 3;

/*
 * A standard normal number of key, Q15.16, |z| <= kNormalMax: the sum of twelve
 * uniform numbers has a variance of 1 (Irwin-Hall), and here it is exact in integers.
 */
constexpr std::int32_t normal_q16(std::uint64_t key)
{
    std::int32_t sum = 0;
    for (std::uint64_t part = 0; part < 3; ++part) {
        const std::uint64_t draw = mix(key + part);
        for (int shift = 0; shift < 64; shift += 16) {
            sum += static_cast<std::int32_t>(draw >> shift & 0xffffu);
        }
    }
    constexpr std::int32_t kMean = 12 * 0xffff / 2;
    return std::clamp(sum - kMean, -kNormalMax * 65536, kNormalMax * 65536);
}

} // namespace tsr::air

#endif
