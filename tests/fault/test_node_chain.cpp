/*
 * The whole chain under every single fault: each frame and acknowledgement on
 * air lost, each frame doubled, each call of camera, radio and port refused, each
 * answer of the sink lost, one at a time.
 *
 * Each run must end quiet with the last map of both pairs in the store, byte by
 * byte that of the calm run. TSR_FAULT=KIND:N[,KIND:N...] replays one run;
 * TSR_TEST_ALL=1 adds other seeds and pairs of faults.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cstdlib>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tiny_site.h"

namespace tsr
{
namespace
{

using test::Fault;
using test::FaultKind;
using test::TinyNode;
using test::TinySite;

constexpr std::uint16_t kLead = 3;
constexpr std::uint16_t kWing = 4;
constexpr std::uint16_t kBinocular = 5;
constexpr std::uint64_t kSecond = 1'000'000;
constexpr std::uint64_t kPatience = 40 * kSecond;
constexpr std::uint64_t kSkewMaxUs = TSR_CAPTURE_ORDER_US + 1; /* between the two views of a pair */

struct Calm { /* what a run without faults gives */
    std::map<FaultKind, std::uint64_t> calls;
    std::vector<std::uint8_t> last_lead;
    std::vector<std::uint8_t> last_binocular;
};

bool ends_with(TinySite &site, std::uint16_t id, const std::vector<std::uint8_t> &coded_map)
{
    const std::vector<StoredMap> maps = site.maps_of(id);
    return !maps.empty() && maps.back().capture_time_us >= test::kChangeUs && maps.back().coded_map == coded_map;
}

/* Run until both last maps are stored and everything rests, or patience ends. */
void run(TinySite &site, const Calm &calm)
{
    site.start();
    for (std::uint64_t time_us = test::kChangeUs + kSecond; time_us < kPatience; time_us += kSecond / 4) {
        site.run_until(time_us);
        if (ends_with(site, kLead, calm.last_lead) && ends_with(site, kBinocular, calm.last_binocular) &&
            site.at_rest()) {
            return;
        }
    }
}

Calm calm_run(std::uint64_t seed)
{
    TinySite site({}, seed);
    site.start();
    site.run_until(test::kChangeUs + 2 * kSecond);
    Calm calm;
    calm.calls = site.calls;
    EXPECT_TRUE(site.at_rest());
    EXPECT_EQ(site.maps_of(kLead).size(), 2u);
    EXPECT_EQ(site.maps_of(kBinocular).size(), 2u);
    if (!site.maps_of(kLead).empty() && !site.maps_of(kBinocular).empty()) {
        calm.last_lead = site.maps_of(kLead).back().coded_map;
        calm.last_binocular = site.maps_of(kBinocular).back().coded_map;
    }
    return calm;
}

const Calm &calm()
{
    static const Calm result = calm_run(1);
    return result;
}

std::string name_of(const std::vector<Fault> &faults)
{
    std::string name;
    for (const Fault &fault : faults) {
        name += (name.empty() ? "" : ",") + std::string(fault_name(fault.kind)) + ":" + std::to_string(fault.n);
    }
    return name;
}

bool hits_camera(const std::vector<Fault> &faults)
{
    return std::any_of(faults.begin(), faults.end(), [](const Fault &fault) {
        return fault.kind == FaultKind::camera_call || fault.kind == FaultKind::camera_done;
    });
}

/* Both views of every stored map of the lead were taken at one instant. */
void expect_one_instant(TinySite &site)
{
    const std::vector<std::uint64_t> &captures = site.node(kWing).left().captures();
    for (const StoredMap &map : site.maps_of(kLead)) {
        const bool found = std::any_of(captures.begin(), captures.end(), [&](std::uint64_t time_us) {
            return time_us < map.capture_time_us + kSkewMaxUs && map.capture_time_us < time_us + kSkewMaxUs;
        });
        EXPECT_TRUE(found) << "no view of the wing at " << map.capture_time_us;
    }
}

void expect_no_map_twice(TinySite &site)
{
    std::set<std::pair<std::uint16_t, std::uint64_t>> seen;
    site.store.for_each([&](const StoredMap &map) {
        EXPECT_TRUE(seen.emplace(map.node, map.capture_time_us).second) << "stored twice: node " << map.node;
    });
}

void expect_nothing_lost(TinySite &site, bool camera_failed)
{
    for (const std::uint16_t id : {kLead, kBinocular}) {
        const tsr_node_counters &counters = *tsr_node_get_counters(&site.node(id).node);
        EXPECT_EQ(counters.maps_lost, 0u) << "node " << id;
        EXPECT_EQ(counters.maps_sent, site.maps_of(id).size()) << "node " << id;
        EXPECT_LE(counters.captures_failed, camera_failed ? 1u : 0u) << "node " << id;
        EXPECT_EQ(counters.dropped_auth, 0u) << "node " << id;
    }
    const tsr_node_counters &wing = *tsr_node_get_counters(&site.node(kWing).node);
    EXPECT_LE(wing.views_lost, camera_failed ? 1u : 0u);
    for (const auto &node : site.nodes) {
        EXPECT_EQ(node->node.counters.dropped_route, 0u) << "node " << node->id();
        EXPECT_EQ(node->node.counters.dropped_format, 0u) << "node " << node->id();
    }
    EXPECT_EQ(site.receiver.tally().count(Cause::message_format), 0u);
    EXPECT_EQ(site.receiver.tally().count(Cause::not_authentic), 0u);
    EXPECT_EQ(site.receiver.tally().count(Cause::counter_reused), 0u);
}

/* What holds after any faults that pass. */
void expect_recovered(TinySite &site, const Calm &calm)
{
    EXPECT_TRUE(site.at_rest());
    EXPECT_TRUE(ends_with(site, kLead, calm.last_lead));
    EXPECT_TRUE(ends_with(site, kBinocular, calm.last_binocular));
    expect_one_instant(site);
    expect_no_map_twice(site);
}

void check(const std::vector<Fault> &faults, const Calm &calm, std::uint64_t seed = 1)
{
    SCOPED_TRACE("replay: TSR_FAULT=" + name_of(faults) + " TSR_SEED=" + std::to_string(seed));
    TinySite site(faults, seed);
    run(site, calm);
    expect_recovered(site, calm);
    if (faults.size() <= 1) {
        expect_nothing_lost(site, hits_camera(faults));
    }
}

bool all_tests()
{
    const char *all = std::getenv("TSR_TEST_ALL");
    return all != nullptr && std::string(all) == "1";
}

class EveryFault : public testing::TestWithParam<FaultKind>
{
};

TEST_P(EveryFault, EndsQuietWithBothMaps)
{
    const FaultKind kind = GetParam();
    if (std::getenv("TSR_FAULT") != nullptr) {
        GTEST_SKIP() << "TSR_FAULT is set";
    }
    const std::uint64_t count = calm().calls.at(kind);
    for (std::uint64_t n = 0; n < count && !HasFailure(); ++n) {
        check({{kind, n}}, calm());
    }
    std::printf("%s: %llu cases\n", fault_name(kind), static_cast<unsigned long long>(count));
}

INSTANTIATE_TEST_SUITE_P(Chain, EveryFault,
                         testing::Values(FaultKind::lose_frame, FaultKind::double_frame, FaultKind::lose_ack,
                                         FaultKind::camera_call, FaultKind::camera_done, FaultKind::transmit,
                                         FaultKind::port_write, FaultKind::port_damage, FaultKind::lose_answer,
                                         FaultKind::double_answer),
                         [](const auto &info) { return std::string(fault_name(info.param)); });

TEST(Chain, Replay)
{
    const char *text = std::getenv("TSR_FAULT");
    if (text == nullptr) {
        GTEST_SKIP() << "TSR_FAULT is not set";
    }
    std::vector<Fault> faults;
    std::istringstream list(text);
    for (std::string item; std::getline(list, item, ',');) {
        const std::size_t colon = item.find(':');
        for (int kind = 0; kind < static_cast<int>(FaultKind::kind_count); ++kind) {
            if (item.substr(0, colon) == fault_name(static_cast<FaultKind>(kind))) {
                faults.push_back({static_cast<FaultKind>(kind), std::stoull(item.substr(colon + 1))});
            }
        }
    }
    const char *seed_text = std::getenv("TSR_SEED");
    const std::uint64_t seed = seed_text != nullptr ? std::stoull(seed_text) : 1;
    check(faults, calm_run(seed), seed);
}

TEST(Chain, CalmRunsOfOtherSeeds)
{
    for (std::uint64_t seed = 2; seed < (all_tests() ? 200 : 12); ++seed) {
        check({}, calm_run(seed), seed);
    }
}

/* Frames in a row: four end a hop's patience, more a WAKE's. */
TEST(Chain, EveryBurst)
{
    std::uint64_t cases = 0;
    for (const FaultKind kind : {FaultKind::lose_frame, FaultKind::lose_ack, FaultKind::transmit}) {
        for (const std::uint64_t length : {2, 3, 4, 8}) {
            for (std::uint64_t n = 0; n < calm().calls.at(kind) && !HasFailure(); ++n, ++cases) {
                std::vector<Fault> faults;
                for (std::uint64_t i = 0; i < length; ++i) {
                    faults.push_back({kind, n + i});
                }
                check(faults, calm());
            }
        }
    }
    std::printf("%llu bursts\n", static_cast<unsigned long long>(cases));
}

/* Two faults anywhere; all of them with TSR_TEST_ALL=1, else every 97th. */
TEST(Chain, PairsOfFaults)
{
    std::vector<Fault> all;
    for (int kind = 1; kind < static_cast<int>(FaultKind::kind_count); ++kind) {
        for (std::uint64_t n = 0; n < calm().calls.at(static_cast<FaultKind>(kind)); ++n) {
            all.push_back({static_cast<FaultKind>(kind), n});
        }
    }
    const std::size_t stride = all_tests() ? 1 : 97;
    std::uint64_t cases = 0;
    for (std::size_t at = 0; at < all.size() * all.size() && !HasFailure(); at += stride) {
        const Fault &first = all[at / all.size()];
        const Fault &second = all[at % all.size()];
        if (at / all.size() < at % all.size()) {
            check({first, second}, calm());
            ++cases;
        }
    }
    std::printf("%llu pairs\n", static_cast<unsigned long long>(cases));
}

/* The same faults at other back-offs. */
TEST(Chain, OtherSeeds)
{
    for (std::uint64_t seed = 2; seed < (all_tests() ? 30 : 4); ++seed) {
        const Calm other = calm_run(seed);
        for (const FaultKind kind : {FaultKind::lose_frame, FaultKind::double_frame, FaultKind::lose_ack}) {
            for (std::uint64_t n = 0; n < other.calls.at(kind) && !HasFailure(); ++n) {
                check({{kind, n}}, other, seed);
            }
        }
    }
}

/* Processors so slow that what a fault delays meets every phase of the lead:
 * the wing asks again for an answer half a second later. */
TEST(Chain, SlowProcessors)
{
    std::uint64_t cases = 0;
    for (std::uint64_t step_us = 7'500; step_us < 14'000; step_us += all_tests() ? 25 : 500) {
        for (std::uint64_t n = 0; n < calm().calls.at(FaultKind::lose_frame) && !HasFailure(); ++n, ++cases) {
            SCOPED_TRACE("step_us " + std::to_string(step_us) + " lose_frame:" + std::to_string(n));
            TinySite site({{FaultKind::lose_frame, n},
                           {FaultKind::lose_frame, n + 1},
                           {FaultKind::lose_frame, n + 2},
                           {FaultKind::lose_frame, n + 3}});
            site.step_us = step_us;
            run(site, calm());
            expect_recovered(site, calm());
            EXPECT_EQ(tsr_node_get_counters(&site.node(kLead).node)->maps_lost, 0u);
            EXPECT_EQ(site.receiver.tally().count(Cause::message_format), 0u);
        }
    }
    std::printf("%llu slow runs\n", static_cast<unsigned long long>(cases));
}

TEST(Chain, DeadWing)
{
    TinySite site;
    for (const std::uint16_t id : {1, 2, 3, 5}) {
        site.node(id).start(1000);
    }
    site.air.radio(3).ops->set_receiving(site.air.radio(3).self, false);
    site.run_until(20 * kSecond);
    const tsr_node_counters &lead = *tsr_node_get_counters(&site.node(kLead).node);
    EXPECT_GE(lead.captures_failed, 20u);
    EXPECT_EQ(lead.captures_failed, lead.frames_woken);
    EXPECT_GE(lead.frames_watched, 20u); /* it goes on watching */
    EXPECT_TRUE(site.maps_of(kLead).empty());
    EXPECT_TRUE(ends_with(site, kBinocular, calm().last_binocular)); /* the other pair does not suffer */
    site.node(kWing).start(1000);
    site.run_until(25 * kSecond);
    EXPECT_TRUE(site.at_rest());
    EXPECT_TRUE(ends_with(site, kLead, calm().last_lead));
    expect_one_instant(site);
}

TEST(Chain, SilentSink)
{
    TinySite site;
    site.sink_silent = true;
    site.start();
    site.run_until(200 * kSecond);
    for (const std::uint16_t id : {kLead, kBinocular}) {
        EXPECT_GE(tsr_node_get_counters(&site.node(id).node)->maps_lost, 1u); /* given up, and tried again */
        EXPECT_LE(tsr_node_get_counters(&site.node(id).node)->maps_lost, 10u);
        EXPECT_EQ(tsr_node_get_counters(&site.node(id).node)->maps_sent, 0u);
    }
    site.sink_silent = false;
    site.run_until(320 * kSecond);
    expect_recovered(site, calm());
}

/* Dead for a time, then back as it was or rebooted above its old counters. */
TEST(Chain, DeadRelay)
{
    for (const bool reboots : {false, true}) {
        for (const std::uint64_t dead_us : {kSecond / 10, kSecond, 5 * kSecond, 100 * kSecond}) {
            SCOPED_TRACE("dead for " + std::to_string(dead_us));
            TinySite site;
            site.start();
            site.run_until(kSecond * 3 / 10);
            site.also_lost = [](const AirFrame &frame) { return frame.sender == 1 || frame.psdu[5] == 2; };
            site.node(2).powered = false;
            site.run_until(kSecond * 3 / 10 + dead_us);
            site.also_lost = nullptr;
            if (reboots) {
                site.node(2).start(1'000'000);
            }
            site.node(2).powered = true;
            site.node(2).restart_timers();
            site.run_until(kSecond + dead_us + 100 * kSecond);
            expect_recovered(site, calm());
        }
    }
}

/* Each node loses its power at any time and comes back with higher counters. */
TEST(Chain, EveryReboot)
{
    const std::uint64_t step_us = all_tests() ? 1'000 : 20'000;
    std::uint64_t cases = 0;
    for (std::uint16_t id = 1; id <= 5; ++id) {
        for (std::uint64_t at_us = 10'000; at_us < test::kChangeUs + kSecond && !HasFailure(); at_us += step_us) {
            SCOPED_TRACE("node " + std::to_string(id) + " reboots at " + std::to_string(at_us));
            TinySite site;
            site.start();
            site.run_until(at_us);
            site.node(id).start(1'000'000);
            site.run_until(test::kChangeUs + kSecond);
            for (int patience = 0; patience < 240 && !(site.at_rest() && ends_with(site, kLead, calm().last_lead) &&
                                                       ends_with(site, kBinocular, calm().last_binocular));
                 ++patience) {
                site.run_until(site.queue.now_us() + kSecond / 2);
            }
            EXPECT_TRUE(site.at_rest());
            EXPECT_TRUE(ends_with(site, kLead, calm().last_lead));
            EXPECT_TRUE(ends_with(site, kBinocular, calm().last_binocular));
            expect_one_instant(site);
            ++cases;
        }
    }
    std::printf("%llu reboots\n", static_cast<unsigned long long>(cases));
}

} // namespace
} // namespace tsr
