/*
 * tarsier encode MAP -o OUT.tdm [--step PX] [--near 1] [--packets N] [--against OLD --hold] [...]
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "coded_map_options.h"
#include "commands.h"
#include "tsr/coding/disparity_values.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"
#include "tsr/stereo/disparity_file.h"

namespace tsr
{
namespace
{

struct EncodeOptions {
    std::filesystem::path map;
    std::filesystem::path out;
    HeldMapOptions held;
    bool hold = false;
    double step_px = 0.5;
    unsigned near = 0;
    std::optional<unsigned> disparities;
    double d0_px = 0;
    std::optional<unsigned> packet_len;
    bool json = false;
};

/* Before anything is read. */
void check_files(const EncodeOptions &options)
{
    std::string ending = options.out.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending != ".tdm") {
        throw InputError(options.out.string(), "--out", "the name does not end in .tdm");
    }
    check_held_map(options.held);
    if (options.packet_len && !options.held.against.empty()) {
        throw InputError("command line", "--packets", "decode alone: leave out --against and --reference-id");
    }
    if (options.hold && options.held.against.empty()) {
        throw InputError("command line", "--hold", "holds to the map of --against, which is missing");
    }
    std::vector<std::filesystem::path> inputs = {options.map};
    if (!options.held.against.empty()) {
        inputs.push_back(options.held.against);
    }
    check_outputs({{options.out, "--out"}}, inputs);
}

std::int16_t d0_q4_of(const EncodeOptions &options)
{
    const double sixteenths = std::round(options.d0_px * TSR_DISPARITY_ONE_Q4);
    if (!(sixteenths >= std::numeric_limits<std::int16_t>::min() &&
          sixteenths <= std::numeric_limits<std::int16_t>::max())) {
        throw InputError("command line", "--d0", "takes -2048 .. 2047.9375 px");
    }
    return static_cast<std::int16_t>(sixteenths);
}

/* A value above the last disparity would become that one: refused if that moves it by more than half a step. */
void expect_room(const DisparityValues &map, const std::vector<std::uint16_t> &values, unsigned step_q4,
                 const std::filesystem::path &file)
{
    for (std::size_t i = 0; i < values.size(); i++) {
        if (2U * (map.values_q4[i] - std::min(values[i], map.values_q4[i])) > step_q4) {
            throw InputError(file.string(), "disparity",
                             fmt::format("{:g} px at ({}, {}), the last of --disparities {} is {}",
                                         static_cast<double>(map.values_q4[i]) / TSR_DISPARITY_ONE_Q4, i % map.width,
                                         i / map.width, map.disparities, map.disparities - 1));
        }
    }
}

/* Packets are decoded once more for what is printed: with near the values are others. */
int encode_packets(const EncodeOptions &options, const tsr_map_info &info, const std::vector<std::uint16_t> &values)
{
    const MapPackets packets = cut_map(info, values, *options.packet_len);
    const MapOfPackets decoded = decode_map_packets(packets, options.out);
    write_file_atomically(options.out, map_packet_file(packets));
    print_coded_map(figures_of(packets, decoded), decoded.values_q4, options.out, options.json);
    return 0;
}

int encode(const EncodeOptions &options)
{
    check_files(options);
    tsr_map_info info{};
    info.step_log2 = log2_of_step(options.step_px);
    info.near = static_cast<std::uint8_t>(options.near);
    info.d0_q4 = d0_q4_of(options);
    DisparityValues map = disparity_values(read_disparity_file(options.map), options.map);
    map.disparities = static_cast<std::uint16_t>(options.disparities.value_or(map.disparities));
    info.width = map.width;
    info.height = map.height;
    info.disparities = map.disparities;
    std::vector<std::uint16_t> values = quantised(map, info.step_log2);
    expect_room(map, values, 1U << info.step_log2, options.map);
    if (options.packet_len) {
        return encode_packets(options, info, values);
    }
    const std::optional<HeldMap> held = read_held_map(options.held, info, options.map);
    if (options.hold) {
        values = held_to(info, values, held->values_q4);
    }
    const CodedMap coded = encode_map(info, values, held);
    write_file_atomically(options.out, coded.bytes);
    print_coded_map(figures_of(coded), values, options.out, options.json);
    return 0;
}

} // namespace

Command declare_encode(CLI::App &command)
{
    auto options = std::make_shared<EncodeOptions>();
    command.add_option("map", options->map, "disparity map: PFM, or PNG of 16 bits, px = value / 256")->required();
    command.add_option("-o,--out", options->out, "the coded map: .tdm")->required()->check(refuse_empty_name);
    command.add_option("--step", options->step_px, "disparities become multiples of this, px")
        ->check(is_map_step())
        ->capture_default_str();
    command.add_option("--near", options->near, "1: a disparity may be one step off")
        ->check(CLI::Range(0, TSR_MAP_NEAR_MAX))
        ->capture_default_str();
    command.add_option("--disparities", options->disparities, "of the matcher, 1 .. 128; default: what the map needs")
        ->check(CLI::Range(1, static_cast<int>(TSR_DISPARITY_COUNT_MAX)));
    command.add_option("--d0", options->d0_px, "the pair's offset, px, to 1/16; only handed on")->capture_default_str();
    command
        .add_option("--packets", options->packet_len,
                    "packets that decode alone, of at most this many bytes; default: one stream")
        ->check(CLI::Range(TSR_MAP_PACKET_LEN_MIN, static_cast<int>(kMapPacketLenMax)));
    declare_held_map(command, options->held);
    command.add_flag("--hold", options->hold,
                     "keep what --against has where less than a matcher's window changed: noise moves edges");
    command.add_flag("--json", options->json, "print JSON");
    return [options] { return encode(*options); };
}

} // namespace tsr
