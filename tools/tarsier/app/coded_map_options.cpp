/*
 * Options and figures of coded maps.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "coded_map_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"

namespace tsr
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr int kReferenceIdMax = 65535;

double density_of(std::span<const std::uint16_t> values_q4)
{
    const auto invalid = std::ranges::count(values_q4, TSR_DISPARITY_INVALID);
    return 1 - static_cast<double>(invalid) / static_cast<double>(values_q4.size());
}

std::string shape_of(unsigned width, unsigned height)
{
    return std::to_string(width) + "x" + std::to_string(height);
}

double bits_per_pixel(const CodedMapFigures &figures)
{
    return 8.0 * static_cast<double>(figures.len) / (static_cast<double>(figures.info.width) * figures.info.height);
}

double step_px(const tsr_map_info &info)
{
    return std::ldexp(1.0, info.step_log2) / TSR_DISPARITY_ONE_Q4;
}

Json json_of(const std::optional<PacketFigures> &packets)
{
    if (!packets) {
        return nullptr;
    }
    return {{"count", packets->count},
            {"found", packets->found},
            {"missing_pixels", packets->missing_pixels},
            {"damaged_bytes", packets->damaged_len}};
}

void print_json(const CodedMapFigures &figures, double density, const std::filesystem::path &out)
{
    const tsr_map_info &info = figures.info;
    const Json json = {{"width", info.width},
                       {"height", info.height},
                       {"bytes", figures.len},
                       {"bits_per_pixel", bits_per_pixel(figures)},
                       {"density", density},
                       {"step_px", step_px(info)},
                       {"near", info.near},
                       {"disparities", info.disparities},
                       {"d0_px", static_cast<double>(info.d0_q4) / TSR_DISPARITY_ONE_Q4},
                       {"reference_id", info.has_reference ? Json(info.reference_id) : Json(nullptr)},
                       {"format_version", figures.format_version},
                       {"prior", figures.prior ? Json(*figures.prior) : Json(nullptr)},
                       {"packets", json_of(figures.packets)},
                       {"out", out.string()}};
    std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
}

/* How it was coded; of packets also what is not there. */
std::string manner_of(const CodedMapFigures &figures)
{
    if (figures.packets) {
        const PacketFigures &packets = *figures.packets;
        const std::string count = std::to_string(packets.count);
        if (packets.missing_pixels == 0 && packets.damaged_len == 0) {
            return "in " + count + (packets.count == 1 ? " packet" : " packets");
        }
        return "in packets, " + std::to_string(packets.found) + " of " + count + " intact, " +
               std::to_string(packets.missing_pixels) + " px missing, " + std::to_string(packets.damaged_len) +
               " bytes damaged";
    }
    return figures.info.has_reference ? "against map " + std::to_string(figures.info.reference_id) : "alone";
}

} // namespace

void declare_held_map(CLI::App &command, HeldMapOptions &options)
{
    command
        .add_option("--against", options.against,
                    "earlier map that both sides hold: .tdm coded alone, or a map file, which is quantised")
        ->check(refuse_empty_name);
    command.add_option("--reference-id", options.reference_id, "what both sides call that map, 0 .. 65535")
        ->check(CLI::Range(0, kReferenceIdMax));
}

void check_held_map(const HeldMapOptions &options)
{
    if (options.against.empty() && options.reference_id) {
        throw InputError("command line", "--reference-id", "names the map of --against, which is missing");
    }
    if (!options.against.empty() && !options.reference_id) {
        throw InputError("command line", "--against", "needs --reference-id, what both sides call that map");
    }
}

std::optional<HeldMap> read_held_map(const HeldMapOptions &options, const tsr_map_info &map,
                                     const std::filesystem::path &map_file)
{
    if (options.against.empty()) {
        return std::nullopt;
    }
    HeldMap held =
        read_held_map(options.against, static_cast<std::uint16_t>(options.reference_id.value_or(0)), map.step_log2);
    if (held.width != map.width || held.height != map.height) {
        throw InputError(options.against.string(), "size",
                         shape_of(held.width, held.height) + ", " + map_file.string() + " has " +
                             shape_of(map.width, map.height));
    }
    return held;
}

/* CLI::IsMember takes an empty word for one of its members. */
CLI::Validator is_map_step()
{
    const auto check = [](const std::string &text) {
        constexpr std::array<double, TSR_MAP_STEP_LOG2_MAX + 1> kSteps = {1, 0.5, 0.25, 0.125, 0.0625};
        double step = 0;
        const bool is_one = CLI::detail::lexical_cast(text, step) && std::ranges::find(kSteps, step) != kSteps.end();
        return is_one ? std::string() : "'" + text + "' is none of 1, 0.5, 0.25, 0.125 and 0.0625";
    };
    return {check, "1, 0.5, 0.25, 0.125 or 0.0625"};
}

CodedMapFigures figures_of(const CodedMap &coded)
{
    return {coded.info, coded.bytes.size(), coded.format_version(), coded.prior(), std::nullopt};
}

CodedMapFigures figures_of(const MapPackets &packets, const MapOfPackets &decoded)
{
    return {packets.info, packets.len(), TSR_MAP_PACKET_FORMAT_VERSION, std::nullopt,
            PacketFigures{packets.count, decoded.found, decoded.missing_pixels, packets.damaged_len}};
}

void print_coded_map(const CodedMapFigures &figures, std::span<const std::uint16_t> values_q4,
                     const std::filesystem::path &out, bool json)
{
    const double density = density_of(values_q4);
    if (json) {
        print_json(figures, density, out);
        return;
    }
    std::printf("%s: %ux%u %s, %zu bytes coded, %.3f bits per pixel, %.1f %% valid, step %g px, near %u\n", out.c_str(),
                figures.info.width, figures.info.height, manner_of(figures).c_str(), figures.len,
                bits_per_pixel(figures), 100 * density, step_px(figures.info), figures.info.near);
}

} // namespace tsr
