/*
 * The sink's events, read back from what it exported.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <nlohmann/json.hpp>

#include "tsr/emulator/run_record.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

namespace tsr
{

std::vector<ReceivedEvent> read_received_events(const Simulation &simulation, const std::filesystem::path &out)
{
    const auto file = out / "sink.json";
    std::vector<ReceivedEvent> events;
    try {
        const auto json = nlohmann::json::parse(read_text_file(file));
        for (const auto &entry : json.at("events")) {
            ReceivedEvent event;
            event.node = entry.at("node").get<std::uint16_t>();
            event.counter = entry.at("counter").get<std::uint32_t>();
            event.capture_time_us = simulation.virtual_us(event.node, entry.at("capture_time_us").get<std::uint64_t>());
            event.zone = entry.at("zone").get<std::string>();
            event.kind = entry.at("kind").get<std::string>();
            event.area_percent = entry.at("area_percent").get<double>();
            if (!entry.at("depth_m").is_null()) {
                event.depth_m = entry.at("depth_m").get<double>();
            }
            events.push_back(std::move(event));
        }
    } catch (const nlohmann::json::exception &error) {
        throw InputError(file.string(), "json", error.what());
    }
    return events;
}

} // namespace tsr
