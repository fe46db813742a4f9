/*
 * Faults on a timeline: what each does to its node, and that the rest of the
 * tree keeps delivering. Power lost at every event is test_power_lost.cpp's.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "memory_run.h"
#include "test_host_folder.h"

namespace tsr
{
namespace
{

using test::expect_kept;
using test::kBinocular;
using test::kGateway;
using test::kLead;
using test::kRelay;
using test::kWing;
using test::MemoryRun;
using test::short_site;

constexpr std::uint64_t kSecond = 1'000'000;
constexpr std::uint32_t kHigher = 1'000'000; /* counters that no earlier life has used */
constexpr std::uint64_t kBefore = 700'000;   /* the first maps are there, the scene has not changed */

Site with(SiteFault fault, bool flat = false)
{
    Site site = short_site(flat);
    site.faults.push_back(fault);
    return site;
}

void expect_all_delivered(MemoryRun &run)
{
    expect_kept(run);
    EXPECT_TRUE(run.simulation.quiet());
    EXPECT_TRUE(run.is_up_to_date(kLead));
    EXPECT_TRUE(run.is_up_to_date(kBinocular));
}

TEST(FaultTimeline, ACalmRunDeliversTwoMapsOfEachPair)
{
    MemoryRun run(short_site());
    run.run();
    expect_all_delivered(run);
    EXPECT_EQ(run.maps_of(kLead).size(), 2u);
    EXPECT_EQ(run.maps_of(kBinocular).size(), 2u);
    EXPECT_TRUE(run.simulation.faults().notes().empty());
    EXPECT_LT(run.simulation.virtual_us(kLead, run.maps_of(kLead).front().capture_time_us), kBefore);
}

TEST(FaultTimeline, TheDeathOfALeafLeavesTheRest)
{
    MemoryRun run(with({.at_us = kBefore, .kind = SiteFaultKind::death, .node = kBinocular}));
    run.run();
    expect_kept(run);
    EXPECT_TRUE(run.is_up_to_date(kLead));
    EXPECT_EQ(run.maps_of(kBinocular).size(), 1u);
    EXPECT_FALSE(run.node(kBinocular).powered());
    EXPECT_TRUE(run.simulation.quiet());
    ASSERT_EQ(run.simulation.faults().notes().size(), 1u);
    EXPECT_EQ(run.simulation.faults().notes()[0].time_us, kBefore);
}

/* The tree is static: nobody looks for another parent. */
TEST(FaultTimeline, TheDeathOfAnInnerNodeSilencesItsSubtree)
{
    MemoryRun run(with({.at_us = kBefore, .kind = SiteFaultKind::death, .node = kRelay}, true));
    run.run(20 * kSecond);
    expect_kept(run);
    EXPECT_EQ(run.maps_of(kLead).size(), 1u);
    EXPECT_FALSE(run.simulation.quiet()); /* the lead keeps trying */
    EXPECT_TRUE(run.is_up_to_date(kBinocular));
}

TEST(FaultTimeline, ADeadNodeUsesNothing)
{
    MemoryRun run(with({.at_us = 0, .kind = SiteFaultKind::death, .node = kBinocular}));
    run.run();
    EXPECT_EQ(run.node(kBinocular).energy().total(), 0.0);
    EXPECT_EQ(run.simulation.air_tally(4).frames, 0u);
    EXPECT_GT(run.node(kLead).energy().total(), 0.0);
}

TEST(FaultTimeline, ANodeIsOffUntilItStarts)
{
    Site site = short_site();
    site.nodes[4].start_ms = 400; /* the binocular node */
    MemoryRun early(site);
    early.simulation.run([](std::uint64_t now_us, std::uint64_t) { return now_us < 1'000; });
    EXPECT_FALSE(early.node(kBinocular).powered());
    EXPECT_EQ(early.node(kBinocular).energy().total(), 0.0);
    site.faults = {{.at_us = 100'000, .kind = SiteFaultKind::reboot, .node = kBinocular},
                   {.at_us = 200'000, .for_us = 100'000, .kind = SiteFaultKind::brown_out, .node = kBinocular}};
    MemoryRun run(site);
    run.run();
    expect_all_delivered(run);
    EXPECT_EQ(run.node(kBinocular).lives(), 1u);
    for (const FaultNote &note : run.simulation.faults().notes()) {
        EXPECT_TRUE(note.without_effect);
    }
}

TEST(FaultTimeline, ARebootWithHigherCountersDeliversAgain)
{
    for (const std::uint16_t id : {kGateway, kRelay, kLead, kWing, kBinocular}) {
        SCOPED_TRACE("node " + std::to_string(id));
        MemoryRun run(with({.at_us = kBefore, .kind = SiteFaultKind::reboot, .node = id, .counter_start = kHigher}));
        run.run();
        expect_all_delivered(run);
        EXPECT_EQ(run.node(id).lives(), 2u);
        EXPECT_FALSE(run.simulation.faults().notes()[0].without_effect);
    }
}

/*
 * Counters start again with the configuration's, as there is no storage yet. Frames are
 * refused as repetitions until their counter passes the last life's, and the sink takes a
 * message whose counter it has stored for a repetition: it acknowledges a map it drops.
 */
TEST(FaultTimeline, ARebootThatForgetsItsCounters)
{
    MemoryRun run(with({.at_us = kBefore, .kind = SiteFaultKind::reboot, .node = kBinocular}));
    run.run();
    EXPECT_TRUE(run.is_up_to_date(kLead)); /* nobody else suffers */
    EXPECT_GT(run.node(kRelay).mac_counters().dropped_replay, 0u);
    EXPECT_EQ(run.node(kLead).counters().maps_sent, run.maps_of(kLead).size());
    EXPECT_GT(run.node(kBinocular).counters().maps_sent, run.maps_of(kBinocular).size());
}

TEST(FaultTimeline, ABrownOutEndsAndUsesNothingMeanwhile)
{
    MemoryRun run(with({.at_us = kBefore,
                        .for_us = 3 * kSecond,
                        .kind = SiteFaultKind::brown_out,
                        .node = kBinocular,
                        .counter_start = kHigher}));
    run.run();
    expect_all_delivered(run);
    EXPECT_GE(run.simulation.duration_us(), kBefore + 3 * kSecond);
    EXPECT_GE(run.maps_of(kBinocular).back().capture_time_us, kBefore + 3 * kSecond);
    const double listening_mj = run.node(kRelay).energy().radio.receive;
    EXPECT_LT(run.node(kBinocular).energy().radio.receive, listening_mj / 2); /* 3 of about 4 seconds */
}

TEST(FaultTimeline, ANodeIsOffUntilTheLastBrownOutEnds)
{
    Site site = short_site();
    const auto add = [&](std::uint64_t at_us, std::uint64_t for_us, SiteFaultKind kind) {
        site.faults.push_back(
            {.at_us = at_us, .for_us = for_us, .kind = kind, .node = kBinocular, .counter_start = kHigher});
    };
    add(500'000, 2 * kSecond, SiteFaultKind::brown_out);
    add(600'000, 100'000, SiteFaultKind::brown_out); /* within the first */
    add(800'000, 0, SiteFaultKind::reboot);
    add(900'000, 4 * kSecond, SiteFaultKind::brown_out);
    MemoryRun run(site);
    run.run();
    expect_all_delivered(run);
    EXPECT_EQ(run.node(kBinocular).lives(), 2u);
    const auto &notes = run.simulation.faults().notes();
    ASSERT_EQ(notes.size(), 4u);
    EXPECT_FALSE(notes[0].without_effect);
    EXPECT_TRUE(notes[1].without_effect);
    EXPECT_TRUE(notes[2].without_effect);
    EXPECT_FALSE(notes[3].without_effect);
}

TEST(FaultTimeline, ADriftMovesTheClockOfItsNodeAlone)
{
    for (const int ppm : {-1000, 1000}) {
        SCOPED_TRACE(ppm);
        Site site = with({.at_us = 0, .kind = SiteFaultKind::clock_drift, .node = kLead, .ppm = ppm});
        site.faults.push_back(
            {.at_us = 0, .for_us = 500'000, .kind = SiteFaultKind::clock_drift, .node = kWing, .ppm = -ppm});
        MemoryRun run(site);
        run.run();
        expect_all_delivered(run);
        const std::uint64_t local_us = run.maps_of(kLead).back().capture_time_us;
        const auto virtual_us = static_cast<std::int64_t>(run.simulation.virtual_us(kLead, local_us));
        EXPECT_NEAR(static_cast<double>(local_us), static_cast<double>(virtual_us) * (1 + ppm / 1e6), 2);
        EXPECT_NE(static_cast<std::int64_t>(local_us), virtual_us);
        EXPECT_EQ(run.node(kWing).clock().local_us(2 * kSecond), 2 * kSecond - static_cast<std::uint64_t>(ppm / 2));
        EXPECT_EQ(run.node(kRelay).clock().local_us(2 * kSecond), 2 * kSecond);
    }
}

TEST(FaultTimeline, ALinkThatIsCutForAWhileDeliversAfterwards)
{
    for (const std::uint16_t other : {kGateway, kNodeNone}) {
        MemoryRun run(with({.at_us = kBefore,
                            .for_us = 2 * kSecond,
                            .kind = SiteFaultKind::link_loss,
                            .node = kRelay,
                            .other = other,
                            .loss_db = kLinkLossDbMax}));
        run.run();
        expect_all_delivered(run);
        EXPECT_GT(run.simulation.air_tally(1).lost + run.simulation.air_tally(2).lost, 3u);
        EXPECT_GT(run.simulation.duration_us(), kBefore + 2 * kSecond);
    }
}

TEST(FaultTimeline, ALinkThatLosesHalfIsRepaired)
{
    MemoryRun run(
        with({.at_us = 0, .kind = SiteFaultKind::link_loss, .node = kRelay, .other = kGateway, .frame_loss = 0.5}));
    run.run();
    expect_all_delivered(run);
    EXPECT_GT(run.node(kRelay).mac_counters().retries, 3u);
}

TEST(FaultTimeline, ACameraThatFailsForAWhileIsTriedAgain)
{
    for (const std::uint16_t id : {kLead, kWing, kBinocular}) {
        SCOPED_TRACE("node " + std::to_string(id));
        MemoryRun run(
            with({.at_us = kBefore, .for_us = 2 * kSecond, .kind = SiteFaultKind::camera_failure, .node = id}));
        run.run();
        expect_all_delivered(run);
        EXPECT_GT(run.node(id == kWing ? kLead : id).counters().captures_failed, 0u);
    }
}

TEST(FaultTimeline, TheGatewayRestarts)
{
    for (const std::uint64_t for_us : {std::uint64_t{0}, 2 * kSecond}) {
        MemoryRun run(with(
            {.at_us = kBefore, .for_us = for_us, .kind = SiteFaultKind::gateway_restart, .counter_start = kHigher}));
        run.run();
        expect_all_delivered(run);
        EXPECT_EQ(run.node(kGateway).lives(), 2u);
        EXPECT_EQ(run.simulation.faults().notes()[0].fault.node, kGateway);
    }
}

TEST(FaultTimeline, TheSinkRestartsAtEveryTenthOfASecond)
{
    Site site = short_site();
    for (std::uint64_t at_us = 0; at_us < 1'500'000; at_us += 100'000) {
        site.faults.push_back({.at_us = at_us, .kind = SiteFaultKind::sink_restart});
    }
    MemoryRun run(site);
    run.run();
    expect_all_delivered(run);
    EXPECT_EQ(run.sink.restarts, 15u);
}

std::string bytes_on_air(MemoryRun &run)
{
    const test::Folder folder;
    PcapngCapture capture(folder / "capture.pcapng");
    run.simulation.record_air(capture);
    run.run();
    capture.complete();
    return test::read_all(folder / "capture.pcapng");
}

TEST(FaultTimeline, TheSameSeedGivesTheSameRun)
{
    Site site = short_site();
    site.faults = {
        {.at_us = 150'000, .kind = SiteFaultKind::clock_drift, .node = kLead, .ppm = 100},
        {.at_us = 300'000, .kind = SiteFaultKind::reboot, .node = kRelay, .counter_start = kHigher},
        {.at_us = 600'000, .for_us = 200'000, .kind = SiteFaultKind::link_loss, .node = kRelay, .frame_loss = 0.3},
        {.at_us = 1'010'000,
         .for_us = 50'000,
         .kind = SiteFaultKind::brown_out,
         .node = kWing,
         .counter_start = kHigher},
        {.at_us = 1'100'000, .for_us = 300'000, .kind = SiteFaultKind::camera_failure, .node = kBinocular},
        {.at_us = 1'200'000, .kind = SiteFaultKind::gateway_restart, .counter_start = kHigher},
        {.at_us = 1'250'000, .kind = SiteFaultKind::sink_restart}};
    MemoryRun first(site), second(site), other(site, 2);
    const std::string on_air = bytes_on_air(first);
    EXPECT_EQ(on_air, bytes_on_air(second));
    EXPECT_NE(on_air, bytes_on_air(other));
    EXPECT_EQ(first.events, second.events);
    for (MemoryRun *run : {&first, &second, &other}) {
        expect_kept(*run);
    }
}

} // namespace
} // namespace tsr
