/* Zones that can tell of nothing are found. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_site.h"
#include "tsr/emulator/record_json.h"
#include "tsr/emulator/zone_record.h"

namespace tsr
{
namespace
{

class ZoneRecords : public testing::Test
{
  protected:
    ZoneRecords()
    {
        pair.zones.resize(2);
        pair.zones[0].name = "door";
        pair.zones[0].depth_m = 2;
        pair.zones[1].name = "sill";
        run.site = &site;
    }

    void told(const char *zone, const char *kind, std::uint64_t time_us)
    {
        ReceivedEvent event;
        event.node = pair.lead;
        event.zone = zone;
        event.kind = kind;
        event.capture_time_us = time_us;
        run.zone_events.push_back(event);
    }

    void look(std::uint64_t from_us, std::uint64_t until_us)
    {
        run.episodes.push_back({pair.lead, from_us, until_us, Fate::committed});
    }

    ZoneRecord door() const { return zone_records(run).at(0); }

    Site site = test::small_site();
    SitePair &pair = site.pairs.front();
    RunRecord run;
};

TEST_F(ZoneRecords, AreOfEveryZoneWithItsEvents)
{
    told("door", "begun", 5);
    told("door", "ended", 6);
    const auto records = zone_records(run);
    ASSERT_EQ(records.size(), 2u);
    EXPECT_EQ(records[0].events, 2u);
    EXPECT_EQ(records[1].events, 0u);
    EXPECT_EQ(json_of(records[0]).dump(), R"({"pair":")" + pair.name + R"(","node":)" + std::to_string(pair.lead) +
                                              R"(,"zone":"door","below_m":2.0,"events":2,"always_begun":false})");
}

TEST_F(ZoneRecords, ABeginningWithTheFirstLookAndNoEndIsFound)
{
    look(50, 70);
    look(2, 9);
    told("door", "begun", 5);
    EXPECT_TRUE(door().always_begun);
    told("door", "begun", 90); /* the node started again */
    EXPECT_TRUE(door().always_begun);
    told("door", "ended", 100);
    EXPECT_FALSE(door().always_begun);
}

TEST_F(ZoneRecords, SomebodyWhoStaysIsNot)
{
    look(2, 9); /* whose map and events were lost */
    look(38, 45);
    told("door", "begun", 40);
    EXPECT_FALSE(door().always_begun);
}

TEST_F(ZoneRecords, ASurfaceThatIsFollowedIsNot)
{
    look(2, 9);
    told("door", "measured", 5);
    EXPECT_FALSE(door().always_begun);
}

} // namespace
} // namespace tsr
