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

#include <cstdint>

namespace tsr::air
{

double exponential(double x);
double decibels(double ratio);                    /* 10 log10(ratio), ratio > 0 */
double ratio_of(double decibels);                 /* its inverse */
int level_q4(double decibels);                    /* rounded to nearest, ties away from 0 */
int to_dbm(int level_q4);                         /* whole, likewise */
std::uint64_t power_of(int dbm_q4);               /* 1 at -150 dBm and below */
int level_of(std::uint64_t power);                /* the nearest level below or equal, -150 .. +20 dBm */
bool is_at_most(std::uint64_t power, int dbm_q4); /* level_of(power) <= dbm_q4, without a search */

} // namespace tsr::air

#endif
