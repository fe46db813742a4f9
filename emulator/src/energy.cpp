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
    /* none, change, match, median, compare, map encode, view filter, view encode, reference encode, view decode, seal,
     * copy; what each is the mean of: docs/energy.md. tests/budget/test_work_table.py holds it to the measurement. */
    static constexpr std::array<double, TSR_WORK_COUNT> kInstructions = {0,  6.0, 3.95, 74.2, 20,  156,
                                                                         32, 255, 176,  257,  128, 0.53};
    return kInstructions.at(kind);
}

std::uint64_t work_time_us(const PowerModel &model, tsr_work_kind kind, std::uint32_t units)
{
    const double cycles = instructions_per_unit(kind) * units * model.cycles_per_instruction;
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(cycles / model.cpu_mhz));
}

EnergyMj energy_of(const PowerModel &model, const AirTimes &radio, std::uint64_t cpu_busy_us, std::uint64_t total_us,
                   std::uint64_t camera_us)
{
    /* mA V us = nJ; 1e6 nJ = 1 mJ */
    const auto millijoules = [&](double current_ma, std::uint64_t time_us) {
        return current_ma * model.supply_v * static_cast<double>(time_us) / 1e6;
    };
    EnergyMj energy;
    energy.radio_tx = millijoules(model.radio_tx_ma, radio.transmitting);
    energy.radio_rx = millijoules(model.radio_rx_ma, radio.receiving);
    energy.cpu = millijoules(model.cpu_ua_per_mhz * model.cpu_mhz / 1000, cpu_busy_us);
    energy.cpu_sleep = millijoules(model.cpu_sleep_ma, total_us - std::min(total_us, cpu_busy_us));
    energy.camera = model.camera_mw * static_cast<double>(camera_us) / 1e6;
    return energy;
}

} // namespace tsr
