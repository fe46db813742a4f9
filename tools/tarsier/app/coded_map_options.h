/*
 * What `tarsier encode` and `tarsier decode` share: the map that both sides hold, and what is printed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TARSIER_CODED_MAP_OPTIONS_H
#define TSR_TARSIER_CODED_MAP_OPTIONS_H

#include <filesystem>
#include <optional>
#include <span>

#include <CLI/CLI.hpp>

#include "tsr/coding/coded_map.h"

namespace tsr
{

struct HeldMapOptions {
    std::filesystem::path against;
    std::optional<unsigned> reference_id;
};

void declare_held_map(CLI::App &command, HeldMapOptions &options);

/* One is nothing without the other; before anything is read. */
void check_held_map(const HeldMapOptions &options);

/* None if none was named. Refused, like every file of another size, if it is not of the map's shape. */
std::optional<HeldMap> read_held_map(const HeldMapOptions &options, const tsr_map_info &map,
                                     const std::filesystem::path &map_file);

/* For CLI::Option::check(): a step that maps can have, px. */
CLI::Validator is_map_step();

/* Bytes, density, the header's fields; out is the file that was written, values_q4 the map as decoded. */
void print_coded_map(const CodedMap &coded, std::span<const std::uint16_t> values_q4, const std::filesystem::path &out,
                     bool json);

} // namespace tsr

#endif
