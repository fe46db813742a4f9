/*
 * Air with many radios: hidden terminals, the same result from the same seed
 * everywhere, cost that follows the neighbours.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "tsr/emulator/event_queue.h"
#include "tsr/hal/air.h"
#include "tsr/hal/air/chance.h"

namespace tsr
{
namespace
{

using namespace air;

constexpr std::uint16_t kPan = 0xbeef;
constexpr std::uint16_t kBroadcast = 0xffff;

/* Radio i has address i + 1. Everything that happens goes into the digest. */
class Network
{
  public:
    explicit Network(const AirModel &model)
        : air(model,
              {[this] { return queue.now_us(); },
               [this](std::uint64_t at_us, std::function<void()> action) { queue.at(at_us, std::move(action)); }})
    {
        air.set_tap([this](const AirFrame &frame) {
            note(frame.start_us);
            note(frame.sender);
            note(frame.lost_at);
        });
    }
    void add(const Position &position_m)
    {
        const std::size_t index = air.add_radio(position_m, [this, i = received.size()](const tsr_radio_event &event) {
            note(i);
            note(event.time_us);
            if (event.kind == TSR_RADIO_RECEIVED) {
                ++received[i];
                note(static_cast<std::uint64_t>(event.received.rssi_dbm + 128));
            } else {
                outcomes.push_back(event.outcome);
                note(event.outcome);
            }
        });
        received.push_back(0);
        const tsr_radio radio = air.radio(index);
        radio.ops->configure(radio.self, 15, kPan, static_cast<std::uint16_t>(index + 1));
        radio.ops->set_receiving(radio.self, true);
    }
    void send_at(std::uint64_t time_us, std::size_t from, std::uint16_t to, std::size_t psdu_len)
    {
        queue.at(time_us, [this, from, to, psdu_len] {
            std::vector<std::uint8_t> psdu(psdu_len, 0x5a);
            psdu[0] = 0x61;
            psdu[3] = kPan & 0xff;
            psdu[4] = kPan >> 8;
            psdu[5] = static_cast<std::uint8_t>(to);
            psdu[6] = static_cast<std::uint8_t>(to >> 8);
            const tsr_radio radio = air.radio(from);
            note(radio.ops->transmit(radio.self, psdu.data(), psdu.size()) == TSR_OK);
        });
    }
    void run()
    {
        while (!queue.empty()) {
            queue.run_next();
        }
    }
    void note(std::uint64_t value) { digest = mix(digest + value); }

    EventQueue queue;
    Air air;
    std::vector<unsigned> received;
    std::vector<tsr_radio_outcome> outcomes;
    std::uint64_t digest = 0;
};

Position scattered(std::uint64_t i, double width_m)
{
    const auto part = [i](std::uint64_t axis) { return static_cast<double>(mix(i * 3 + axis) >> 40) / 16777216.0; };
    return {part(0) * width_m, part(1) * width_m, part(2) * 5};
}

/* Neither sender hears the other. Where one is 19 dB stronger its frame survives. */
TEST(AirNetwork, HiddenTerminalIsCaptured)
{
    Network network{AirModel{}};
    network.add({0, 0, 0});
    network.add({20, 0, 0});
    network.add({110, 0, 0});
    network.send_at(0, 0, 2, 60);
    network.send_at(700, 2, 2, 60);
    network.run();
    EXPECT_EQ(network.received[1], 1u);
    EXPECT_EQ(network.outcomes, (std::vector<tsr_radio_outcome>{TSR_RADIO_ACKED, TSR_RADIO_NO_ACK}));
}

std::uint64_t digest_of_a_busy_network(std::uint64_t seed)
{
    AirModel model;
    model.seed = seed;
    model.shadowing_db = 5;
    model.fading_db = 3;
    model.fading_period_ms = 50;
    model.frame_loss = 0.03;
    Network network(model);
    constexpr std::size_t kRadios = 60;
    for (std::size_t i = 0; i < kRadios; ++i) {
        network.add(scattered(i, 150));
    }
    for (std::uint64_t i = 0; i < 3000; ++i) {
        const std::uint64_t draw = mix(i * 7919);
        const auto to = draw % 5 == 0 ? kBroadcast : static_cast<std::uint16_t>(1 + (draw >> 8) % kRadios);
        network.send_at((draw >> 16) % 3'000'000, (draw >> 40) % kRadios, to, 20 + (draw >> 50) % 100);
    }
    network.run();
    return network.digest;
}

/* Every compiler and machine comes to this number: no result hangs on a C library's last bit. */
TEST(AirNetwork, SameSeedSameResultEverywhere)
{
    EXPECT_EQ(digest_of_a_busy_network(1), 6905851893628988839u);
    EXPECT_NE(digest_of_a_busy_network(1), digest_of_a_busy_network(2));
}

/* Receivers that one broadcast of each radio is brought to. */
double arrivals_per_frame(std::size_t radios, double width_m)
{
    Network network{AirModel{}};
    for (std::size_t i = 0; i < radios; ++i) {
        network.add(scattered(i, width_m));
    }
    for (std::size_t i = 0; i < radios; ++i) {
        network.send_at(i * 10'000, i, kBroadcast, 60);
    }
    network.run();
    return static_cast<double>(network.air.arrivals()) / static_cast<double>(radios);
}

TEST(AirNetwork, FrameCostsWhatItsNeighboursCost)
{
    const double few = arrivals_per_frame(250, 2500);
    const double many = arrivals_per_frame(1000, 5000);
    EXPECT_GT(few, 1);
    EXPECT_LT(many, 20);
    EXPECT_LT(many, 1.3 * few);
}

} // namespace
} // namespace tsr
