/*
 * Packets of a map, to and from one file: docs/codec.md, chapter 2b.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/coding/map_packet_file.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "tsr/host/input_error.h"

extern "C" {
#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"
}

namespace tsr
{
namespace
{

/* The low half of the first byte is a format version in files of one stream, and 0 is none. */
constexpr std::array<std::uint8_t, 4> kMagic = {'P', 'T', 'D', 'M'};
constexpr unsigned kFileVersion = 1;
constexpr std::size_t kHeaderLen = 17;
constexpr std::size_t kRecordHeadLen = 4; /* length and checksum of a packet */
constexpr std::size_t kPacketsMax = std::size_t{TSR_IMAGE_WIDTH_MAX} * TSR_IMAGE_HEIGHT_MAX / 8;

std::uint16_t checksum(std::span<const std::uint8_t> bytes, std::uint16_t start = TSR_CRC16_START_HDLC)
{
    return tsr_crc16(start, bytes.data(), bytes.size());
}

/* Over the packet's length, two bytes, and the packet. */
std::uint16_t record_checksum(std::span<const std::uint8_t> len_bytes, std::span<const std::uint8_t> packet)
{
    return checksum(packet, checksum(len_bytes));
}

void append_u16(std::vector<std::uint8_t> &bytes, std::size_t value)
{
    bytes.push_back(static_cast<std::uint8_t>(value & 255U));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
}

/* The packet that begins with its record at bytes[0]; empty if that is none, or not intact. */
std::span<const std::uint8_t> packet_at(std::span<const std::uint8_t> bytes)
{
    tsr_reader reader = tsr_reader_make(bytes.data(), bytes.size());
    const std::size_t len = tsr_read_u16(&reader);
    const std::uint16_t told = tsr_read_u16(&reader);
    if (!tsr_reader_ok(&reader) || len < TSR_MAP_PACKET_HEADER_LEN || len > kMapPacketLenMax ||
        len > tsr_reader_left(&reader)) {
        return {};
    }
    const std::span<const std::uint8_t> packet = bytes.subspan(kRecordHeadLen, len);
    return record_checksum(bytes.first(2), packet) == told ? packet : std::span<const std::uint8_t>{};
}

void check_header(const MapPackets &map, unsigned flags, const std::filesystem::path &file)
{
    const auto expect = [&](const char *field, std::size_t value, std::size_t least, std::size_t most) {
        if (value < least || value > most) {
            throw InputError(file.string(), field,
                             std::to_string(value) + ", a map in packets has " + std::to_string(least) + " .. " +
                                 std::to_string(most));
        }
    };
    expect("flags", flags >> 7U, 0, 0);
    expect("step", map.info.step_log2, 0, TSR_MAP_STEP_LOG2_MAX);
    expect("disparities", map.info.disparities, 1, TSR_DISPARITY_COUNT_MAX);
    expect("width", map.info.width, 1, TSR_IMAGE_WIDTH_MAX);
    expect("height", map.info.height, 1, TSR_IMAGE_HEIGHT_MAX);
    expect("packets", map.count, 1, kPacketsMax);
}

MapPackets read_header(std::span<const std::uint8_t> bytes, const std::filesystem::path &file)
{
    if (bytes.size() < kHeaderLen) {
        throw InputError(file.string(), "header",
                         std::to_string(bytes.size()) + " bytes, that of a map in packets has " +
                             std::to_string(kHeaderLen));
    }
    tsr_reader reader = tsr_reader_make(bytes.data(), kHeaderLen);
    (void)tsr_read_span(&reader, kMagic.size());
    if (const unsigned version = tsr_read_u8(&reader); version != kFileVersion) {
        throw InputError(file.string(), "file version",
                         std::to_string(version) + ", known is " + std::to_string(kFileVersion));
    }
    MapPackets map;
    const unsigned flags = tsr_read_u8(&reader);
    map.info.step_log2 = flags & 7U;
    map.info.near = flags >> 3U & 1U;
    map.map_id = flags >> 4U & 7U;
    map.info.disparities = static_cast<std::uint16_t>(tsr_read_u8(&reader) + 1U);
    map.info.width = tsr_read_u16(&reader);
    map.info.height = tsr_read_u16(&reader);
    map.info.d0_q4 = static_cast<std::int16_t>(tsr_read_u16(&reader));
    map.count = tsr_read_u16(&reader);
    if (tsr_read_u16(&reader) != checksum(bytes.first(kHeaderLen - 2))) {
        throw InputError(file.string(), "header", "damaged: its checksum is another");
    }
    check_header(map, flags, file);
    return map;
}

/* A packet of another version may be damage that the checksum let pass; where nothing decodes it is the reason. */
[[noreturn]] void refuse_all(const MapPackets &map, std::optional<unsigned> other_version,
                             const std::filesystem::path &file)
{
    if (other_version) {
        throw InputError(file.string(), "packet version",
                         std::to_string(*other_version) + ", known is " +
                             std::to_string(TSR_MAP_PACKET_FORMAT_VERSION) + "; of another release");
    }
    throw InputError(file.string(), "packets", "none of " + std::to_string(map.count) + " is intact");
}

void expect_ok(bool ok, tsr_status status)
{
    if (!ok) {
        throw std::invalid_argument(std::string("the map codec: ") + tsr_status_name(status));
    }
}

} // namespace

std::size_t MapPackets::len() const
{
    std::size_t sum = 0;
    for (const std::vector<std::uint8_t> &packet : packets) {
        sum += packet.size();
    }
    return sum;
}

MapPackets cut_map(const tsr_map_info &info, std::span<const std::uint16_t> values_q4, std::size_t packet_len)
{
    if (values_q4.size() != std::size_t{info.width} * info.height || packet_len > kMapPacketLenMax) {
        throw std::invalid_argument("a map of another shape, or packets too long");
    }
    MapPackets map;
    map.info = info;
    const auto encoder = std::make_unique<tsr_map_packet_encoder>();
    std::array<std::uint16_t, TSR_MAP_PACKET_SCRATCH_COUNT> scratch{};
    tsr_status status = tsr_map_packets_start(encoder.get(), &info, values_q4.data(), info.width, map.map_id,
                                              scratch.data(), scratch.size());
    expect_ok(status == TSR_OK, status);
    do {
        std::vector<std::uint8_t> packet(packet_len);
        std::size_t len = 0;
        status = tsr_map_packets_next(encoder.get(), packet.data(), packet.size(), &len);
        expect_ok(status >= 0, status);
        packet.resize(len);
        map.packets.push_back(std::move(packet));
    } while (status == TSR_AGAIN);
    map.count = map.packets.size();
    return map;
}

std::vector<std::uint8_t> map_packet_file(const MapPackets &map)
{
    std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
    bytes.push_back(kFileVersion);
    bytes.push_back(static_cast<std::uint8_t>(map.info.step_log2 | map.info.near << 3U | map.map_id << 4U));
    bytes.push_back(static_cast<std::uint8_t>(map.info.disparities - 1U));
    append_u16(bytes, map.info.width);
    append_u16(bytes, map.info.height);
    append_u16(bytes, static_cast<std::uint16_t>(map.info.d0_q4));
    append_u16(bytes, map.count);
    append_u16(bytes, checksum(bytes));
    for (const std::vector<std::uint8_t> &packet : map.packets) {
        append_u16(bytes, packet.size());
        append_u16(bytes, record_checksum(std::span(bytes).last(2), packet));
        bytes.insert(bytes.end(), packet.begin(), packet.end());
    }
    return bytes;
}

bool is_map_packet_file(std::span<const std::uint8_t> bytes)
{
    return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

MapPackets read_map_packets(std::span<const std::uint8_t> bytes, const std::filesystem::path &file)
{
    MapPackets map = read_header(bytes, file);
    /* Where a record is not intact its length cannot be trusted: the next one may begin at any byte. */
    for (std::size_t at = kHeaderLen; at < bytes.size();) {
        const std::span<const std::uint8_t> packet = packet_at(bytes.subspan(at));
        if (packet.empty()) {
            map.damaged_len++;
            at++;
            continue;
        }
        map.packets.emplace_back(packet.begin(), packet.end());
        at += kRecordHeadLen + packet.size();
    }
    return map;
}

MapOfPackets decode_map_packets(const MapPackets &map, const std::filesystem::path &file)
{
    MapOfPackets result;
    result.values_q4.resize(std::size_t{map.info.width} * map.info.height);
    tsr_status status = tsr_map_packets_clear(&map.info, result.values_q4.data(), map.info.width);
    expect_ok(status == TSR_OK, status);
    const auto model = std::make_unique<tsr_map_model>();
    std::array<std::uint16_t, TSR_MAP_PACKET_SCRATCH_COUNT> scratch{};
    std::set<std::uint32_t> firsts;
    std::optional<unsigned> other_version;
    for (const std::vector<std::uint8_t> &bytes : map.packets) {
        tsr_map_packet packet{};
        status = tsr_map_packet_decode(model.get(), &map.info, map.map_id, bytes.data(), bytes.size(), scratch.data(),
                                       scratch.size(), &packet, result.values_q4.data(), map.info.width);
        if (status == TSR_OK) {
            firsts.insert(packet.first);
        }
        other_version = status == TSR_ERR_VERSION ? bytes[3] >> 6U : other_version;
    }
    result.found = firsts.size();
    if (result.found == 0) {
        refuse_all(map, other_version, file);
    }
    result.missing_pixels = tsr_map_packets_missing(&map.info, result.values_q4.data(), map.info.width);
    std::ranges::replace(result.values_q4, std::uint16_t{TSR_MAP_PIXEL_MISSING}, std::uint16_t{TSR_DISPARITY_INVALID});
    return result;
}

} // namespace tsr
