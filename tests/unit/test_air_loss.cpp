/* Why a frame was lost. SPDX-License-Identifier: Apache-2.0 */
#include <algorithm>

#include <gtest/gtest.h>

#include "tsr/emulator/event_queue.h"
#include "tsr/hal/air.h"

namespace tsr
{
namespace
{

using air::LossCause;

constexpr std::uint16_t kPan = 0xbeef;
constexpr std::size_t kLen = 60;
constexpr std::uint64_t kSenseUs = TSR_RADIO_CCA_US + TSR_RADIO_TURNAROUND_US;

/* Radios in a line, radio i with address i + 1; the causes of each one's frames, acknowledgements apart. */
class AirLoss : public testing::Test
{
  protected:
    void place(std::initializer_list<double> metres, const AirModel &model = {})
    {
        air = std::make_unique<Air>(model, Air::Clock{[this] { return queue.now_us(); },
                                                      [this](std::uint64_t at_us, std::function<void()> action) {
                                                          queue.at(at_us, std::move(action));
                                                      }});
        causes.resize(metres.size());
        for (const double x : metres) {
            const std::size_t index = air->add_radio({x, 0, 0}, [](const tsr_radio_event &) {});
            radio(index).ops->configure(radio(index).self, 15, kPan, static_cast<std::uint16_t>(index + 1));
            receive(index, true);
        }
        air->set_tap([this](const AirFrame &frame) {
            EXPECT_EQ(frame.lost_at > 0, frame.cause != LossCause::none);
            (frame.acknowledged == AirFrame::kNobody ? causes.at(frame.sender) : of_acks).push_back(frame.cause);
        });
    }
    tsr_radio radio(std::size_t index) { return air->radio(index); }
    void receive(std::size_t index, bool on) { radio(index).ops->set_receiving(radio(index).self, on); }
    void send_at(std::uint64_t time_us, std::size_t from, std::size_t to, std::size_t len = kLen)
    {
        queue.at(time_us, [this, from, to, len] {
            std::vector<std::uint8_t> psdu = {0x61, 0x98, 7, kPan & 0xff, kPan >> 8, static_cast<std::uint8_t>(to + 1),
                                              0};
            psdu.resize(len);
            ASSERT_EQ(radio(from).ops->transmit(radio(from).self, psdu.data(), psdu.size()), TSR_OK);
        });
    }
    void run()
    {
        while (!queue.empty()) {
            queue.run_next();
        }
    }
    LossCause only(std::size_t sender) const
    {
        EXPECT_EQ(causes.at(sender).size(), 1u);
        return causes.at(sender).empty() ? LossCause::none : causes.at(sender).front();
    }

    EventQueue queue;
    std::unique_ptr<Air> air;
    std::vector<std::vector<LossCause>> causes;
    std::vector<LossCause> of_acks;
};

TEST_F(AirLoss, WhatIsReceivedHasNoCause)
{
    place({0, 10});
    send_at(0, 0, 1);
    run();
    EXPECT_EQ(only(0), LossCause::none);
    EXPECT_EQ(of_acks, std::vector{LossCause::none});
}

/* The default's sensitivity reaches 68 m. */
TEST_F(AirLoss, NoiseHidesWhatIsFarAway)
{
    place({0, 95, 105, 10'000});
    for (std::uint64_t i = 0; i < 40; ++i) {
        send_at(20'000 * i, 0, 1 + i % 3);
    }
    run();
    EXPECT_EQ(std::count(causes[0].begin(), causes[0].end(), LossCause::noise), 40);
}

TEST_F(AirLoss, OfTwoAtOnceOneCollidesAndTheOtherFindsTheReceiverBusy)
{
    place({0, 60, 120}); /* the outer two do not hear each other */
    send_at(0, 0, 1);
    send_at(1500, 2, 1, 20);
    run();
    EXPECT_EQ(only(0), LossCause::collision);
    EXPECT_EQ(only(2), LossCause::receiver_busy);
}

TEST_F(AirLoss, AStrongerPreambleTakesTheReceiverOver)
{
    place({0, 60, 70});
    send_at(0, 0, 1);
    send_at(50, 2, 1); /* the channel is clear yet */
    run();
    EXPECT_EQ(only(0), LossCause::collision);
    EXPECT_EQ(only(2), LossCause::none);
}

TEST_F(AirLoss, WhoSendsIsDeaf)
{
    place({0, 10});
    send_at(0, 0, 1);
    send_at(0, 1, 0);
    run();
    EXPECT_EQ(only(0), LossCause::half_duplex);
    EXPECT_EQ(only(1), LossCause::half_duplex);
}

TEST_F(AirLoss, WhoSleepsOrHasNoPowerDoesNotListen)
{
    place({0, 10, 20});
    receive(1, false);
    air->set_power(2, false);
    send_at(0, 0, 1);
    send_at(20'000, 0, 2);
    send_at(40'000, 0, 1);
    queue.at(40'000 - 1, [this] { receive(1, true); });
    queue.at(40'000 + kSenseUs + 500, [this] { air->set_power(1, false); }); /* in the middle of it */
    run();
    EXPECT_EQ(causes[0], (std::vector(3, LossCause::not_listening)));
}

TEST_F(AirLoss, AFaultOfTheLinkIsTheCauseOnlyIfWithoutItTheFrameWereRight)
{
    place({0, 10, 10'000});
    const std::size_t weaker = air->losses().begin(0, 1, 60, 0);
    send_at(0, 0, 1);
    queue.at(20'000, [this, weaker] { air->losses().end(weaker); });
    send_at(20'001, 0, 1);
    queue.at(40'000, [this] { air->losses().begin(0, air::kEveryRadio, 0, 1); });
    send_at(40'001, 0, 1);
    send_at(60'000, 0, 2);
    run();
    EXPECT_EQ(causes[0],
              (std::vector{LossCause::link_fault, LossCause::none, LossCause::link_fault, LossCause::noise}));
}

TEST_F(AirLoss, AcknowledgementsHaveCausesToo)
{
    place({0, 10});
    send_at(0, 0, 1);
    air->set_judge(
        [](std::uint64_t number, const AirFrame &) { return number == 1 ? AirFate::lost : AirFate::natural; });
    run();
    EXPECT_EQ(of_acks, std::vector{LossCause::link_fault});
}

} // namespace
} // namespace tsr
