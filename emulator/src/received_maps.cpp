/*
 * The sink's maps, read back from what it exported, against ground truth.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/run_record.h"

#include <nlohmann/json.hpp>

#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

namespace tsr
{

namespace
{

std::optional<MapError> error_of(const Site &site, Pictures &pictures, const ReceivedMap &map,
                                 const std::filesystem::path &out)
{
    const SitePair *pair = site.pair_of(map.node);
    const auto truth = pair != nullptr ? pictures.truth(*pair, map.capture_time_us) : std::nullopt;
    if (!truth) {
        return std::nullopt;
    }
    return compare_with_truth(read_pfm(out / (map.file + ".pfm")), truth->disparity_px, *pair, truth->name);
}

} // namespace

std::vector<ReceivedMap> read_received_maps(const Site &site, const Simulation &simulation, Pictures &pictures,
                                            const std::filesystem::path &out)
{
    const auto file = out / "sink.json";
    std::vector<ReceivedMap> maps;
    try {
        const auto json = nlohmann::json::parse(read_text_file(file));
        for (const auto &entry : json.at("received")) {
            ReceivedMap map;
            map.node = entry.at("node").get<std::uint16_t>();
            map.counter = entry.at("counter").get<std::uint32_t>();
            map.capture_time_us = simulation.virtual_us(map.node, entry.at("capture_time_us").get<std::uint64_t>());
            map.kept = entry.at("kept").get<bool>();
            map.map_bytes = entry.at("map_bytes").get<std::size_t>();
            map.reference_bytes = entry.at("reference_bytes").get<std::size_t>();
            map.file = entry.at("file").get<std::string>();
            maps.push_back(std::move(map));
        }
    } catch (const nlohmann::json::exception &error) {
        throw InputError(file.string(), "json", error.what());
    }
    for (ReceivedMap &map : maps) {
        map.error = error_of(site, pictures, map, out);
    }
    return maps;
}

} // namespace tsr
