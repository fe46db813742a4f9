/*
 * Air: who hears what, acknowledgements and their times, what a test may decide.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "tsr/emulator/event_queue.h"
#include "tsr/hal/air.h"

namespace tsr
{
namespace
{

using Psdu = std::vector<std::uint8_t>;

struct Heard {
    std::uint64_t time_us;
    Psdu psdu;
    int rssi_dbm;
};

struct Ended {
    std::uint64_t time_us; /* of the event's delivery */
    std::uint64_t frame_end_us;
    tsr_radio_outcome outcome;
};

constexpr std::uint16_t kPan = 0xbeef;
constexpr std::uint64_t kSenseUs = TSR_RADIO_CCA_US + TSR_RADIO_TURNAROUND_US;

std::uint64_t on_air_us(std::size_t psdu_len)
{
    return (TSR_RADIO_PHY_HEADER_OCTETS + psdu_len) * TSR_RADIO_OCTET_US;
}

/* Radios in a line, radio i with address i + 1. */
class AirTest : public testing::Test
{
  protected:
    void place(std::initializer_list<double> metres, AirModel model = {})
    {
        air = std::make_unique<Air>(model, Air::Clock{[this] { return queue.now_us(); },
                                                      [this](std::uint64_t at_us, std::function<void()> action) {
                                                          queue.at(at_us, std::move(action));
                                                      }});
        heard.resize(metres.size());
        ended.resize(metres.size());
        for (const double x : metres) {
            const std::size_t index = air->add_radio({x, 0, 0}, [this, i = count_++](const tsr_radio_event &event) {
                if (event.kind == TSR_RADIO_RECEIVED) {
                    heard[i].push_back({event.time_us,
                                        {event.received.psdu, event.received.psdu + event.received.psdu_len},
                                        event.received.rssi_dbm});
                    if (sleep_when_heard) {
                        receive(i, false);
                    }
                } else {
                    ended[i].push_back({queue.now_us(), event.time_us, event.outcome});
                }
            });
            const tsr_radio radio = air->radio(index);
            EXPECT_EQ(radio.ops->configure(radio.self, 15, kPan, static_cast<std::uint16_t>(index + 1)), TSR_OK);
            receive(index, true);
        }
    }
    void receive(std::size_t index, bool on)
    {
        const tsr_radio radio = air->radio(index);
        EXPECT_EQ(radio.ops->set_receiving(radio.self, on), TSR_OK);
    }
    tsr_status transmit(std::size_t index, const Psdu &psdu)
    {
        const tsr_radio radio = air->radio(index);
        return radio.ops->transmit(radio.self, psdu.data(), psdu.size());
    }
    static Psdu frame_to(std::uint16_t address, std::size_t len = 40, bool ack = true)
    {
        Psdu psdu(len, 0x5a);
        psdu[0] = ack ? 0x69 : 0x49;
        psdu[1] = 0x98;
        psdu[2] = 0x77;
        psdu[3] = kPan & 0xff;
        psdu[4] = kPan >> 8;
        psdu[5] = static_cast<std::uint8_t>(address);
        psdu[6] = static_cast<std::uint8_t>(address >> 8);
        return psdu;
    }
    void run()
    {
        while (!queue.empty()) {
            queue.run_next();
        }
    }

    EventQueue queue;
    std::unique_ptr<Air> air;
    std::vector<std::vector<Heard>> heard;
    std::vector<std::vector<Ended>> ended;
    bool sleep_when_heard = false;

  private:
    std::size_t count_ = 0;
};

TEST_F(AirTest, AddressedFrameIsHeardAndAcknowledged)
{
    place({0, 10, 20});
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    EXPECT_EQ(transmit(0, frame_to(2)), TSR_ERR_BUSY);
    run();
    const std::uint64_t end_us = kSenseUs + on_air_us(40);
    ASSERT_EQ(heard[1].size(), 1u);
    EXPECT_EQ(heard[1][0].psdu, frame_to(2));
    EXPECT_EQ(heard[1][0].time_us, end_us);
    EXPECT_EQ(heard[1][0].rssi_dbm, -70); /* 0 - 40 - 30 log10(10) */
    EXPECT_TRUE(heard[2].empty());
    ASSERT_EQ(ended[0].size(), 1u);
    EXPECT_EQ(ended[0][0].outcome, TSR_RADIO_ACKED);
    EXPECT_EQ(ended[0][0].frame_end_us, end_us); /* the instant both ends know */
    EXPECT_EQ(ended[0][0].time_us, end_us + TSR_RADIO_TURNAROUND_US + on_air_us(5));
    EXPECT_EQ(transmit(0, frame_to(2)), TSR_OK);
}

TEST_F(AirTest, NobodyAnswers)
{
    place({0, 10});
    ASSERT_EQ(transmit(0, frame_to(9)), TSR_OK);
    run();
    ASSERT_EQ(ended[0].size(), 1u);
    EXPECT_EQ(ended[0][0].outcome, TSR_RADIO_NO_ACK);
    EXPECT_EQ(ended[0][0].time_us, ended[0][0].frame_end_us + TSR_RADIO_ACK_WAIT_US);
}

TEST_F(AirTest, WithoutRequestThereIsNoAcknowledgement)
{
    place({0, 10, 20});
    ASSERT_EQ(transmit(0, frame_to(2, 40, false)), TSR_OK);
    run();
    ASSERT_EQ(transmit(0, frame_to(0xffff, 40, true)), TSR_OK); /* nobody acknowledges a broadcast */
    run();
    ASSERT_EQ(ended[0].size(), 2u);
    EXPECT_EQ(ended[0][0].outcome, TSR_RADIO_SENT);
    EXPECT_EQ(ended[0][1].outcome, TSR_RADIO_SENT);
    EXPECT_EQ(heard[1].size(), 2u);
    EXPECT_EQ(heard[2].size(), 1u);
    EXPECT_EQ(air->transmissions(), 2u);
}

TEST_F(AirTest, DistanceEndsAtTheSensitivity)
{
    AirModel model;
    model.sensitivity_dbm = -95; /* 40 + 30 log10(d) <= 95: up to 68 m after rounding */
    place({0, 68, 200}, model);
    EXPECT_EQ(air->rssi_dbm(0, 1), -95);
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    ASSERT_EQ(transmit(0, frame_to(3)), TSR_OK);
    run();
    EXPECT_EQ(heard[1].size(), 1u);
    EXPECT_TRUE(heard[2].empty());
}

TEST_F(AirTest, SleepingReceiverHearsNothing)
{
    place({0, 10});
    receive(1, false);
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    EXPECT_TRUE(heard[1].empty());
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    queue.at(queue.now_us() + kSenseUs + 100, [this] { receive(1, true); }); /* in the middle of it */
    run();
    EXPECT_TRUE(heard[1].empty());
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    EXPECT_EQ(heard[1].size(), 1u);
}

/* hal/radio.h: receive or sleep "when not transmitting"; the wait for an
 * acknowledgement belongs to the transmission. A MAC with a full ring stops to
 * receive, and has to send to empty it. */
TEST_F(AirTest, SleepDoesNotLoseTheAcknowledgement)
{
    place({0, 10});
    receive(0, false);
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    ASSERT_EQ(ended[0].size(), 1u);
    EXPECT_EQ(ended[0][0].outcome, TSR_RADIO_ACKED);
    const AirTimes times = air->times(0);
    EXPECT_EQ(times.transmitting, on_air_us(40));
    EXPECT_EQ(times.assessing, kSenseUs);
    EXPECT_EQ(times.awaiting, TSR_RADIO_TURNAROUND_US + on_air_us(5));
    EXPECT_EQ(times.receiving, 0u);
    EXPECT_EQ(air->times(1).acknowledging, on_air_us(5));
}

/* The frame that fills the ring is still acknowledged. */
TEST_F(AirTest, ReceiverThatFallsAsleepAcknowledges)
{
    place({0, 10});
    sleep_when_heard = true;
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    EXPECT_EQ(ended[0].at(0).outcome, TSR_RADIO_ACKED);
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    EXPECT_EQ(ended[0].at(1).outcome, TSR_RADIO_NO_ACK);
    EXPECT_EQ(heard[1].size(), 1u);
}

TEST_F(AirTest, OverlapDestroysBoth)
{
    place({0, 10, 20});
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    ASSERT_EQ(transmit(2, frame_to(2)), TSR_OK); /* senses the same clear channel */
    run();
    EXPECT_TRUE(heard[1].empty());
    EXPECT_EQ(ended[0].at(0).outcome, TSR_RADIO_NO_ACK);
    EXPECT_EQ(ended[2].at(0).outcome, TSR_RADIO_NO_ACK);
}

TEST_F(AirTest, HiddenNodesCollideAtTheReceiverOnly)
{
    place({0, 60, 120}); /* the outer two do not hear each other */
    ASSERT_EQ(transmit(0, frame_to(2, 60)), TSR_OK);
    queue.at(1500, [this] { EXPECT_EQ(transmit(2, frame_to(2, 20)), TSR_OK); });
    run();
    EXPECT_TRUE(heard[1].empty());
    EXPECT_EQ(ended[2].at(0).outcome, TSR_RADIO_NO_ACK); /* it sensed a clear channel */
}

TEST_F(AirTest, BusyChannelIsSensed)
{
    place({0, 10, 20});
    ASSERT_EQ(transmit(0, frame_to(2, 100)), TSR_OK);
    queue.at(1000, [this] { EXPECT_EQ(transmit(2, frame_to(2)), TSR_OK); });
    run();
    ASSERT_EQ(ended[2].size(), 1u);
    EXPECT_EQ(ended[2][0].outcome, TSR_RADIO_CHANNEL_BUSY);
    EXPECT_EQ(ended[2][0].time_us, 1000 + TSR_RADIO_CCA_US);
    EXPECT_EQ(heard[1].size(), 1u);
}

TEST_F(AirTest, ChannelsAndPansAreApart)
{
    place({0, 10, 20});
    tsr_radio radio = air->radio(1);
    EXPECT_EQ(radio.ops->configure(radio.self, 16, kPan, 2), TSR_OK);
    EXPECT_EQ(radio.ops->configure(radio.self, 10, kPan, 2), TSR_ERR_ARG);
    EXPECT_EQ(radio.ops->configure(radio.self, 27, kPan, 2), TSR_ERR_ARG);
    radio = air->radio(2);
    EXPECT_EQ(radio.ops->configure(radio.self, 15, 0x1234, 2), TSR_OK);
    ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
    run();
    EXPECT_TRUE(heard[1].empty());
    EXPECT_TRUE(heard[2].empty());
}

/* Too short for an address: on air, but for nobody. */
TEST_F(AirTest, ShortPsdus)
{
    place({0, 10});
    EXPECT_EQ(transmit(0, Psdu(0)), TSR_ERR_ARG);
    EXPECT_EQ(transmit(0, Psdu(128)), TSR_ERR_ARG);
    for (std::size_t len = 1; len < 12; ++len) {
        for (const std::uint8_t first : {0x00, 0x02, 0x69}) {
            Psdu psdu(len, 0xff);
            psdu[0] = first;
            ASSERT_EQ(transmit(0, psdu), TSR_OK);
            run();
            EXPECT_EQ(ended[0].back().outcome, TSR_RADIO_SENT) << len;
        }
    }
}

TEST_F(AirTest, JudgeDecides)
{
    place({0, 10});
    std::vector<std::size_t> lens;
    AirFate fate = AirFate::lost;
    std::uint64_t judged = UINT64_MAX;
    air->set_judge([&](std::uint64_t number, const AirFrame &frame) {
        lens.push_back(frame.psdu_len);
        return number == judged ? fate : AirFate::natural;
    });
    std::vector<std::uint64_t> lost;
    air->set_tap([&](const AirFrame &frame) { lost.push_back(frame.lost_at); });
    const auto send = [&](std::uint64_t number, AirFate decided) {
        judged = air->transmissions() + number;
        fate = decided;
        ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
        run();
    };
    send(0, AirFate::lost); /* the frame: no acknowledgement follows */
    send(1, AirFate::lost); /* its acknowledgement */
    send(0, AirFate::twice);
    send(1, AirFate::twice);
    EXPECT_EQ(lens, (std::vector<std::size_t>{40, 40, 5, 40, 5, 40, 5}));
    EXPECT_EQ(lost, (std::vector<std::uint64_t>{1, 0, 1, 0, 0, 0, 0}));
    EXPECT_EQ(heard[1].size(), 1u + 2u + 1u);
    EXPECT_EQ(ended[0].at(0).outcome, TSR_RADIO_NO_ACK);
    EXPECT_EQ(ended[0].at(1).outcome, TSR_RADIO_NO_ACK);
    EXPECT_EQ(ended[0].at(2).outcome, TSR_RADIO_ACKED);
    EXPECT_EQ(ended[0].at(3).outcome, TSR_RADIO_ACKED);
    EXPECT_EQ(ended[0].size(), 4u); /* one TX_DONE each */
}

TEST_F(AirTest, ChanceLosesItsPart)
{
    AirModel model;
    model.frame_loss = 0.25;
    place({0, 10}, model);
    for (int i = 0; i < 4000; ++i) {
        ASSERT_EQ(transmit(0, frame_to(2)), TSR_OK);
        run();
    }
    std::size_t acked = 0;
    for (const Ended &end : ended[0]) {
        acked += end.outcome == TSR_RADIO_ACKED ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(heard[1].size()), 3000, 110); /* 4 sigma of the binomial */
    EXPECT_NEAR(static_cast<double>(acked), 2250, 126);
}

TEST_F(AirTest, TimesAddUp)
{
    place({0, 10, 20});
    receive(2, false);
    for (int i = 0; i < 20; ++i) {
        (void)transmit(0, frame_to(2));
        (void)transmit(1, frame_to(1));
        run();
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const AirTimes times = air->times(i);
        EXPECT_EQ(times.transmitting + times.assessing + times.awaiting + times.acknowledging + times.receiving +
                      times.sleeping,
                  queue.now_us());
    }
    EXPECT_EQ(air->times(2).sleeping, queue.now_us());
}

} // namespace
} // namespace tsr
