/*
 * Sweeps: one scenario run for each value of a field, or each combination of
 * the values of several.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_SWEEP_H
#define TSR_EMULATOR_SWEEP_H

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace tsr
{

inline constexpr std::size_t kSweepRunsMax = 1000;

/* A field and the values it takes in turn. */
struct SweepAxis {
    std::string key;                            /* TABLE.FIELD, or FIELD */
    std::vector<nlohmann::ordered_json> values; /* numbers, strings, true and false, lists of these; at least one */
};

/* A run's value on each axis. */
using SweepPoint = std::vector<nlohmann::ordered_json>;

/* option: KEY=A,B,... whose right side is a TOML list without its brackets. Throws InputError. */
SweepAxis parse_sweep(const std::string &option);

/* Every combination, the last axis changing fastest. Throws InputError: a key twice, more than kSweepRunsMax. */
std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis> &axes);

/* A point as --set takes it: KEY=VALUE for each axis. */
std::vector<std::string> sweep_settings(const std::vector<SweepAxis> &axes, const SweepPoint &point);

/* The fields that a setting of --set writes, TABLE.FIELD however it is spelled: quoted, with blanks, as an inline
 * table. None if it is no TOML. */
std::vector<std::string> fields_of(const std::string &setting);

} // namespace tsr

#endif
