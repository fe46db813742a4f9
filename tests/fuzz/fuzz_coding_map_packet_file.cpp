/*
 * Any bytes as a file of packets: refused, or a map whose every pixel is a value of it or invalid.
 *
 *   tools/fuzz coding_map_packet_file
 *
 * Checksums are made right first, or no input would get past them: that of the header, and those of records that follow
 * each other as their lengths say. Of a record whose length has bit 15 set the bit is cleared and nothing is made
 * right: it is sought in. What is found is compared with what a reader finds that takes each record at its word.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "tsr/coding/map_packet_file.h"
#include "tsr/host/input_error.h"

extern "C" {
#include "tsr/base/crc.h"

int LLVMFuzzerTestOneInput(const std::uint8_t *bytes, std::size_t len);
}

namespace
{

constexpr std::size_t kHeaderLen = 17;
constexpr std::size_t kRecordHeadLen = 4;

void put_u16(std::uint8_t *at, unsigned value)
{
    at[0] = static_cast<std::uint8_t>(value & 255U);
    at[1] = static_cast<std::uint8_t>(value >> 8U);
}

std::size_t len_at(const std::vector<std::uint8_t> &file, std::size_t at)
{
    return file[at] | std::size_t{file[at + 1]} << 8U;
}

std::uint16_t record_checksum(const std::vector<std::uint8_t> &file, std::size_t at, std::size_t len)
{
    return tsr_crc16(tsr_crc16(TSR_CRC16_START_HDLC, &file[at], 2), file.data() + at + kRecordHeadLen, len);
}

void make_checksums_right(std::vector<std::uint8_t> &file)
{
    if (file.size() < kHeaderLen) {
        return;
    }
    std::copy_n("PTDM\1", 5, file.begin());
    put_u16(&file[15], tsr_crc16(TSR_CRC16_START_HDLC, file.data(), 15));
    for (std::size_t at = kHeaderLen; at + kRecordHeadLen <= file.size();) {
        const bool is_left = file[at + 1] >= 0x80U;
        file[at + 1] &= 0x7fU;
        const std::size_t len = len_at(file, at);
        if (len > file.size() - at - kRecordHeadLen) {
            return;
        }
        if (is_left) {
            at += kRecordHeadLen + len;
            continue;
        }
        put_u16(&file[at + 2], record_checksum(file, at, len));
        at += kRecordHeadLen + len;
    }
}

void require(bool condition)
{
    if (!condition) {
        std::abort();
    }
}

/* docs/codec.md, 2b, word by word: each place's checksum over its own bytes. */
void require_same_packets(const tsr::MapPackets &packets, const std::vector<std::uint8_t> &file)
{
    std::size_t found = 0, damaged = 0;
    for (std::size_t at = kHeaderLen; at < file.size();) {
        const std::size_t left = file.size() - at, len = left >= kRecordHeadLen ? len_at(file, at) : 0;
        if (len < TSR_MAP_PACKET_HEADER_LEN || len > tsr::kMapPacketLenMax || len > left - kRecordHeadLen ||
            record_checksum(file, at, len) != (file[at + 2] | file[at + 3] << 8U)) {
            damaged++;
            at++;
            continue;
        }
        require(found < packets.packets.size() &&
                std::ranges::equal(packets.packets[found], std::span(file).subspan(at + kRecordHeadLen, len)));
        found++;
        at += kRecordHeadLen + len;
    }
    require(found == packets.packets.size() && damaged == packets.damaged_len);
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t *bytes, std::size_t len)
{
    std::vector<std::uint8_t> file(bytes, bytes + len);
    make_checksums_right(file);
    try {
        const tsr::MapPackets packets = tsr::read_map_packets(file, "input");
        require_same_packets(packets, file);
        const tsr::MapOfPackets map = tsr::decode_map_packets(packets, "input");
        require(map.values_q4.size() == std::size_t{packets.info.width} * packets.info.height);
        require(packets.damaged_len + packets.len() <= file.size());
        for (const unsigned value : map.values_q4) {
            require(value == TSR_DISPARITY_INVALID ||
                    (value < packets.info.disparities * 16U && value % (1U << packets.info.step_log2) == 0));
        }
    } catch (const tsr::InputError &) {
    }
    return 0;
}
