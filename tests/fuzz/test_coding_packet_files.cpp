/*
 * Files of packets, whole and with bytes changed, lost and put in, through the fuzz harness of map_packet_file.cpp.
 * SEED and RUNS choose them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#define LLVMFuzzerTestOneInput fuzz_packet_file_one_input
#include "fuzz_coding_map_packet_file.cpp"
#undef LLVMFuzzerTestOneInput

extern "C" {
#include "codec_random.h"
}

namespace
{

class Random
{
  public:
    explicit Random(std::uint64_t seed) : random_(codec_random_of_seed(seed)) {}
    std::uint32_t below(std::size_t count) { return codec_random_below(&random_, static_cast<std::uint32_t>(count)); }

  private:
    codec_random random_;
};

std::vector<std::uint8_t> random_file(Random &random)
{
    tsr_map_info info{};
    info.width = static_cast<std::uint16_t>(1 + random.below(100));
    info.height = static_cast<std::uint16_t>(1 + random.below(60));
    info.disparities = static_cast<std::uint16_t>(1 + random.below(128));
    info.step_log2 = static_cast<std::uint8_t>(random.below(5));
    const unsigned labels = info.disparities * 16U >> info.step_log2;
    std::vector<std::uint16_t> values(std::size_t{info.width} * info.height);
    const unsigned changes = 1 + random.below(40);
    std::uint16_t value = 0;
    for (std::uint16_t &pixel : values) {
        value = random.below(40) < changes ? static_cast<std::uint16_t>(random.below(labels) << info.step_log2) : value;
        pixel = random.below(9) == 0 ? TSR_DISPARITY_INVALID : value;
    }
    return tsr::map_packet_file(tsr::cut_map(info, values, TSR_MAP_PACKET_LEN_MIN + random.below(200)));
}

/* Bit 15 of a length asks the harness to leave a record as it is, so that what is put into it is found as damage. */
void damage(std::vector<std::uint8_t> &file, Random &random)
{
    for (unsigned i = random.below(6); i > 0; i--) {
        const auto at = file.begin() + kHeaderLen + random.below(file.size() - kHeaderLen);
        const auto left = static_cast<std::size_t>(file.end() - at);
        const std::vector<std::uint8_t> some(at, at + std::min<std::size_t>(left, 1 + random.below(120)));
        switch (random.below(4)) {
        case 0: *at = static_cast<std::uint8_t>(random.below(256)); break;
        case 1: *at |= 0x80; break;
        case 2:
            file.insert(file.begin() + kHeaderLen + random.below(file.size() - kHeaderLen), some.begin(), some.end());
            break;
        default: file.erase(at, at + std::min<std::size_t>(left - 1, random.below(30))); break;
        }
    }
}

TEST(PacketFiles, AreReadAsSpecifiedWhateverHappensToThem)
{
    const std::uint64_t first = codec_setting("SEED", 1), runs = codec_setting("RUNS", 300);
    std::printf("replay: SEED=%llu RUNS=%llu fuzz_test_coding_packet_files\n", static_cast<unsigned long long>(first),
                static_cast<unsigned long long>(runs));
    for (std::uint64_t seed = first; seed < first + runs; seed++) {
        Random random(seed);
        std::vector<std::uint8_t> file = random_file(random);
        damage(file, random);
        fuzz_packet_file_one_input(file.data(), file.size());
    }
}

/* Nearly every byte could begin a record, and by chance some do. */
TEST(PacketFiles, OfPlausibleLengthsAlone)
{
    for (const unsigned len : {0x0101U, 0x0202U, 0x0404U, 0x0500U}) {
        Random random(len);
        std::vector<std::uint8_t> file = random_file(random);
        file.resize(kHeaderLen);
        while (file.size() < 20000) {
            file.push_back(static_cast<std::uint8_t>(len & 255U));
            file.push_back(static_cast<std::uint8_t>(len >> 8U));
        }
        const tsr::MapPackets packets = tsr::read_map_packets(file, "input");
        require_same_packets(packets, file);
        EXPECT_EQ(packets.damaged_len + packets.len() + kRecordHeadLen * packets.packets.size() + kHeaderLen,
                  file.size());
    }
}

/* Of packets that overlap the first counts, so that each pixel is decoded once. */
TEST(PacketFiles, PixelsAreDecodedOnce)
{
    tsr_map_info info{};
    info.width = 80;
    info.height = 60;
    info.disparities = 16;
    info.step_log2 = 3;
    std::vector<std::uint16_t> values(std::size_t{info.width} * info.height, 8);
    tsr::MapPackets map = tsr::cut_map(info, values, 1280);
    std::ranges::fill(values, std::uint16_t{16});
    const tsr::MapPackets other = tsr::cut_map(info, values, TSR_MAP_PACKET_LEN_MIN);
    const std::size_t own = map.packets.size();
    map.packets.insert(map.packets.end(), other.packets.begin(), other.packets.end());
    tsr::MapOfPackets decoded = tsr::decode_map_packets(map, "input");
    EXPECT_EQ(decoded.found, own);
    EXPECT_EQ(decoded.missing_pixels, 0U);
    EXPECT_EQ(std::ranges::count(decoded.values_q4, 8), std::ssize(values));

    map.packets.erase(map.packets.begin() + 1, map.packets.begin() + static_cast<std::ptrdiff_t>(own));
    decoded = tsr::decode_map_packets(map, "input");
    EXPECT_EQ(decoded.values_q4.front(), 8);
    EXPECT_EQ(decoded.missing_pixels + static_cast<std::size_t>(std::ranges::count(decoded.values_q4, 8) +
                                                                std::ranges::count(decoded.values_q4, 16)),
              values.size());
}

} // namespace
