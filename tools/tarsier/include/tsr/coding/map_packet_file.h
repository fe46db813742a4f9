/*
 * Files of one disparity map in packets that decode alone (.tdm, like those of tsr/coding/coded_map.h, and told from
 * them by the first four bytes): docs/codec.md, chapter 2b. Packets may be gone, moved, repeated or damaged; what is
 * intact decodes. What refuses a file throws InputError naming it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODING_MAP_PACKET_FILE_H
#define TSR_CODING_MAP_PACKET_FILE_H

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

extern "C" {
#include "tsr/codec/map_packet.h"
}

namespace tsr
{

/* Of a packet: the least MTU that IPv6 asks of a link (RFC 8200, 5), so 6LoWPAN carries it in one datagram. */
inline constexpr std::size_t kMapPacketLenMax = 1280;

/* Of a file: twice what the largest map takes in the shortest packets. Longer ones are not read. */
inline constexpr std::size_t kMapPacketFileLenMax = std::size_t{2} << 20U;

struct MapPackets {
    tsr_map_info info{};
    std::uint8_t map_id = 0;
    std::size_t count = 0;                          /* that the map was cut into */
    std::vector<std::vector<std::uint8_t>> packets; /* with an intact checksum, in the file's order */
    std::size_t damaged_len = 0;                    /* bytes of the file that belong to none of them */

    std::size_t len() const; /* bytes of all packets */
};

struct MapOfPackets {
    std::vector<std::uint16_t> values_q4; /* [height][width]; of a missing pixel TSR_DISPARITY_INVALID */
    std::size_t found = 0;                /* different packets that decoded */
    std::size_t missing_pixels = 0;
};

/* values_q4: [height][width], which info admits; packets of at most packet_len bytes, TSR_MAP_PACKET_LEN_MIN ..
 * kMapPacketLenMax. Throws std::invalid_argument for anything else. */
MapPackets cut_map(const tsr_map_info &info, std::span<const std::uint16_t> values_q4, std::size_t packet_len);

std::vector<std::uint8_t> map_packet_file(const MapPackets &map);

bool is_map_packet_file(std::span<const std::uint8_t> bytes);

/* Refuses a header that is short, damaged or out of range, naming the field; bytes behind it are never refused. */
MapPackets read_map_packets(std::span<const std::uint8_t> bytes, const std::filesystem::path &file);

/* Refused if no packet decodes. */
MapOfPackets decode_map_packets(const MapPackets &map, const std::filesystem::path &file);

} // namespace tsr

#endif
