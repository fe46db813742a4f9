/*
 * The energy ledger's arithmetic.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/energy.h"

#include <algorithm>
#include <array>

namespace tsr
{

double instructions_per_unit(tsr_work_kind kind)
{
    /* none, change, match, median, measure, compare, map encode, view filter, view encode, reference encode, view
     * decode, seal, copy; what each is the mean of: docs/energy.md. tests/budget/test_work_table.py holds it to the
     * measurement. */
    static constexpr std::array<double, TSR_WORK_COUNT> kInstructions = {0,  6.0, 3.95, 74.2, 12.8, 20,  156,
                                                                         32, 255, 176,  257,  128,  0.53};
    return kInstructions.at(kind);
}

std::uint64_t work_time_us(const PowerModel &model, tsr_work_kind kind, std::uint32_t units)
{
    return instructions_time_us(model, instructions_per_unit(kind) * units);
}

std::uint64_t instructions_time_us(const PowerModel &model, double instructions)
{
    const double cycles = instructions * model.cycles_per_instruction;
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(cycles / model.cpu_mhz));
}

namespace
{

/* What is left of total after used. */
std::uint64_t rest_of(std::uint64_t total_us, std::uint64_t used_us)
{
    return total_us - std::min(total_us, used_us);
}

/* mW us = nJ; 1e6 nJ = 1 mJ */
double millijoules(double power_mw, std::uint64_t time_us)
{
    return power_mw * static_cast<double>(time_us) / 1e6;
}

EnergyMj::Camera camera_energy(const PowerModel &model, const NodeTimes &times)
{
    const std::uint64_t capture_us = model.camera_start_us + times.exposure_us + times.readout_us;
    EnergyMj::Camera camera;
    camera.start = millijoules(model.camera_mw, times.captures * model.camera_start_us);
    camera.expose = millijoules(model.camera_mw, times.captures * times.exposure_us);
    camera.read = millijoules(model.camera_mw, times.captures * times.readout_us);
    camera.standby =
        millijoules(model.camera_standby_mw, rest_of(times.cameras * times.total_us, times.captures * capture_us));
    return camera;
}

} // namespace

double EnergyMj::total() const
{
    return radio.transmit + radio.assess + radio.acknowledge + radio.receive + radio.sleep + cpu.run + cpu.sleep +
           camera.start + camera.expose + camera.read + camera.standby + storage.write + storage.read +
           storage.standby + board;
}

EnergyMj energy_of(const PowerModel &model, const NodeTimes &times)
{
    const auto drawn = [&](double current_ma, std::uint64_t time_us) {
        return millijoules(current_ma * model.supply_v, time_us);
    };
    const AirTimes &radio = times.radio;
    EnergyMj energy;
    energy.radio.transmit = drawn(model.radio_tx_ma, radio.transmitting);
    energy.radio.assess = drawn(model.radio_rx_ma, radio.assessing);
    energy.radio.acknowledge = drawn(model.radio_tx_ma, radio.acknowledging) + drawn(model.radio_rx_ma, radio.awaiting);
    energy.radio.receive = drawn(model.radio_rx_ma, radio.receiving);
    energy.radio.sleep = drawn(model.radio_sleep_ma, radio.sleeping);
    energy.cpu.run = drawn(model.cpu_ua_per_mhz * model.cpu_mhz / 1000, times.cpu_busy_us);
    energy.cpu.sleep = drawn(model.cpu_sleep_ma, rest_of(times.total_us, times.cpu_busy_us));
    energy.camera = camera_energy(model, times);
    energy.storage.write = drawn(model.storage_write_ma, times.storage_writing_us);
    energy.storage.read = drawn(model.storage_read_ma, times.storage_reading_us);
    energy.storage.standby =
        drawn(model.storage_standby_ma, rest_of(times.total_us, times.storage_writing_us + times.storage_reading_us));
    energy.board = drawn(model.board_ma, times.total_us);
    return energy;
}

double active_mj(const PowerModel &model, const NodeTimes &times, std::uint64_t heard_us, const WatchTimes &watch)
{
    NodeTimes active = times;
    active.radio.receiving = std::min(times.radio.receiving, heard_us);
    active.cpu_busy_us = rest_of(times.cpu_busy_us, watch.cpu_us);
    active.captures = rest_of(times.captures, watch.captures);
    const EnergyMj energy = energy_of(model, active);
    return energy.radio.transmit + energy.radio.assess + energy.radio.acknowledge + energy.radio.receive +
           energy.cpu.run + energy.camera.start + energy.camera.expose + energy.camera.read;
}

} // namespace tsr
