/*
 * A receiver of Air: what it follows, what interference costs, capture, CCA.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
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
        receiver.tune(kChannel, 0);
        receiver.listen(true, 0);
    }
    void begin(std::uint64_t number, std::uint64_t start_us, double dbm, std::uint8_t channel = kChannel)
    {
        receiver.begin({number, start_us, start_us + kFrameUs, level_q4(dbm), channel});
    }
    double end(std::uint64_t number, std::uint64_t start_us)
    {
        return static_cast<double>(receiver.end(number, start_us + kFrameUs).success_q32) / kCertainQ32;
    }
    /* A second frame, so much weaker and later. */
    double first_survives(double weaker_db, std::uint64_t later_us)
    {
        Receiver fresh(model);
        receiver = fresh;
        receiver.tune(kChannel, 0);
        receiver.listen(true, 0);
        begin(1, 0, -60);
        begin(2, later_us, -60 - weaker_db);
        const double success = end(1, 0);
        EXPECT_EQ(end(2, later_us), 0);
        return success;
    }

    ReceiverModel model;
    Receiver receiver;
};

TEST_F(AirReceiverTest, NoiseComesFromTheSensitivity)
{
    begin(1, 0, -95);
    receiver.end(1, 26 * 32); /* 20 octets */
    Receiver fresh(model);
    fresh.tune(kChannel, 0);
    fresh.listen(true, 0);
    fresh.begin({1, 0, 26 * 32, level_q4(-95), kChannel});
    const double success = static_cast<double>(fresh.end(1, 26 * 32).success_q32) / kCertainQ32;
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
    EXPECT_GT(end(1, 0), 0.99);
    end(2, 300);
    begin(3, 10'000, -60);
    begin(4, 10'300, -65);
    begin(5, 10'300, -65);
    begin(6, 10'300, -65);
    EXPECT_LT(end(3, 10'000), 0.3); /* 0.2 dB are left */
}

TEST_F(AirReceiverTest, LaterFrameTakesTheReceiverOnlyInThePreamble)
{
    begin(1, 0, -80);
    begin(2, 100, -70); /* preamble and SFD take 160 us */
    EXPECT_EQ(end(1, 0), 0);
    EXPECT_GT(end(2, 100), kWithoutDoubt);
    begin(3, 10'000, -80);
    begin(4, 10'160, -70);
    EXPECT_LT(end(3, 10'000), kHopeless); /* followed to its end, in vain */
    EXPECT_EQ(end(4, 10'160), 0);
    begin(5, 20'000, -80);
    begin(6, 20'100, -78); /* less than the capture margin */
    EXPECT_EQ(end(6, 20'100), 0);
}

TEST_F(AirReceiverTest, DeafReceiverLosesTheFrame)
{
    begin(1, 0, -60);
    receiver.listen(false, 1000);
    receiver.listen(true, 1001);
    EXPECT_EQ(end(1, 0), 0);
    begin(2, 10'000, -60);
    receiver.tune(20, 10'500);
    receiver.tune(kChannel, 10'501);
    EXPECT_EQ(end(2, 10'000), 0);
    begin(3, 20'000, -60, 20); /* elsewhere */
    begin(4, 20'100, -60);
    EXPECT_EQ(end(3, 20'000), 0);
    EXPECT_GT(end(4, 20'100), kWithoutDoubt);
}

TEST_F(AirReceiverTest, WhatIsTooWeakIsNotFollowed)
{
    begin(1, 0, -102);
    begin(2, 1000, -60);
    EXPECT_EQ(end(1, 0), 0);
    EXPECT_GT(end(2, 1000), kWithoutDoubt);
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
    end(1, 0);
    receiver.listen(false, 2999);
    begin(3, 3000, -85);
    receiver.listen(true, 3001);
    EXPECT_FALSE(clear(3500));
    EXPECT_TRUE(clear(3000 + kFrameUs)); /* at its end it is over, whoever is asked first */
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
    end(1, 0);
    EXPECT_FALSE(receiver.finish_cca());
    receiver.start_cca(10'000);
    begin(2, 10'100, -60);
    EXPECT_FALSE(receiver.finish_cca());
    begin(3, 11'000, -60, 20); /* another channel */
    end(2, 10'100);
    EXPECT_TRUE(clear(13'000));
}

} // namespace
} // namespace tsr
