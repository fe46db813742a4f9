/* Radios without power and links that are disturbed. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "tsr/emulator/event_queue.h"
#include "tsr/hal/air.h"

namespace tsr
{
namespace
{

constexpr std::uint16_t kPan = 0xbeef;
constexpr std::size_t kLen = 50;
constexpr std::uint64_t kSenseUs = TSR_RADIO_CCA_US + TSR_RADIO_TURNAROUND_US;
constexpr std::uint64_t kFrameUs = (TSR_RADIO_PHY_HEADER_OCTETS + kLen) * TSR_RADIO_OCTET_US;
constexpr std::uint64_t kAckUs = TSR_RADIO_TURNAROUND_US + (TSR_RADIO_PHY_HEADER_OCTETS + 5) * TSR_RADIO_OCTET_US;

/* Three radios 10 m apart, radio i with address i + 1; the first sends to the second and asks for an acknowledgement.
 */
class AirFaults : public testing::Test
{
  protected:
    AirFaults()
        : air(AirModel{},
              {[this] { return queue.now_us(); },
               [this](std::uint64_t at_us, std::function<void()> action) { queue.at(at_us, std::move(action)); }})
    {
        for (std::size_t i = 0; i < 3; ++i) {
            air.add_radio({10.0 * static_cast<double>(i), 0, 0}, [this, i](const tsr_radio_event &event) {
                if (event.kind == TSR_RADIO_RECEIVED) {
                    ++heard[i];
                } else {
                    outcomes[i].push_back(event.outcome);
                }
            });
            wake(i);
        }
        air.set_tap([this](const AirFrame &) { ++tapped; });
    }
    void wake(std::size_t i)
    {
        air.set_power(i, true);
        const tsr_radio radio = air.radio(i);
        radio.ops->configure(radio.self, 15, kPan, static_cast<std::uint16_t>(i + 1));
        radio.ops->set_receiving(radio.self, true);
    }
    void send(std::size_t from = 0, std::uint8_t to = 2)
    {
        std::vector<std::uint8_t> psdu(kLen);
        psdu = {0x61, 0x98, 7, kPan & 0xff, kPan >> 8, to, 0, static_cast<std::uint8_t>(from + 1), 0};
        psdu.resize(kLen);
        const tsr_radio radio = air.radio(from);
        ASSERT_EQ(radio.ops->transmit(radio.self, psdu.data(), psdu.size()), TSR_OK);
    }
    void run_until(std::uint64_t time_us)
    {
        queue.at(time_us, [] {});
        while (!queue.empty() && queue.next_us() <= time_us) {
            queue.run_next();
        }
    }

    EventQueue queue;
    Air air;
    std::array<int, 3> heard{};
    std::array<std::vector<tsr_radio_outcome>, 3> outcomes;
    int tapped = 0;
};

TEST_F(AirFaults, ALostSenderIsHeardByNobodyAndToldNothing)
{
    for (const std::uint64_t after_us :
         {std::uint64_t{1}, std::uint64_t{TSR_RADIO_CCA_US} + 1, kSenseUs + 1, kSenseUs + kFrameUs - 1}) {
        const std::uint64_t start_us = queue.now_us();
        send();
        run_until(start_us + after_us);
        air.set_power(0, false);
        run_until(start_us + 100'000);
        wake(0);
    }
    EXPECT_EQ(heard[1], 0);
    EXPECT_TRUE(outcomes[0].empty());
    EXPECT_EQ(tapped, 0);
    send(); /* the channel is clear, the radio as new */
    run_until(queue.now_us() + 100'000);
    EXPECT_EQ(heard[1], 1);
    EXPECT_EQ(outcomes[0], std::vector{TSR_RADIO_ACKED});
}

/* A frame that is cut leaves its receiver free for the next one at once. */
TEST_F(AirFaults, ACutFrameFreesTheChannel)
{
    send();
    run_until(kSenseUs + 500);
    air.set_power(0, false);
    send(2, 2);
    run_until(100'000);
    EXPECT_EQ(outcomes[2], std::vector{TSR_RADIO_ACKED});
    EXPECT_EQ(heard[1], 1);
}

TEST_F(AirFaults, ALostReceiverHearsNothingAndAnswersNothing)
{
    send();
    run_until(kSenseUs + 500);
    air.set_power(1, false);
    run_until(50'000);
    EXPECT_EQ(outcomes[0], std::vector{TSR_RADIO_NO_ACK});
    send();
    run_until(kSenseUs + kFrameUs + 50'000 + 1); /* got to the end, but not its acknowledgement */
    wake(1);
    run_until(150'000);
    EXPECT_EQ(heard[1], 0);
    EXPECT_EQ(outcomes[0], (std::vector{TSR_RADIO_NO_ACK, TSR_RADIO_NO_ACK}));
}

TEST_F(AirFaults, AnAcknowledgementEndsWithItsSender)
{
    send();
    run_until(kSenseUs + kFrameUs + TSR_RADIO_TURNAROUND_US + 100);
    EXPECT_EQ(heard[1], 1);
    air.set_power(1, false);
    run_until(50'000);
    EXPECT_EQ(outcomes[0], std::vector{TSR_RADIO_NO_ACK});
}

/* What an earlier life asked for is not an answer to the new one. */
TEST_F(AirFaults, AnAcknowledgementOfAnEarlierLifeIsIgnored)
{
    send();
    run_until(kSenseUs + kFrameUs + TSR_RADIO_TURNAROUND_US + 100);
    air.set_power(0, false);
    wake(0);
    send();
    run_until(kSenseUs + kFrameUs + kAckUs + 10);
    EXPECT_TRUE(outcomes[0].empty() || outcomes[0] == std::vector{TSR_RADIO_CHANNEL_BUSY});
}

TEST_F(AirFaults, OffIsCountedApart)
{
    run_until(1'000);
    air.set_power(2, false);
    run_until(5'000);
    wake(2);
    run_until(7'000);
    const AirTimes times = air.times(2);
    EXPECT_EQ(times.off, 4'000u);
    EXPECT_EQ(times.receiving, 3'000u);
    EXPECT_EQ(times.sleeping + times.transmitting, 0u);
}

TEST_F(AirFaults, ALossConcernsItsLinkBothWays)
{
    const std::size_t cut = air.losses().begin(0, 1, 200, 0);
    send();
    run_until(50'000);
    send(1, 1);
    run_until(100'000);
    EXPECT_EQ(heard[0] + heard[1], 0);
    send(2, 2);
    run_until(150'000);
    EXPECT_EQ(heard[1], 1);
    air.losses().end(cut);
    send();
    run_until(200'000);
    EXPECT_EQ(heard[1], 2);
}

TEST_F(AirFaults, LossesAddUpAndEndApart)
{
    air::LinkLosses losses;
    const std::size_t a = losses.begin(3, air::kEveryRadio, 6, 0.5);
    const std::size_t b = losses.begin(4, 3, 1.5, 0.5);
    EXPECT_EQ(losses.loss_q4(3, 4), 7 * 16 + 8);
    EXPECT_EQ(losses.loss_q4(4, 3), 7 * 16 + 8);
    EXPECT_EQ(losses.loss_q4(9, 3), 6 * 16);
    EXPECT_EQ(losses.loss_q4(9, 4), 0);
    EXPECT_EQ(losses.kept_q32(3, 4), std::uint64_t{1} << 30);
    EXPECT_EQ(losses.kept_q32(9, 4), std::uint64_t{1} << 32);
    losses.end(a);
    EXPECT_EQ(losses.loss_q4(3, 4), 24);
    losses.end(b);
    losses.end(b);
    EXPECT_EQ(losses.loss_q4(3, 4), 0);
}

TEST_F(AirFaults, APartOfTheFramesIsLost)
{
    air.losses().begin(1, air::kEveryRadio, 0, 0.5);
    for (int i = 0; i < 400; ++i) {
        send();
        run_until(queue.now_us() + 20'000);
    }
    EXPECT_NEAR(heard[1], 200, 40); /* 4 standard deviations */
}

} // namespace
} // namespace tsr
