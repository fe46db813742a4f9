/*
 * Power lost at every event of a run, by every node: a reboot with counters that
 * no life has used, a reboot that starts them again, and death.
 *
 * Three things hold always: nothing crashes, what a node counts as acknowledged
 * is in the store, and no map is stored twice. The one exception is the node
 * that has forgotten its counters: docs/faults.md says why, the test counts how often.
 * TSR_FAULT=LOSS:NODE:EVENT replays one run; TSR_TEST_ALL=1 lets every node take every event.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <array>
#include <cstdio>
#include <cstdlib>

#include "memory_run.h"

namespace tsr
{
namespace
{

using test::expect_kept;
using test::kBinocular;
using test::kGateway;
using test::kLead;
using test::kWing;
using test::MemoryRun;
using test::short_site;

constexpr std::uint64_t kSecond = 1'000'000;
constexpr std::uint32_t kHigher = 1'000'000; /* counters that no earlier life has used */

enum class Loss {
    reboot,     /* with counters that no life has used */
    forgetting, /* a reboot with the same counters again */
    death
};

constexpr std::array<const char *, 3> kLossNames = {"reboot", "forgetting", "death"};

struct Strike {
    Loss loss;
    std::uint16_t node;
    std::uint64_t event;
};

/* Longer than the strikes: who sends does not watch, and must look again before the end. */
constexpr std::uint64_t kLookedAgainUs = 2'500'000;

bool all_tests()
{
    const char *all = std::getenv("TSR_TEST_ALL");
    return all != nullptr && std::string(all) == "1";
}

bool is_below(const Site &site, std::uint16_t id, std::uint16_t ancestor)
{
    for (const SiteNode *node = site.node(id); node != nullptr; node = site.node(node->parent)) {
        if (node->id == ancestor) {
            return true;
        }
    }
    return false;
}

/* What the sweep has seen of forgotten counters. */
struct Tally {
    std::uint64_t runs = 0;
    std::uint64_t silent = 0;                /* not heard again within 60 s */
    std::uint64_t acknowledged_not_kept = 0; /* maps that a camera node takes for delivered */
};

void check(const Strike &strike, Tally &tally)
{
    SCOPED_TRACE(std::string("replay: TSR_FAULT=") + kLossNames[static_cast<std::size_t>(strike.loss)] + ":" +
                 std::to_string(strike.node) + ":" + std::to_string(strike.event));
    const bool death = strike.loss == Loss::death, forgets = strike.loss == Loss::forgetting;
    MemoryRun run(short_site(), 1, kLookedAgainUs);
    run.run(death ? 4 * kSecond : 60 * kSecond, strike.event,
            {.kind = death ? SiteFaultKind::death : SiteFaultKind::reboot,
             .node = strike.node,
             .counter_start = forgets ? 0 : kHigher});
    expect_kept(run, forgets ? strike.node : kNodeNone);
    bool silent = false;
    for (const std::uint16_t id : {kLead, kBinocular}) {
        const bool concerned = is_below(run.site, id, strike.node) || (id == kLead && strike.node == kWing);
        const bool heard = run.is_up_to_date(id);
        EXPECT_TRUE(heard || (concerned && strike.loss != Loss::reboot)) << "node " << id << " is not heard any more";
        silent = silent || !heard;
        const auto kept = run.maps_of(id).size(), sent = std::size_t{run.node(id).counters().maps_sent};
        tally.acknowledged_not_kept += sent > kept ? sent - kept : 0;
    }
    EXPECT_TRUE(strike.loss != Loss::reboot || run.simulation.quiet());
    tally.silent += silent;
    ++tally.runs;
}

std::uint64_t calm_events()
{
    MemoryRun run(short_site());
    run.run();
    return run.events;
}

class PowerLostAt : public testing::TestWithParam<Loss>
{
};

TEST_P(PowerLostAt, EveryEvent)
{
    if (std::getenv("TSR_FAULT") != nullptr) {
        GTEST_SKIP() << "TSR_FAULT is set";
    }
    const std::uint64_t events = calm_events(), stride = all_tests() ? 1 : 5;
    for (std::uint16_t id = kGateway; id <= kBinocular; ++id) {
        Tally tally;
        /* Another phase for each node: together they meet every event. */
        for (std::uint64_t event = id % stride; event < events && !HasFailure(); event += stride) {
            check({GetParam(), id, event}, tally);
        }
        std::printf("%s of node %u: %llu runs over %llu events; in %llu a pair stays silent; %llu maps acknowledged "
                    "and not kept\n",
                    kLossNames[static_cast<std::size_t>(GetParam())], id, static_cast<unsigned long long>(tally.runs),
                    static_cast<unsigned long long>(events), static_cast<unsigned long long>(tally.silent),
                    static_cast<unsigned long long>(tally.acknowledged_not_kept));
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, PowerLostAt, testing::Values(Loss::reboot, Loss::forgetting, Loss::death),
                         [](const auto &info) {
                             return std::string(kLossNames[static_cast<std::size_t>(info.param)]);
                         });

TEST(PowerLost, Replay)
{
    const char *text = std::getenv("TSR_FAULT");
    if (text == nullptr) {
        GTEST_SKIP() << "TSR_FAULT is not set";
    }
    unsigned node = 0;
    unsigned long long event = 0;
    char name[16] = "";
    ASSERT_EQ(std::sscanf(text, "%15[^:]:%u:%llu", name, &node, &event), 3);
    const auto loss = std::find(kLossNames.begin(), kLossNames.end(), std::string(name));
    ASSERT_NE(loss, kLossNames.end());
    Tally tally;
    check({static_cast<Loss>(loss - kLossNames.begin()), static_cast<std::uint16_t>(node), event}, tally);
}

} // namespace
} // namespace tsr
