/*
 * A receiver of Air: what it follows, what interference costs, capture, CCA.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <map>

#include <gtest/gtest.h>

#include "tsr/hal/air/decibel.h"
#include "tsr/hal/air/receiver.h"

namespace tsr
{
namespace
{

using namespace air;

constexpr std::uint8_t kChannel = 15;
constexpr std::uint64_t kFrameUs = 66 * 32; /* 60 octets */
constexpr double kWithoutDoubt = 0.999;
constexpr double kHopeless = 0.001;

class AirReceiverTest : public testing::Test
{
  protected:
    explicit AirReceiverTest(AirModel air_model = {}) : model(air_model), receiver(model)
    {
        receiver.tune(kChannel, {}, 0);
        receiver.listen(true, 0);
    }
    void begin(std::uint64_t number, std::uint64_t start_us, double dbm, std::uint8_t channel = kChannel)
    {
        const Signal signal{number, start_us, start_us + kFrameUs, level_q4(dbm), channel};
        receiver.begin(signal);
        on_air[number] = signal;
    }
    void fade(std::uint64_t number)
    {
        const Signal signal = on_air.at(number);
        receiver.fade(signal.level_q4, signal.channel, signal.end_us);
        on_air.erase(number);
    }
    double end(std::uint64_t number)
    {
        if (on_air.contains(number)) {
            fade(number);
        }
        return static_cast<double>(receiver.end(number).success_q32) / kCertainQ32;
    }
    /* A second frame, so much weaker and later. */
    double first_survives(double weaker_db, std::uint64_t later_us)
    {
        receiver = Receiver(model);
        receiver.tune(kChannel, {}, 0);
        receiver.listen(true, 0);
        begin(1, 0, -60);
        begin(2, later_us, -60 - weaker_db);
        const double success = end(1);
        EXPECT_EQ(end(2), 0);
        return success;
    }

    ReceiverModel model;
    Receiver receiver;
    std::map<std::uint64_t, Signal> on_air;
};

TEST_F(AirReceiverTest, NoiseComesFromTheSensitivity)
{
    Receiver fresh(model);
    fresh.tune(kChannel, {}, 0);
    fresh.listen(true, 0);
    fresh.begin({1, 0, 26 * 32, level_q4(-95), kChannel}); /* 20 octets */
    fresh.fade(level_q4(-95), kChannel, 26 * 32);
    const double success = static_cast<double>(fresh.end(1).success_q32) / kCertainQ32;
    EXPECT_GE(success, 0.99);
    EXPECT_LT(success, 0.993);
}

TEST_F(AirReceiverTest, StrongerFrameSurvivesTheOverlap)
{
    EXPECT_GT(first_survives(6, 500), kWithoutDoubt);
    EXPECT_LT(first_survives(0, 500), 0.05);
    EXPECT_LT(first_survives(-3, 500), kHopeless);
    /* At the capture margin a frame of 20 octets would be lost with 1 %, one of 60 with less than 4. */
    EXPECT_GT(first_survives(3, 0), 0.96);
    EXPECT_LT(first_survives(3, 0), 0.99);
}

TEST_F(AirReceiverTest, OverlapCountsAsLongAsItLasts)
{
    const double little = first_survives(1.5, kFrameUs - 100);
    const double half = first_survives(1.5, kFrameUs / 2);
    const double all = first_survives(1.5, 0);
    EXPECT_GT(little, half);
    EXPECT_GT(half, all);
    /* Bits fail independently: twice the overlap, the square of the survival. */
    EXPECT_NEAR(half * half, all, 0.01);
}

TEST_F(AirReceiverTest, InterferenceAddsUp)
{
    begin(1, 0, -60);
    begin(2, 300, -65);
    EXPECT_GT(end(1), 0.99);
    end(2);
    begin(3, 10'000, -60);
    begin(4, 10'300, -65);
    begin(5, 10'300, -65);
    begin(6, 10'300, -65);
    EXPECT_LT(end(3), 0.3); /* 0.2 dB are left */
}

TEST_F(AirReceiverTest, LaterFrameTakesTheReceiverOnlyInThePreamble)
{
    begin(1, 0, -80);
    begin(2, 100, -70); /* preamble and SFD take 160 us */
    EXPECT_EQ(end(1), 0);
    EXPECT_GT(end(2), kWithoutDoubt);
    begin(3, 10'000, -80);
    begin(4, 10'160, -70);
    EXPECT_LT(end(3), kHopeless); /* followed to its end, in vain */
    EXPECT_EQ(end(4), 0);
    begin(5, 20'000, -80);
    begin(6, 20'100, -78); /* less than the capture margin */
    EXPECT_EQ(end(6), 0);
}

TEST_F(AirReceiverTest, DeafReceiverLosesTheFrame)
{
    begin(1, 0, -60);
    receiver.listen(false, 1000);
    receiver.listen(true, 1001);
    EXPECT_EQ(end(1), 0);
    begin(2, 10'000, -60);
    const int level = level_q4(-60);
    receiver.tune(20, {}, 10'500);
    receiver.tune(kChannel, {&level, 1}, 10'501);
    EXPECT_EQ(end(2), 0);
    begin(3, 20'000, -60, 20); /* elsewhere */
    begin(4, 20'100, -60);
    EXPECT_EQ(end(3), 0);
    EXPECT_GT(end(4), kWithoutDoubt);
}

TEST_F(AirReceiverTest, WhatIsTooWeakIsNotFollowed)
{
    begin(1, 0, -102);
    begin(2, 1000, -60);
    EXPECT_EQ(end(1), 0);
    EXPECT_GT(end(2), kWithoutDoubt);
}

TEST_F(AirReceiverTest, WhatNobodyWantsHoldsTheReceiverAllTheSame)
{
    begin(1, 0, -80);
    receiver.disregard();
    begin(2, 1000, -60);
    receiver.start_cca(1500);
    EXPECT_FALSE(receiver.finish_cca());
    EXPECT_EQ(end(1), 0);
    EXPECT_EQ(end(2), 0);
    begin(3, 10'000, -80);
    EXPECT_GT(end(3), kWithoutDoubt);
}

/* What was on air on the other channel when it was tuned to disturbs as what begins later. */
TEST_F(AirReceiverTest, TuningMeetsWhatIsOnAirThere)
{
    const int level = level_q4(-60);
    receiver.tune(20, {&level, 1}, 0);
    begin(1, 100, -60, 20);
    EXPECT_LT(end(1), 0.05);
    receiver.fade(level, 20, 4000);
    begin(2, 5000, -60, 20);
    EXPECT_GT(end(2), kWithoutDoubt);
}

class AirCcaTest : public AirReceiverTest
{
  protected:
    bool clear(std::uint64_t start_us)
    {
        receiver.start_cca(start_us);
        return receiver.finish_cca();
    }
};

TEST_F(AirCcaTest, EnergyFromTheThresholdOnMakesItBusy)
{
    receiver.listen(false, 0); /* it has missed the preambles: energy alone decides */
    begin(1, 0, -85.1);
    receiver.listen(true, 500);
    EXPECT_TRUE(clear(500));
    begin(2, 600, -110);
    EXPECT_TRUE(clear(700));
    end(1);
    receiver.listen(false, 2999);
    begin(3, 3000, -85);
    receiver.listen(true, 3001);
    EXPECT_FALSE(clear(3500));
    fade(3);
    EXPECT_TRUE(clear(3000 + kFrameUs)); /* at its end it is over */
}

TEST_F(AirCcaTest, TwoWeakOnesAddUp)
{
    receiver.listen(false, 0);
    begin(1, 0, -87.5);
    begin(2, 0, -87.5);
    receiver.listen(true, 10);
    EXPECT_FALSE(clear(100));
}

TEST_F(AirCcaTest, FollowedFrameMakesItBusyHoweverWeak)
{
    begin(1, 0, -94);
    EXPECT_FALSE(clear(100));
}

TEST_F(AirCcaTest, WhatEndsOrBeginsWithinItsTimeCounts)
{
    begin(1, 0, -60);
    receiver.start_cca(kFrameUs - 50);
    end(1);
    EXPECT_FALSE(receiver.finish_cca());
    receiver.start_cca(10'000);
    begin(2, 10'100, -60);
    EXPECT_FALSE(receiver.finish_cca());
    begin(3, 11'000, -60, 20); /* another channel */
    end(2);
    EXPECT_TRUE(clear(13'000));
}

} // namespace
} // namespace tsr
