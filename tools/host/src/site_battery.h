/*
 * The fields of [battery] with their ranges, once for reading, checking and writing.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_SITE_BATTERY_H
#define TSR_HOST_SITE_BATTERY_H

#include <array>

#include "tsr/host/site.h"

namespace tsr
{

struct BatteryField {
    const char *name;
    double SiteBattery::*value;
    double minimum;
    double maximum;
};

inline constexpr std::array<BatteryField, 6> kBatteryFields = {{
    {"capacity_mah", &SiteBattery::capacity_mah, 1, 1e6},
    {"voltage_v", &SiteBattery::voltage_v, 0.5, 60},
    {"usable_percent", &SiteBattery::usable_percent, 1, 100},
    {"self_discharge_percent_year", &SiteBattery::self_discharge_percent_year, 0, 100},
    {"converter_efficiency_percent", &SiteBattery::converter_efficiency_percent, 1, 100},
    {"converter_quiescent_ua", &SiteBattery::converter_quiescent_ua, 0, 1e5},
}};

} // namespace tsr

#endif
