/*
 * The wall clock's pace, by a clock that the test moves.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <vector>

#include <gtest/gtest.h>

#include "memory_run.h"
#include "tsr/emulator/pace.h"
#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

/* Sleeps take as long as asked, and overshoot us more. */
class FakeClock
{
  public:
    Pace::Clock clock()
    {
        return {[this] { return now_us; },
                [this](std::uint64_t us) {
                    naps.push_back(us);
                    now_us += us + overshoot_us;
                }};
    }
    std::uint64_t now_us = 123'456'789;
    std::uint64_t overshoot_us = 0;
    std::vector<std::uint64_t> naps;
};

bool go_on(std::uint64_t)
{
    return true;
}

TEST(Pace, SleepsUntilTheTimeHasCome)
{
    for (const double speed : {1.0, 10.0, 0.5, 3.0}) {
        FakeClock clock;
        const std::uint64_t start_us = clock.now_us;
        Pace pace(speed, clock.clock());
        for (const std::uint64_t time_us : {0u, 1u, 30'000u, 30'000u, 1'000'001u}) {
            pace.wait_for(time_us, go_on);
            const double passed_us = static_cast<double>(clock.now_us - start_us);
            EXPECT_GE(passed_us * speed, static_cast<double>(time_us)) << speed;
            EXPECT_LT((passed_us - 1) * speed, static_cast<double>(time_us) + 1) << speed;
        }
        EXPECT_EQ(pace.worst_late_s(), 0) << speed;
    }
}

TEST(Pace, NapsAndTellsHowFarItIs)
{
    FakeClock clock;
    Pace pace(2, clock.clock());
    std::vector<std::uint64_t> told;
    pace.wait_for(500'000, [&](std::uint64_t reached_us) {
        told.push_back(reached_us);
        return true;
    });
    EXPECT_EQ(clock.naps, (std::vector<std::uint64_t>{100'000, 100'000, 50'000}));
    EXPECT_EQ(told, (std::vector<std::uint64_t>{200'000, 400'000, 500'000}));
}

TEST(Pace, EndsWhenItIsToldTo)
{
    FakeClock clock;
    Pace pace(1, clock.clock());
    pace.wait_for(10'000'000, [&](std::uint64_t) { return clock.naps.size() < 3; });
    EXPECT_EQ(clock.naps.size(), 3u);
}

TEST(Pace, TellsHowLateItIsAndCatchesUp)
{
    FakeClock clock;
    Pace pace(1, clock.clock());
    clock.now_us += 2'500'000; /* of work */
    pace.wait_for(1'000'000, go_on);
    EXPECT_TRUE(clock.naps.empty()) << "who is late does not sleep";
    EXPECT_EQ(pace.late_s(), 1.5);
    pace.wait_for(2'600'000, go_on);
    EXPECT_EQ(clock.naps, (std::vector<std::uint64_t>{100'000})) << "the rest of the time";
    EXPECT_EQ(pace.late_s(), 0);
    EXPECT_EQ(pace.worst_late_s(), 1.5);
    clock.overshoot_us = 70;
    pace.wait_for(2'700'000, go_on);
    EXPECT_EQ(pace.late_s(), 0) << "how exactly a machine sleeps is not lateness";
}

TEST(Pace, IsAskedBeforeEachEventAndChangesNothing)
{
    test::MemoryRun plain(test::short_site());
    plain.run();
    test::MemoryRun paced(test::short_site());
    std::uint64_t asked = 0;
    std::uint64_t latest_us = 0;
    paced.simulation.keep_pace([&](std::uint64_t next_us) {
        EXPECT_LE(paced.simulation.duration_us(), next_us) << "virtual time was there before it was asked for";
        EXPECT_GE(next_us, latest_us);
        latest_us = next_us;
        ++asked;
        return true;
    });
    paced.run();
    EXPECT_EQ(asked, paced.events);
    EXPECT_EQ(paced.events, plain.events);
    EXPECT_EQ(latest_us, paced.simulation.duration_us());
    EXPECT_EQ(paced.simulation.duration_us(), plain.simulation.duration_us());
}

/* Whoever is stopped while waiting has not been there. */
TEST(Pace, AStopInAWaitEndsTheRunBeforeTheEvent)
{
    test::MemoryRun run(test::short_site());
    std::uint64_t refused_us = 0;
    run.simulation.keep_pace([&](std::uint64_t next_us) {
        refused_us = next_us;
        return next_us < test::kSceneChangeUs;
    });
    run.run();
    EXPECT_TRUE(run.simulation.stopped());
    EXPECT_GE(refused_us, test::kSceneChangeUs);
    EXPECT_LT(run.simulation.duration_us(), test::kSceneChangeUs);
}

TEST(Pace, ReadsSpeeds)
{
    EXPECT_EQ(parse_speed("realtime"), 1);
    EXPECT_EQ(parse_speed("10"), 10);
    EXPECT_EQ(parse_speed("0.25"), 0.25);
    for (const char *odd : {"", "fast", "0", "-1", "1x", "nan", "inf", "1e7", "0.0001", " 1"}) {
        try {
            parse_speed(odd);
            ADD_FAILURE() << odd;
        } catch (const InputError &error) {
            EXPECT_EQ(error.field(), "--speed") << odd;
        }
    }
}

} // namespace
} // namespace tsr
