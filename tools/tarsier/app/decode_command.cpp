/*
 * tarsier decode MAP.tdm -o OUT [--against OLD --reference-id N] [--json]
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coded_map_options.h"
#include "commands.h"
#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"
#include "tsr/stereo/disparity_file.h"

namespace tsr
{
namespace
{

struct DecodeOptions {
    std::filesystem::path map;
    std::filesystem::path out;
    HeldMapOptions held;
    bool json = false;
};

/* Before anything is read. */
void check_files(const DecodeOptions &options)
{
    (void)disparity_format(options.out, "--out");
    check_held_map(options.held);
    std::vector<std::filesystem::path> inputs = {options.map};
    if (!options.held.against.empty()) {
        inputs.push_back(options.held.against);
    }
    check_outputs({{options.out, "--out"}}, inputs);
}

/* In terms of the options, where decode_map() would know only that something is missing. */
void check_reference(const tsr_map_info &info, const DecodeOptions &options)
{
    const std::optional<unsigned> &given = options.held.reference_id;
    if (!info.has_reference && given) {
        throw InputError(options.map.string(), "reference", "was coded alone: leave out --against and --reference-id");
    }
    if (!info.has_reference || given == std::optional<unsigned>{info.reference_id}) {
        return;
    }
    const std::string id = std::to_string(info.reference_id);
    throw InputError(options.map.string(), "reference",
                     "was coded against the map with id " + id +
                         (given ? ", --reference-id is " + std::to_string(*given)
                                : ": give it with --against FILE --reference-id " + id));
}

/* What is missing is invalid in the map; that there is something is told, no error. */
int decode_packets(const DecodeOptions &options, const std::vector<std::uint8_t> &bytes)
{
    const MapPackets packets = read_map_packets(bytes, options.map);
    check_reference(packets.info, options);
    const MapOfPackets decoded = decode_map_packets(packets, options.map);
    write_disparity_file(options.out, float_disparity(decoded.values_q4, packets.info.width, packets.info.height));
    print_coded_map(figures_of(packets, decoded), decoded.values_q4, options.out, options.json);
    return 0;
}

int decode(const DecodeOptions &options)
{
    check_files(options);
    std::vector<std::uint8_t> bytes = read_map_file(options.map);
    if (is_map_packet_file(bytes)) {
        return decode_packets(options, bytes);
    }
    const CodedMap coded = coded_map_of(std::move(bytes), options.map);
    check_reference(coded.info, options);
    const std::optional<HeldMap> held = read_held_map(options.held, coded.info, options.map);
    const std::vector<std::uint16_t> values = decode_map(coded, options.map, held);
    write_disparity_file(options.out, float_disparity(values, coded.info.width, coded.info.height));
    print_coded_map(figures_of(coded), values, options.out, options.json);
    return 0;
}

} // namespace

Command declare_decode(CLI::App &command)
{
    auto options = std::make_shared<DecodeOptions>();
    command.add_option("map", options->map, "coded map, as tarsier encode writes it")->required();
    command.add_option("-o,--out", options->out, "the map: .pfm, or .png of 16 bits, px = value / 256")
        ->required()
        ->check(refuse_empty_name);
    declare_held_map(command, options->held);
    command.add_flag("--json", options->json, "print JSON");
    return [options] { return decode(*options); };
}

} // namespace tsr
