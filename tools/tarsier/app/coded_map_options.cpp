/*
 * Options and figures of coded maps.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "coded_map_options.h"

#include <algorithm>
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

void print_json(const CodedMap &coded, double density, const std::filesystem::path &out)
{
    const tsr_map_info &info = coded.info;
    const Json json = {{"width", info.width},
                       {"height", info.height},
                       {"bytes", coded.bytes.size()},
                       {"bits_per_pixel", coded.bits_per_pixel()},
                       {"density", density},
                       {"step_px", coded.step_px()},
                       {"near", info.near},
                       {"disparities", info.disparities},
                       {"d0_px", coded.d0_px()},
                       {"reference_id", info.has_reference ? Json(info.reference_id) : Json(nullptr)},
                       {"format_version", coded.format_version()},
                       {"prior", coded.prior()},
                       {"out", out.string()}};
    std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
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

CLI::Validator is_map_step()
{
    return CLI::IsMember({1.0, 0.5, 0.25, 0.125, 0.0625});
}

void print_coded_map(const CodedMap &coded, std::span<const std::uint16_t> values_q4, const std::filesystem::path &out,
                     bool json)
{
    const double density = density_of(values_q4);
    if (json) {
        print_json(coded, density, out);
        return;
    }
    const std::string reference =
        coded.info.has_reference ? "against map " + std::to_string(coded.info.reference_id) : "alone";
    std::printf("%s: %ux%u %s, %zu bytes coded, %.3f bits per pixel, %.1f %% valid, step %g px, near %u\n", out.c_str(),
                coded.info.width, coded.info.height, reference.c_str(), coded.bytes.size(), coded.bits_per_pixel(),
                100 * density, coded.step_px(), coded.info.near);
}

} // namespace tsr
