/*
 * Chance that is a function of what it is drawn for.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_HASH_H
#define TSR_SCENE_HASH_H

#include <cstdint>

namespace tsr::scene
{

/* SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). */
inline std::uint64_t hash64(std::uint64_t value)
{
    value += 0x9e3779b97f4a7c15U;
    value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9U;
    value = (value ^ value >> 27) * 0x94d049bb133111ebU;
    return value ^ value >> 31;
}

} // namespace tsr::scene

#endif
