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

/*
 * The checksum of any stretch of a file in constant time: where a packet is sought at every byte, reading it there
 * would cost a thousand times as much. A CRC is linear: with a start s and equally long a and b,
 *
 *   crc(s ^ t, a ^ b) = crc(s, a) ^ crc(t, b),   so   crc(s, b) = crc(0, ab) ^ crc(s ^ crc(0, a), zeros as long as b)
 */
class StretchChecksums
{
  public:
    explicit StretchChecksums(std::span<const std::uint8_t> bytes) : from_begin_(bytes.size() + 1)
    {
        for (std::size_t i = 0; i < bytes.size(); i++) {
            from_begin_[i + 1] = checksum(bytes.subspan(i, 1), from_begin_[i]);
        }
        constexpr std::array<std::uint8_t, 1> kZero = {0};
        for (unsigned bit = 0; bit < kBits; bit++) {
            after_zeros_[0][bit] = static_cast<std::uint16_t>(1U << bit);
            for (std::size_t len = 1; len < after_zeros_.size(); len++) {
                after_zeros_[len][bit] = checksum(kZero, after_zeros_[len - 1][bit]);
            }
        }
    }

    /* Of bytes [first, first + len), len <= kMapPacketLenMax. */
    std::uint16_t of(std::size_t first, std::size_t len, std::uint16_t start) const
    {
        std::uint16_t sum = from_begin_[first + len];
        for (unsigned bit = 0; bit < kBits; bit++) {
            if (((start ^ from_begin_[first]) >> bit & 1U) != 0) {
                sum ^= after_zeros_[len][bit];
            }
        }
        return sum;
    }

  private:
    static constexpr unsigned kBits = 16;
    std::vector<std::uint16_t> from_begin_; /* crc(0, the first i bytes) */
    std::array<std::array<std::uint16_t, kBits>, kMapPacketLenMax + 1>
        after_zeros_{}; /* crc(1 << bit, so many zeros) */
};

void append_u16(std::vector<std::uint8_t> &bytes, std::size_t value)
{
    bytes.push_back(static_cast<std::uint8_t>(value & 255U));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
}

/* The packet that begins with its record at bytes[at]; empty if that is none, or not intact. */
std::span<const std::uint8_t> packet_at(std::span<const std::uint8_t> bytes, std::size_t at,
                                        const StretchChecksums &checksums)
{
    const std::span<const std::uint8_t> record = bytes.subspan(at);
    tsr_reader reader = tsr_reader_make(record.data(), record.size());
    const std::size_t len = tsr_read_u16(&reader);
    const std::uint16_t told = tsr_read_u16(&reader);
    if (!tsr_reader_ok(&reader) || len < TSR_MAP_PACKET_HEADER_LEN || len > kMapPacketLenMax ||
        len > tsr_reader_left(&reader)) {
        return {};
    }
    const bool is_intact = checksums.of(at + kRecordHeadLen, len, checksum(record.first(2))) == told;
    return is_intact ? record.subspan(kRecordHeadLen, len) : std::span<const std::uint8_t>{};
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

/* Groups of 8 pixels of which a packet has come. */
class GroupsArrived
{
  public:
    explicit GroupsArrived(std::size_t pixels) : arrived_((pixels + kGroup - 1) / kGroup) {}

    /* Does a packet hold one of them? Of a header that the codec refuses no matter what is said. */
    bool have_one_of(std::span<const std::uint8_t> packet) const
    {
        tsr_reader reader = tsr_reader_make(packet.data(), packet.size());
        const std::uint32_t word = tsr_read_u32(&reader); /* docs/codec.md, 2a.1 */
        const std::size_t first = std::min<std::size_t>(word & 0x1ffffU, arrived_.size());
        const std::size_t end = std::min<std::size_t>(first + (word >> 17U & 0x1ffU) + 1U, arrived_.size());
        return std::find(arrived_.begin() + first, arrived_.begin() + end, true) != arrived_.begin() + end;
    }

    /* Groups of which only a part decoded may come again. */
    void add(const tsr_map_packet &packet, bool is_whole)
    {
        const std::size_t first = packet.first / kGroup;
        const std::size_t end = (packet.first + packet.count + (is_whole ? kGroup - 1U : 0U)) / kGroup;
        std::fill(arrived_.begin() + first, arrived_.begin() + end, true);
    }

  private:
    static constexpr std::size_t kGroup = 8;
    std::vector<char> arrived_;
};

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
    const auto checksums = std::make_unique<StretchChecksums>(bytes);
    /* Where a record is not intact its length cannot be trusted: the next one may begin at any byte. */
    for (std::size_t at = kHeaderLen; at < bytes.size();) {
        const std::span<const std::uint8_t> packet = packet_at(bytes, at, *checksums);
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
    GroupsArrived arrived(result.values_q4.size());
    std::optional<unsigned> other_version;
    for (const std::vector<std::uint8_t> &bytes : map.packets) {
        if (arrived.have_one_of(bytes)) {
            continue;
        }
        tsr_map_packet packet{};
        status = tsr_map_packet_decode(model.get(), &map.info, map.map_id, bytes.data(), bytes.size(), scratch.data(),
                                       scratch.size(), &packet, result.values_q4.data(), map.info.width);
        arrived.add(packet, status == TSR_OK);
        result.found += status == TSR_OK ? 1 : 0;
        other_version = status == TSR_ERR_VERSION ? bytes[3] >> 6U : other_version;
    }
    if (result.found == 0) {
        refuse_all(map, other_version, file);
    }
    result.missing_pixels = tsr_map_packets_missing(&map.info, result.values_q4.data(), map.info.width);
    std::ranges::replace(result.values_q4, std::uint16_t{TSR_MAP_PIXEL_MISSING}, std::uint16_t{TSR_DISPARITY_INVALID});
    return result;
}

} // namespace tsr
