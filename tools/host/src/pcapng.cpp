/*
 * pcapng blocks, little-endian.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/host/pcapng.h"

namespace tsr
{

namespace
{

/* draft-ietf-opsawg-pcapng, section 4. */
constexpr std::uint32_t kSectionHeader = 0x0a0d0d0a;
constexpr std::uint32_t kByteOrderMagic = 0x1a2b3c4d;
constexpr std::uint32_t kInterfaceDescription = 1;
constexpr std::uint32_t kEnhancedPacket = 6;
constexpr std::uint16_t kLinkType802154Tap = 283;
/* IEEE 802.15.4 TAP Link Type Specification, section 2. */
constexpr std::uint16_t kTapFcsType = 0;
constexpr std::uint8_t kFcs16Bit = 1;
constexpr std::uint16_t kTapChannelAssignment = 3;

constexpr std::size_t kBufferLen = std::size_t{1} << 16;

using Bytes = std::vector<std::uint8_t>;

void put16(Bytes &bytes, std::uint32_t value)
{
    bytes.push_back(static_cast<std::uint8_t>(value));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

void put32(Bytes &bytes, std::uint32_t value)
{
    put16(bytes, value & 0xffffu);
    put16(bytes, value >> 16);
}

void put_block(Bytes &bytes, std::uint32_t type, Bytes body)
{
    body.resize((body.size() + 3) / 4 * 4);
    const auto length = static_cast<std::uint32_t>(body.size() + 12);
    put32(bytes, type);
    put32(bytes, length);
    bytes.insert(bytes.end(), body.begin(), body.end());
    put32(bytes, length);
}

Bytes tap_header(std::uint8_t channel)
{
    Bytes tlvs;
    put16(tlvs, kTapFcsType);
    put16(tlvs, 1);
    put32(tlvs, kFcs16Bit);
    put16(tlvs, kTapChannelAssignment);
    put16(tlvs, 3);
    put16(tlvs, channel);
    put16(tlvs, 0); /* channel page 0, then padding */
    Bytes header = {0, 0};
    put16(header, static_cast<std::uint32_t>(tlvs.size() + 4));
    header.insert(header.end(), tlvs.begin(), tlvs.end());
    return header;
}

} // namespace

PcapngCapture::PcapngCapture(const std::filesystem::path &file) : file_(file)
{
    Bytes section;
    put32(section, kByteOrderMagic);
    put16(section, 1); /* version 1.0 */
    put16(section, 0);
    put32(section, 0xffffffff); /* section length not given */
    put32(section, 0xffffffff);
    put_block(bytes_, kSectionHeader, section);
    Bytes interface;
    put16(interface, kLinkType802154Tap);
    put16(interface, 0);
    put32(interface, 0); /* no snapshot limit; time stamps in microseconds, the default */
    put_block(bytes_, kInterfaceDescription, interface);
}

void PcapngCapture::add(std::uint64_t time_us, std::uint8_t channel, std::span<const std::uint8_t> psdu)
{
    const Bytes header = tap_header(channel);
    const auto length = static_cast<std::uint32_t>(header.size() + psdu.size());
    Bytes packet;
    put32(packet, 0); /* interface */
    put32(packet, static_cast<std::uint32_t>(time_us >> 32));
    put32(packet, static_cast<std::uint32_t>(time_us));
    put32(packet, length);
    put32(packet, length);
    packet.insert(packet.end(), header.begin(), header.end());
    packet.insert(packet.end(), psdu.begin(), psdu.end());
    put_block(bytes_, kEnhancedPacket, packet);
    if (bytes_.size() >= kBufferLen) {
        flush();
    }
}

void PcapngCapture::flush()
{
    file_.write(bytes_);
    bytes_.clear();
}

void PcapngCapture::complete()
{
    flush();
    file_.complete();
}

} // namespace tsr
