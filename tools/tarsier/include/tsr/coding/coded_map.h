/*
 * Files of one coded disparity map (.tdm) in one stream: exactly its bytes, docs/codec.md, 2.1. What refuses a file
 * throws InputError naming it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODING_CODED_MAP_H
#define TSR_CODING_CODED_MAP_H

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

extern "C" {
#include "tsr/codec/map.h"
}

namespace tsr
{

/* Bytes whose header was read. */
struct CodedMap {
    tsr_map_info info{};
    std::vector<std::uint8_t> bytes;

    unsigned format_version() const { return bytes[0] & 15U; }
    unsigned prior() const { return bytes[1] >> 4U; }
};

/* A map that sender and receiver hold, and what they call it. */
struct HeldMap {
    std::uint16_t id = 0;
    std::uint16_t width = 0;
    std::uint16_t height = 0;
    std::vector<std::uint16_t> values_q4; /* [height][width], px, UQ12.4, or TSR_DISPARITY_INVALID */
};

/* px, multiples of a sixteenth: 1, 0.5, 0.25, 0.125 or 0.0625. */
std::uint8_t log2_of_step(double step_px);

/* The bytes of a file of either form: one stream, or packets (tsr/coding/map_packet_file.h). More than any has are not
 * read. */
std::vector<std::uint8_t> read_map_file(const std::filesystem::path &file);

/* Refuses a header that the codec refuses, naming the field; file is what to name. */
CodedMap coded_map_of(std::vector<std::uint8_t> bytes, const std::filesystem::path &file);

/* A .tdm of one stream coded alone, as it decodes, or quantised if its step is another; or a map file
 * (tsr/stereo/disparity_file.h), quantised. */
HeldMap read_held_map(const std::filesystem::path &file, std::uint16_t id, std::uint8_t step_log2);

/*
 * [height][width] values; file is what to name in a refusal. A map coded against another needs that one: refused, with
 * its id, if there is none or it has another id or shape.
 */
std::vector<std::uint16_t> decode_map(const CodedMap &coded, const std::filesystem::path &file,
                                      const std::optional<HeldMap> &held);

/* The map held to an earlier one of the same shape and step, both [height][width], as is done before it is coded
 * against that (tsr/codec/map_hold.h). A pixel keeps its value where the earlier one's is beyond the map's disparities.
 */
std::vector<std::uint16_t> held_to(const tsr_map_info &info, const std::vector<std::uint16_t> &values_q4,
                                   std::span<const std::uint16_t> earlier_q4);

/* values_q4: [height][width], which info admits; against the held map, of the same shape, if there is one.
 * Throws std::invalid_argument for anything else. */
CodedMap encode_map(const tsr_map_info &info, std::span<const std::uint16_t> values_q4,
                    const std::optional<HeldMap> &held);

} // namespace tsr

#endif
