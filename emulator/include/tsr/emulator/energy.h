/*
 * Energy of a node by part and state, from what its parts did and for how long.
 *
 *   E = sum over parts and their states of U I t       docs/energy.md, eq. (1)
 *
 * Currents come from data sheets, or are assumptions where no sheet says:
 * docs/energy.md gives each one's source and whether it could be confirmed.
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

/* In docs/energy.md's order. */
struct PowerModel {
    double supply_v = 3.0;
    double radio_tx_ma = 6.40;             /* nRF52840, IRADIO_TX5: 802.15.4, 0 dBm, DC/DC */
    double radio_rx_ma = 6.53;             /* IRADIO_RX2: 802.15.4, DC/DC; senses and waits with it too */
    double radio_sleep_ma = 0.0;           /* one chip: counted in cpu_sleep_ma */
    double cpu_ua_per_mhz = 52.0;          /* running from flash, cache, DC/DC */
    double cpu_mhz = 64.0;                 /* its only clock */
    double cpu_sleep_ma = 0.0032;          /* System ON, all of the RAM, RTC */
    double cycles_per_instruction = 1.3;   /* an estimate; instructions are exact */
    double camera_mw = 2.0;                /* HM01B0, QVGA: start-up, exposure and readout alike */
    double camera_standby_mw = 0.1;        /* an assumption */
    std::uint64_t camera_start_us = 5'000; /* an assumption: from standby to the start of exposure */
    double storage_write_ma = 6.0;         /* MX25R6435F: programming or erasing */
    double storage_read_ma = 4.0;          /* reading, one line */
    double storage_standby_ma = 0.005;     /* not selected, not in deep power-down */
    double board_ma = 0.001;               /* leakage of capacitors and pull-ups: an assumption */
};

/* What the parts of one node did. */
struct NodeTimes {
    std::uint64_t total_us = 0;
    AirTimes radio;
    std::uint64_t cpu_busy_us = 0; /* at most total_us */
    unsigned cameras = 0;          /* sensors on the board */
    std::uint64_t captures = 0;    /* of all of them */
    std::uint64_t exposure_us = 0; /* of one capture */
    std::uint64_t readout_us = 0;
    std::uint64_t storage_writing_us = 0; /* nodes do not store yet: 0 */
    std::uint64_t storage_reading_us = 0;
};

/* mJ, never negative. */
struct EnergyMj {
    struct Radio {
        double transmit = 0;
        double assess = 0;      /* CCA and turnaround */
        double acknowledge = 0; /* sending acknowledgements and waiting for them */
        double receive = 0;
        double sleep = 0;
    } radio;
    struct Cpu {
        double run = 0;
        double sleep = 0;
    } cpu;
    struct Camera {
        double start = 0;
        double expose = 0;
        double read = 0;
        double standby = 0;
    } camera;
    struct Storage {
        double write = 0;
        double read = 0;
        double standby = 0;
    } storage;
    double board = 0;

    double total() const;
};

/* Measured Cortex-M4 instructions of one unit of work (tsr/node/node.h), by
 * `tools/bench work`; see docs/energy.md. */
double instructions_per_unit(tsr_work_kind kind);

/* Time the processor takes for work, whole microseconds, at least 1. */
std::uint64_t work_time_us(const PowerModel &model, tsr_work_kind kind, std::uint32_t units);
std::uint64_t instructions_time_us(const PowerModel &model, double instructions);

/* A part's standby or sleep is what its other states leave of total_us, at least nothing. */
EnergyMj energy_of(const PowerModel &model, const NodeTimes &times);

/* Of NodeTimes, what a node does whatever happens. */
struct WatchTimes {
    std::uint64_t cpu_us = 0; /* comparing frames with the background */
    std::uint64_t captures = 0;
};

/* mJ of what was done because of changes: frames sent, heard and acknowledged, captures of woken pairs, and the
 * processor but for watching. Idle listening, watching, standby and sleep are not in it. heard_us: time on air of
 * frames that the node got; it is part of radio.receiving. docs/energy.md, eq. (3) */
double active_mj(const PowerModel &model, const NodeTimes &times, std::uint64_t heard_us, const WatchTimes &watch);

} // namespace tsr

#endif
