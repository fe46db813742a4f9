/*
 * Decibels as integers, and the functions their tables are made with.
 *
 * A level is dB or dBm in Q27.4 (name ends in _q4); a power is its linear
 * counterpart in units of 1e-15 mW (-150 dBm), so that powers add up. Powers
 * end at +20 dBm: more is taken for that.
 *
 * exponential() and decibels() use + - * / and frexp only, which IEEE 754 fixes
 * to the last bit; exp and log10 of C libraries differ there. So every table,
 * and every result, is the same on every machine.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_DECIBEL_H
#define TSR_HAL_AIR_DECIBEL_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tsr::air
{

double exponential(double x);
double decibels(double ratio);     /* 10 log10(ratio), ratio > 0 */
double ratio_of(double decibels);  /* its inverse */
int level_q4(double decibels);     /* rounded to nearest, ties away from 0 */
int to_dbm(int level_q4);          /* whole, likewise */
int level_of(std::uint64_t power); /* the nearest level below or equal, -150 .. +20 dBm */

inline constexpr int kPowerLowestQ4 = -150 * 16;
inline constexpr int kPowerHighestQ4 = 20 * 16;
using PowerTable = std::array<std::uint64_t, kPowerHighestQ4 - kPowerLowestQ4 + 1>;
/* Made at the start of the program: every transmission looks things up here for each of its receivers. */
extern const PowerTable kPowers;

/* 1 at -150 dBm and below. */
inline std::uint64_t power_of(int dbm_q4)
{
    return kPowers[static_cast<std::size_t>(std::clamp(dbm_q4, kPowerLowestQ4, kPowerHighestQ4) - kPowerLowestQ4)];
}

/* level_of(power) <= dbm_q4, without a search. */
inline bool is_at_most(std::uint64_t power, int dbm_q4)
{
    return dbm_q4 >= kPowerHighestQ4 || (dbm_q4 >= kPowerLowestQ4 && power < power_of(dbm_q4 + 1));
}

} // namespace tsr::air

#endif
