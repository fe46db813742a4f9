/*
 * How long a battery feeds a node: usable energy over mean power, with the
 * converter's losses and self-discharge as a constant current.
 *
 *   T = u U C / (P / eta + U I_q + U s C / year)       docs/energy.md, eq. (2)
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_BATTERY_H
#define TSR_EMULATOR_BATTERY_H

#include "tsr/host/site.h"

namespace tsr
{

struct BatteryLife {
    double usable_mj = 0;         /* u U C */
    double drawn_uw = 0;          /* from the cells: P / eta + U I_q */
    double self_discharge_uw = 0; /* lost in the cells, as long as they last: U s C / year */
    double days = 0;              /* infinite if nothing is drawn and nothing lost */
};

/* battery: of a checked site; load_uw: mean power of the node behind the converter, >= 0. */
BatteryLife battery_life(const SiteBattery &battery, double load_uw);

} // namespace tsr

#endif
