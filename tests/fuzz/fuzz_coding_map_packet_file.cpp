/*
 * Any bytes as a file of packets: refused, or a map whose every pixel is a value of it or invalid.
 *
 *   clang -g -O1 -fsanitize=fuzzer-no-link,address,undefined -c -I... firmware/codec/(all).c firmware/base/(all).c
 *   clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Ifirmware/base/include -Ifirmware/codec/include
 *     -Itools/host/include -Itools/tarsier/include tests/fuzz/fuzz_coding_map_packet_file.cpp
 *     tools/tarsier/src/map_packet_file.cpp tools/host/src/input_error.cpp *.o
 *
 * Checksums are made right first, or no input would get past them: that of the header, and those of records that follow
 * each other as their lengths say.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
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

void make_checksums_right(std::vector<std::uint8_t> &file)
{
    if (file.size() < kHeaderLen) {
        return;
    }
    std::copy_n("PTDM\1", 5, file.begin());
    put_u16(&file[15], tsr_crc16(TSR_CRC16_START_HDLC, file.data(), 15));
    for (std::size_t at = kHeaderLen; at + kRecordHeadLen <= file.size();) {
        const std::size_t len = file[at] | std::size_t{file[at + 1]} << 8U;
        if (len > file.size() - at - kRecordHeadLen) {
            return;
        }
        const std::uint16_t crc = tsr_crc16(TSR_CRC16_START_HDLC, &file[at], 2);
        put_u16(&file[at + 2], tsr_crc16(crc, file.data() + at + kRecordHeadLen, len));
        at += kRecordHeadLen + len;
    }
}

void require(bool condition)
{
    if (!condition) {
        std::abort();
    }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t *bytes, std::size_t len)
{
    std::vector<std::uint8_t> file(bytes, bytes + len);
    make_checksums_right(file);
    try {
        const tsr::MapPackets packets = tsr::read_map_packets(file, "input");
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
