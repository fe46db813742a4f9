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
#include "tsr/coding/map_packet_file.h"

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

/* What was found of a map in packets. */
struct PacketFigures {
    std::size_t count = 0; /* that the map was cut into */
    std::size_t found = 0; /* of them, each counted once */
    std::size_t missing_pixels = 0;
    std::size_t damaged_len = 0; /* bytes of the file that belong to no intact packet */
};

/* What is told of a coded map. */
struct CodedMapFigures {
    tsr_map_info info{};
    std::size_t len = 0; /* bytes that travel: of the stream, or of all packets at hand */
    unsigned format_version = 0;
    std::optional<unsigned> prior;        /* of packets the version tells it */
    std::optional<PacketFigures> packets; /* none: one stream */
};

CodedMapFigures figures_of(const CodedMap &coded);
CodedMapFigures figures_of(const MapPackets &packets, const MapOfPackets &decoded);

/* Figures, and density of the map as decoded; out is the file that was written. */
void print_coded_map(const CodedMapFigures &figures, std::span<const std::uint16_t> values_q4,
                     const std::filesystem::path &out, bool json);

} // namespace tsr

#endif
