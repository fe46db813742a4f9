/* Events: received, stored, acknowledged, told in metres. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "test_sink_messages.h"
#include "tsr/host/read_file.h"
#include "tsr/sink/export.h"
#include "tsr/sink/receiver.h"
#include "tsr/sink/site_event.h"

namespace tsr
{
namespace
{

using test::Bytes;

constexpr std::uint8_t kDoor = 0;
constexpr std::uint8_t kLevel = 1;

SiteZone zone(const std::string &name, ZoneKind kind, double depth_m)
{
    SiteZone zone;
    zone.name = name;
    zone.pair = "porch";
    zone.part = {4, 2, 9, 7};
    zone.kind = kind;
    zone.depth_m = depth_m;
    return zone;
}

Site site_with_zones()
{
    Site site = test::small_site();
    site.pairs[0].zones = {zone("door, left", ZoneKind::below, 1.5), zone("level", ZoneKind::changed, 0.1)};
    check_site(site);
    return site;
}

class SinkEvent : public ::testing::Test
{
  protected:
    int feed(const Bytes &body, std::uint32_t counter, std::uint16_t node = 3)
    {
        const auto fragments = test::event_fragments(keys, node, counter, body);
        EXPECT_EQ(fragments.size(), 1u);
        const Bytes answer = receiver.receive(fragments)[0];
        return answer.empty() ? 0 : test::open_status(keys, node, answer).state;
    }

    std::uint64_t refused(Cause cause) const { return receiver.tally().count(cause); }

    const test::Folder folder;
    const Site site = site_with_zones();
    const KeyRing keys = derive_test_keys(1, site);
    Store store{folder / "a.db", site.pan_id};
    Receiver receiver{site, keys, store};
};

TEST_F(SinkEvent, IsStoredThenCommitted)
{
    std::vector<EventReport> reports;
    receiver.on_events([&](const EventReport &report) { reports.push_back(report); });
    const Bytes body =
        test::event_body({{kDoor, TSR_EVENT_BEGUN, 1024, 2560}, {kLevel, TSR_EVENT_MEASURED, 4096, 640}});
    EXPECT_EQ(feed(body, 70000), TSR_DELIVERY_COMMITTED);
    const auto stored = store.find_events(3, 70000);
    ASSERT_TRUE(stored.has_value());
    EXPECT_EQ(stored->capture_time_us, 1000u);
    EXPECT_EQ(stored->capture_id, 7);
    ASSERT_EQ(stored->events.size(), 2u);
    EXPECT_EQ(stored->events[1], (StoredEvent{kLevel, TSR_EVENT_MEASURED, 4096, 640}));
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(reports[0].pair->name, "porch");
    EXPECT_EQ(reports[0].events, *stored);
}

TEST_F(SinkEvent, RepeatedIsAcknowledgedAgainAlsoAfterARestart)
{
    const Bytes body = test::event_body({{kDoor, TSR_EVENT_ENDED, 0, TSR_EVENT_NO_DISPARITY}});
    EXPECT_EQ(feed(body, 5), TSR_DELIVERY_COMMITTED);
    EXPECT_EQ(feed(body, 5), TSR_DELIVERY_COMMITTED);
    Receiver restarted(site, keys, store);
    const Bytes answer = restarted.receive(test::event_fragments(keys, 3, 5, body))[0];
    EXPECT_EQ(test::open_status(keys, 3, answer).state, TSR_DELIVERY_COMMITTED);
    int messages = 0;
    store.for_each_events([&](const StoredEvents &) { messages++; });
    EXPECT_EQ(messages, 1);
}

TEST_F(SinkEvent, OfZonesThatTheSiteDoesNotHaveIsRefused)
{
    EXPECT_EQ(feed(test::event_body({{2, TSR_EVENT_BEGUN, 1, 0}}), 1), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(feed(test::event_body({{kDoor, TSR_EVENT_MEASURED, 1, 0}}), 2), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(feed(test::event_body({{kLevel, TSR_EVENT_ENDED, 1, 0}}), 3), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(feed(test::event_body({{kDoor, TSR_EVENT_BEGUN, 1, 0}}), 4, 5), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(refused(Cause::other_settings), 4u);
    EXPECT_EQ(feed(Bytes(TSR_BODY_EVENT_HEADER_LEN + 1), 6), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(refused(Cause::body_format), 1u);
    EXPECT_EQ(feed(test::event_body({{kDoor, TSR_EVENT_BEGUN, 1, 0}}), 7, 2), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(refused(Cause::no_pair), 1u);
    store.for_each_events([](const StoredEvents &) { ADD_FAILURE() << "stored"; });
}

/* f B = 6 px m, d0 = 1.5 px: 10 px are 6 / 11.5 m; the zone's middle is (8, 5), the axis (15.5, 11.5), f = 100 px. */
TEST_F(SinkEvent, IsToldInMetres)
{
    const SiteEvent event = describe_event(site.pairs[0], {kDoor, TSR_EVENT_BEGUN, 1024, 2560});
    EXPECT_EQ(event.zone, "door, left");
    EXPECT_EQ(event.kind, "begun");
    EXPECT_DOUBLE_EQ(event.area_percent, 25);
    EXPECT_NEAR(event.depth_m.value(), 0.5217, 1e-4);
    const auto &[x, y, z] = event.position_m.value();
    EXPECT_NEAR(x, 0.5217 * -0.075, 1e-4);
    EXPECT_NEAR(y, 0.5217 * -0.065, 1e-4);
    EXPECT_NEAR(z, 0.5217, 1e-4);
    EXPECT_EQ(event_text(event), "begun in 'door, left': 25 % at 0.52 m");
    const SiteEvent gone = describe_event(site.pairs[0], {kLevel, TSR_EVENT_VANISHED, 0, TSR_EVENT_NO_DISPARITY});
    EXPECT_FALSE(gone.depth_m.has_value());
    EXPECT_EQ(event_text(gone), "vanished in 'level': 0 %");
}

TEST_F(SinkEvent, IsExportedAsCsv)
{
    feed(test::event_body(
             {{kDoor, TSR_EVENT_BEGUN, 1024, 2560}, {kLevel, TSR_EVENT_VANISHED, 0, TSR_EVENT_NO_DISPARITY}}),
         9);
    EXPECT_EQ(export_site(site, store, {}, folder / "out").events, 2u);
    EXPECT_EQ(read_text_file(folder / "out/events.csv"),
              "node,pair,counter,capture_time_us,zone,kind,area_percent,depth_m,x_m,y_m,z_m\n"
              "3,porch,9,1000,\"door, left\",begun,25.00,0.5217,-0.0391,-0.0339,0.5217\n"
              "3,porch,9,1000,level,vanished,0.00,,,,\n");
}

} // namespace
} // namespace tsr
