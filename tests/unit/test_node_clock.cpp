/* Clocks that drift: both ways exact, monotonic, invertible. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "tsr/emulator/node_clock.h"

namespace tsr
{
namespace
{

constexpr std::uint64_t kYearUs = 31'536'000'000'000;

TEST(NodeClock, IsRightUntilItDrifts)
{
    const NodeClock clock;
    for (const std::uint64_t time_us : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{999'999}, kYearUs}) {
        EXPECT_EQ(clock.local_us(time_us), time_us);
        EXPECT_EQ(clock.virtual_us(time_us), time_us);
    }
    EXPECT_EQ(clock.virtual_us(UINT64_MAX), UINT64_MAX);
}

TEST(NodeClock, CountsPartsInAMillion)
{
    NodeClock clock;
    clock.set_rate(5'000'000, 40);
    EXPECT_EQ(clock.local_us(5'000'000), 5'000'000u);
    EXPECT_EQ(clock.local_us(6'000'000), 6'000'040u);
    clock.set_rate(6'000'000, -100);
    EXPECT_EQ(clock.local_us(7'000'000), 6'999'940u);
    EXPECT_EQ(clock.local_us(6'000'001), 6'000'040u); /* floor: the first us is lost at once */
    clock.set_rate(7'000'000, 0);
    EXPECT_EQ(clock.local_us(8'000'000), 7'999'940u);
    EXPECT_EQ(clock.virtual_us(6'000'000), 5'999'961u); /* a time of the first drift */
    EXPECT_EQ(clock.virtual_us(7'999'940), 8'000'000u);
}

/* The first instant that shows a time or more, at every rate and after a year. */
TEST(NodeClock, FindsTheFirstInstant)
{
    for (const int ppm : {-1000, -999, -40, -1, 1, 7, 100, 1000}) {
        for (const std::uint64_t from_us : {std::uint64_t{0}, std::uint64_t{12'345}, kYearUs}) {
            NodeClock clock;
            clock.set_rate(from_us, ppm);
            for (const std::uint64_t step : {1u, 2u, 999u, 1'000u, 1'001u, 999'999u, 1'000'001u, 86'400'000u}) {
                for (std::uint64_t n = 0; n < 40; ++n) {
                    const std::uint64_t local_us = from_us + n * step;
                    const std::uint64_t time_us = clock.virtual_us(local_us);
                    EXPECT_GE(clock.local_us(time_us), local_us);
                    EXPECT_TRUE(time_us == from_us || clock.local_us(time_us - 1) < local_us);
                }
            }
        }
    }
}

} // namespace
} // namespace tsr
