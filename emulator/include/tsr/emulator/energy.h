/*
 * Energy of a node by part, from what its parts did and for how long.
 *
 *   E = sum over states of U I t
 *
 * Every current is a data-sheet figure; docs/energy.md gives the sources and
 * says which could not be confirmed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_ENERGY_H
#define TSR_EMULATOR_ENERGY_H

#include <cstdint>

extern "C" {
#include "tsr/node/node.h"
}
#include "tsr/hal/air.h"

namespace tsr
{

struct PowerModel {
    double supply_v = 3.0;
    double radio_tx_ma = 6.40;    /* nRF52840 PS v1.7, 6.20.15.3: 0 dBm, DC/DC */
    double radio_rx_ma = 6.53;    /* same: 802.15.4, DC/DC */
    double radio_sleep_ma = 0.0;  /* counted in cpu_sleep_ma */
    double cpu_ua_per_mhz = 52.0; /* same, 5.2.1.1: running from flash, cache, DC/DC */
    double cpu_mhz = 64.0;
    double cpu_sleep_ma = 0.0032;        /* System ON with full RAM retention */
    double cycles_per_instruction = 1.3; /* an estimate; instructions are exact */
    double camera_mw = 2.0;              /* HM01B0 product brief: QVGA at 30 fps */
};

struct EnergyMj {
    double radio_tx = 0;
    double radio_rx = 0;
    double cpu = 0;
    double cpu_sleep = 0;
    double camera = 0;

    double total() const { return radio_tx + radio_rx + cpu + cpu_sleep + camera; }
};

/* Measured Cortex-M4 instructions of one unit of work (tsr/node/node.h), by
 * `tools/bench work`; see docs/energy.md. */
double instructions_per_unit(tsr_work_kind kind);

/* Time the processor takes for work, whole microseconds, at least 1. */
std::uint64_t work_time_us(const PowerModel &model, tsr_work_kind kind, std::uint32_t units);

EnergyMj energy_of(const PowerModel &model, const AirTimes &radio, std::uint64_t cpu_busy_us, std::uint64_t total_us,
                   std::uint64_t camera_us);

} // namespace tsr

#endif
