/*
 * The numbers behind Air: decibels, packet error, path loss, shadowing, fading,
 * neighbours.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include <cmath>

#include "tsr/hal/air/chance.h"
#include "tsr/hal/air/decibel.h"
#include "tsr/hal/air/neighbours.h"
#include "tsr/hal/air/packet_error.h"
#include "tsr/hal/air/propagation.h"
#include "tsr/hal/air/receiver.h"

namespace tsr
{
namespace
{

using namespace air;

TEST(AirDecibel, AgreesWithTheCLibrary)
{
    for (double x = -300; x < 40; x += 0.37) {
        EXPECT_NEAR(exponential(x) / std::exp(x), 1, 1e-11) << x;
    }
    for (double ratio = 1e-12; ratio < 1e15; ratio *= 1.7) {
        EXPECT_NEAR(decibels(ratio), 10 * std::log10(ratio), 1e-11) << ratio;
    }
    EXPECT_EQ(level_q4(-70.03), -1120);
    EXPECT_EQ(level_q4(-0.03125), -1); /* ties away from 0 */
    EXPECT_EQ(to_dbm(-1128), -71);     /* -70.5 */
    EXPECT_EQ(to_dbm(-1127), -70);
}

TEST(AirDecibel, PowersAddUpAndComeBack)
{
    for (int level = -130 * 16; level <= 20 * 16; ++level) {
        EXPECT_EQ(level_of(power_of(level)), level);
    }
    EXPECT_NEAR(level_of(2 * power_of(-90 * 16)), level_q4(-90 + 3.01), 1);
    EXPECT_EQ(power_of(-200 * 16), 1u);
    EXPECT_EQ(power_of(50 * 16), power_of(20 * 16));
    EXPECT_EQ(level_of(0), -150 * 16);
    EXPECT_EQ(level_of(UINT64_MAX), 20 * 16);
}

/* The same equation in another form: the product of Marcum's terms is summed with lgamma, not by recurrence. */
double reference_packet_error(double sinr_db, double bits)
{
    const double sinr = std::pow(10, sinr_db / 10);
    double sum = 0;
    for (int k = 2; k <= 16; ++k) {
        const double binomial = std::exp(std::lgamma(17) - std::lgamma(k + 1) - std::lgamma(17 - k));
        sum += (k % 2 == 0 ? 1 : -1) * binomial * std::exp(20 * sinr * (1.0 / k - 1));
    }
    return 1 - std::pow(1 - 8.0 / 15 / 16 * sum, bits);
}

TEST(AirPacketError, IsTheStandardsEquation)
{
    const PacketError errors;
    for (const std::uint64_t octets : {11u, 26u, 66u, 133u}) {
        for (int level = -8 * 16; level <= 4 * 16; ++level) {
            const double success = static_cast<double>(errors.success_q32(level, 8 * octets)) / 4294967296.0;
            EXPECT_NEAR(1 - success, reference_packet_error(level / 16.0, 8.0 * static_cast<double>(octets)), 1e-6)
                << octets << " octets at " << level / 16.0 << " dB";
        }
    }
    EXPECT_LE(reference_packet_error(errors.sensitivity_sinr_q4() / 16.0, 208), 0.01);
    EXPECT_GT(reference_packet_error((errors.sensitivity_sinr_q4() - 1) / 16.0, 208), 0.01);
}

TEST(AirPacketError, PiecesMakeTheWhole)
{
    const PacketError errors;
    const std::uint64_t whole = errors.success_q32(-16, 500);
    std::uint64_t pieces = kCertainQ32;
    for (const std::uint64_t bits : {0u, 1u, 99u, 150u, 250u}) {
        pieces = both_q32(pieces, errors.success_q32(-16, bits));
    }
    EXPECT_NEAR(static_cast<double>(pieces), static_cast<double>(whole), 20);
    EXPECT_EQ(errors.success_q32(-100, 0), kCertainQ32);
    EXPECT_EQ(errors.success_q32(500, 1000), kCertainQ32);
    EXPECT_LT(errors.success_q32(-500, 100), 10u);
}

TEST(AirPropagation, PathLossIsLogDistance)
{
    const Propagation propagation{AirModel{}};
    EXPECT_EQ(propagation.mean_q4({0, 0, 0}, 0, {10, 0, 0}, 1), -70 * 16);
    EXPECT_EQ(propagation.mean_q4({0, 0, 0}, 0, {60, 0, 80}, 1), -100 * 16);
    EXPECT_EQ(propagation.mean_q4({0, 0, 0}, 0, {0, 0, 0}, 1), -10 * 16); /* as at 0.1 m */
    EXPECT_EQ(propagation.fading_q4(0, 1, 12345), 0);
}

TEST(AirPropagation, ShadowingBelongsToALinkAndHasItsDeviation)
{
    AirModel model;
    model.shadowing_db = 6;
    const Propagation propagation(model);
    model.seed = 2;
    const Propagation other(model);
    double sum = 0;
    double squares = 0;
    int differ = 0;
    constexpr int kLinks = 20000;
    for (std::size_t b = 1; b <= kLinks; ++b) {
        const int level = propagation.mean_q4({0, 0, 0}, 0, {1, 0, 0}, b);
        EXPECT_EQ(level, propagation.mean_q4({1, 0, 0}, b, {0, 0, 0}, 0));
        differ += level != other.mean_q4({0, 0, 0}, 0, {1, 0, 0}, b) ? 1 : 0;
        const double shadow_db = level / 16.0 + 40;
        EXPECT_LE(std::abs(shadow_db), 18.1);
        sum += shadow_db;
        squares += shadow_db * shadow_db;
    }
    EXPECT_NEAR(sum / kLinks, 0, 0.17);                  /* 4 sigma */
    EXPECT_NEAR(std::sqrt(squares / kLinks), 6.0, 0.12); /* 4 sigma */
    EXPECT_GT(differ, kLinks * 9 / 10);
}

TEST(AirPropagation, FadingRunsSlowlyRoundItsMean)
{
    AirModel model;
    model.fading_db = 2;
    model.fading_period_ms = 1000;
    const Propagation propagation(model);
    double sum = 0;
    double squares = 0;
    constexpr int kSteps = 400'000; /* 4,000 draws */
    int before = propagation.fading_q4(3, 7, 0);
    for (int step = 1; step <= kSteps; ++step) {
        const int fading = propagation.fading_q4(7, 3, static_cast<std::uint64_t>(step) * 10'000);
        /* From end to end of the draws in one period: 2 * 3 * sqrt(1.5) * 2 dB, a hundredth of it in 10 ms. */
        EXPECT_LE(std::abs(fading - before), 4);
        before = fading;
        sum += fading / 16.0;
        squares += fading / 16.0 * fading / 16.0;
        EXPECT_LE(std::abs(fading), propagation.fading_max_q4());
    }
    EXPECT_NEAR(sum / kSteps, 0, 0.16);
    EXPECT_NEAR(std::sqrt(squares / kSteps), 2.0, 0.1);
    EXPECT_NE(propagation.fading_q4(3, 7, 500'000), propagation.fading_q4(3, 8, 500'000));
}

TEST(AirChance, NormalNumbersAreNormal)
{
    int inside = 0;
    constexpr int kDraws = 100'000;
    for (std::uint64_t key = 0; key < kDraws; ++key) {
        inside += std::abs(normal_q16(mix(key))) < 65536 ? 1 : 0;
    }
    EXPECT_NEAR(inside / static_cast<double>(kDraws), 0.683, 0.01); /* within one standard deviation */
}

Position scattered(std::uint64_t i, double width_m)
{
    const auto part = [i](std::uint64_t axis) { return static_cast<double>(mix(i * 3 + axis) >> 40) / 16777216.0; };
    return {(part(0) - 0.5) * width_m, (part(1) - 0.5) * width_m, part(2) * 20};
}

TEST(AirNeighbours, AreThoseOfComparingAll)
{
    for (const double shadowing_db : {0.0, 4.0}) {
        AirModel model;
        model.shadowing_db = shadowing_db;
        model.fading_db = shadowing_db / 2;
        const Propagation propagation(model);
        const int floor_q4 = ReceiverModel(model).floor_q4();
        Neighbours neighbours(propagation, floor_q4);
        constexpr std::size_t kRadios = 300;
        for (std::size_t i = 0; i < kRadios; ++i) {
            EXPECT_EQ(neighbours.add(scattered(i, 3000)), i);
        }
        for (std::size_t a = 0; a < kRadios; ++a) {
            std::vector<std::uint32_t> expected;
            for (std::size_t b = 0; b < kRadios; ++b) {
                const int mean_q4 = propagation.mean_q4(scattered(a, 3000), a, scattered(b, 3000), b);
                if (a != b && mean_q4 + propagation.fading_max_q4() >= floor_q4) {
                    expected.push_back(static_cast<std::uint32_t>(b));
                }
            }
            std::vector<std::uint32_t> found;
            for (const Link &link : neighbours.of(a)) {
                found.push_back(link.radio);
            }
            EXPECT_EQ(found, expected) << a;
        }
    }
}

/* A radio far away costs nothing: ten times the radios on ten times the area compare ten times as often. */
TEST(AirNeighbours, CostGrowsWithTheNeighbourhood)
{
    const Propagation propagation{AirModel{}};
    const auto compared = [&](std::size_t radios, double width_m) {
        Neighbours neighbours(propagation, ReceiverModel(AirModel{}).floor_q4());
        for (std::size_t i = 0; i < radios; ++i) {
            neighbours.add(scattered(i, width_m));
        }
        return static_cast<double>(neighbours.compared()) / static_cast<double>(radios);
    };
    const double few = compared(1000, 5000);
    EXPECT_LT(few, 50);                                           /* of 999 */
    EXPECT_LT(compared(10'000, 5000 * std::sqrt(10)), 1.3 * few); /* fewer stand at the edge */
}

} // namespace
} // namespace tsr
