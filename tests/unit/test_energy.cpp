/*
 * The energy ledger and a battery's life, against sums done by hand.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>

#include <gtest/gtest.h>

#include "tsr/emulator/battery.h"
#include "tsr/emulator/energy.h"

namespace tsr
{
namespace
{

constexpr double kExact = 1e-9;

NodeTimes ten_seconds()
{
    NodeTimes times;
    times.total_us = 10'000'000;
    times.radio = {100'000, 50'000, 20'000, 10'000, 1'000'000, 8'820'000};
    times.cpu_busy_us = 2'000'000;
    times.cameras = 2;
    times.captures = 6;
    times.exposure_us = 10'000;
    times.readout_us = 20'000;
    times.storage_writing_us = 500'000;
    times.storage_reading_us = 250'000;
    return times;
}

TEST(Energy, EachStateIsVoltageTimesCurrentTimesTime)
{
    const EnergyMj energy = energy_of(PowerModel{}, ten_seconds());
    EXPECT_NEAR(energy.radio.transmit, 1.92, kExact);      /* 6.40 mA 3 V 0.1 s */
    EXPECT_NEAR(energy.radio.assess, 0.9795, kExact);      /* 6.53 mA 3 V 0.05 s */
    EXPECT_NEAR(energy.radio.acknowledge, 0.5838, kExact); /* 6.40 mA 3 V 0.01 s + 6.53 mA 3 V 0.02 s */
    EXPECT_NEAR(energy.radio.receive, 19.59, kExact);
    EXPECT_EQ(energy.radio.sleep, 0);                  /* the processor's sleep has it */
    EXPECT_NEAR(energy.cpu.run, 19.968, kExact);       /* 3.328 mA 3 V 2 s */
    EXPECT_NEAR(energy.cpu.sleep, 0.0768, kExact);     /* 3.2 uA 3 V 8 s */
    EXPECT_NEAR(energy.camera.start, 0.06, kExact);    /* 2 mW, 6 times 5 ms */
    EXPECT_NEAR(energy.camera.expose, 0.12, kExact);   /* 10 ms */
    EXPECT_NEAR(energy.camera.read, 0.24, kExact);     /* 20 ms */
    EXPECT_NEAR(energy.camera.standby, 1.979, kExact); /* 0.1 mW, twice 10 s without 6 times 35 ms */
    EXPECT_NEAR(energy.storage.write, 9, kExact);
    EXPECT_NEAR(energy.storage.read, 3, kExact);
    EXPECT_NEAR(energy.storage.standby, 0.13875, kExact); /* 5 uA 3 V 9.25 s */
    EXPECT_NEAR(energy.board, 0.03, kExact);
    EXPECT_NEAR(energy.total(), 57.68585, kExact);
}

TEST(Energy, NothingDoneForNoTimeCostsNothing)
{
    EXPECT_EQ(energy_of(PowerModel{}, NodeTimes{}).total(), 0);
}

/* Of ten_seconds(): 0.3 s heard, half a second and two captures for watching. */
TEST(Energy, ActiveIsWhatChangesCost)
{
    const double radio = 1.92 + 0.9795 + 0.5838 + 5.877; /* the last: 6.53 mA 3 V 0.3 s */
    const double cpu = 14.976;                           /* 3.328 mA 3 V 1.5 s */
    const double cameras = 0.28;                         /* 2 mW, 4 times 35 ms */
    EXPECT_NEAR(active_mj(PowerModel{}, ten_seconds(), 300'000, {500'000, 2}), radio + cpu + cameras, kExact);
}

TEST(Energy, ANodeThatOnlyWatchesIsNotActive)
{
    NodeTimes times = ten_seconds();
    times.radio = {0, 0, 0, 0, 10'000'000, 0};
    EXPECT_EQ(active_mj(PowerModel{}, times, 0, {times.cpu_busy_us, times.captures}), 0);
}

TEST(Energy, ABoardWithoutCamerasHasNoStandbyOfThem)
{
    NodeTimes times = ten_seconds();
    times.cameras = 0;
    times.captures = 0;
    const EnergyMj energy = energy_of(PowerModel{}, times);
    EXPECT_EQ(energy.camera.start + energy.camera.expose + energy.camera.read + energy.camera.standby, 0);
}

TEST(Energy, WhatIsBusyAllTheTimeNeverRests)
{
    NodeTimes times = ten_seconds();
    times.cpu_busy_us = times.total_us + 1; /* the last step of a run may end after it */
    times.captures = 1'000'000;
    times.storage_writing_us = times.total_us;
    const EnergyMj energy = energy_of(PowerModel{}, times);
    EXPECT_EQ(energy.cpu.sleep, 0);
    EXPECT_EQ(energy.camera.standby, 0);
    EXPECT_EQ(energy.storage.standby, 0);
}

TEST(Energy, AYearDoesNotOverflow)
{
    NodeTimes times;
    times.total_us = 366ull * 86'400 * 1'000'000;
    times.cameras = 2;
    times.captures = 2 * 366ull * 86'400;
    times.exposure_us = 10'000;
    times.readout_us = 20'000;
    times.radio.receiving = times.total_us;
    EXPECT_NEAR(energy_of(PowerModel{}, times).radio.receive / 1000, 19.59e-3 * 366 * 86'400, 1e-3); /* J */
}

TEST(Battery, LifeIsUsableEnergyOverPower)
{
    const SiteBattery battery{1000, 3, 80, 0, 50, 0};
    const BatteryLife life = battery_life(battery, 1000);
    EXPECT_NEAR(life.usable_mj, 8.64e6, 1e-3); /* 80 % of 1 Ah 3 V = 2.4 Wh */
    EXPECT_NEAR(life.drawn_uw, 2000, kExact);  /* half of it is lost in the converter */
    EXPECT_EQ(life.self_discharge_uw, 0);
    EXPECT_NEAR(life.days, 50, kExact); /* 2.4 Wh / 2 mW = 1200 h */
}

/* 27.72 Wh, 23.562 of them usable; 277.2 mWh a year is 31.622 uW. */
TEST(Battery, TheDefaultFeedsAListenerForSixWeeks)
{
    const BatteryLife life = battery_life(SiteBattery{}, 19'600);
    EXPECT_NEAR(life.drawn_uw, 21'779.434, 1e-3); /* 19600 / 0.9 + 3.6 V 0.46 uA */
    EXPECT_NEAR(life.self_discharge_uw, 31.622, 1e-3);
    EXPECT_NEAR(life.days, 45.012, 1e-3);
}

TEST(Battery, WithoutALoadItDischargesItself)
{
    EXPECT_NEAR(battery_life(SiteBattery{}, 0).days, 23'562'000 / (1.656 + 31.6222) / 24, 1);
    SiteBattery alone;
    alone.usable_percent = 100;
    alone.self_discharge_percent_year = 1;
    alone.converter_quiescent_ua = 0;
    EXPECT_NEAR(battery_life(alone, 0).days, 36'525, 1e-6); /* a hundred years */
}

TEST(Battery, WhatLosesNothingLastsForever)
{
    SiteBattery battery;
    battery.self_discharge_percent_year = 0;
    battery.converter_quiescent_ua = 0;
    EXPECT_TRUE(std::isinf(battery_life(battery, 0).days));
}

TEST(Battery, MorePowerIsNeverALongerLife)
{
    double before = battery_life(SiteBattery{}, 0).days;
    for (double load_uw = 1; load_uw < 1e9; load_uw *= 3) {
        const double days = battery_life(SiteBattery{}, load_uw).days;
        EXPECT_LT(days, before);
        EXPECT_GT(days, 0);
        before = days;
    }
}

/* Cells lose a part of what is left: dQ/dt = -I - k Q, T = ln(1 + k Q / I) / k. The constant current is below that, by
 * less than a twentieth for lives up to ten years. */
TEST(Battery, ConstantSelfDischargeIsALittlePessimistic)
{
    SiteBattery battery;
    battery.usable_percent = 100;
    for (const double load_uw : {300.0, 1000.0, 20'000.0}) {
        const BatteryLife life = battery_life(battery, load_uw);
        const double k_per_day = -std::log1p(-battery.self_discharge_percent_year / 100) / 365.25;
        const double exact = std::log1p(k_per_day * life.usable_mj / (life.drawn_uw * 86.4)) / k_per_day;
        EXPECT_LE(life.days, exact);
        EXPECT_GE(life.days, 0.95 * exact) << load_uw;
    }
}

} // namespace
} // namespace tsr
