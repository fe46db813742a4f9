/*
 * A battery's life.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/battery.h"

#include <limits>

namespace tsr
{

namespace
{

constexpr double kHoursPerYear = 8766; /* 365.25 days */
constexpr double kMjPerUwDay = 86.4;   /* 1e-6 W for 86400 s */

} // namespace

BatteryLife battery_life(const SiteBattery &battery, double load_uw)
{
    const double full_mwh = battery.voltage_v * battery.capacity_mah;
    BatteryLife life;
    life.usable_mj = battery.usable_percent / 100 * full_mwh * 3600; /* mWh = 3.6 J */
    life.drawn_uw =
        load_uw / (battery.converter_efficiency_percent / 100) + battery.voltage_v * battery.converter_quiescent_ua;
    life.self_discharge_uw = battery.self_discharge_percent_year / 100 * full_mwh / kHoursPerYear * 1000;
    const double lost_uw = life.drawn_uw + life.self_discharge_uw;
    life.days = lost_uw > 0 ? life.usable_mj / (lost_uw * kMjPerUwDay) : std::numeric_limits<double>::infinity();
    return life;
}

} // namespace tsr
