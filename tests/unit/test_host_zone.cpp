/* [[zone]]: what is read, what is refused, and what becomes of percent and metres. SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "tsr/host/input_error.h"
#include "tsr/host/site.h"

namespace tsr
{
namespace
{

using test::Folder;

const std::string kDoor = R"(
[[zone]]
pair = "porch"
name = "door"
rectangle = [1, 2, 20, 10]
below_m = 1.5
)";

const std::string kTank = R"(
[[zone]]
pair = "porch"
name = "tank"
rectangle = [0, 0, 32, 24]
changed_by_m = 0.05
area_percent = 25
)";

/* The small site with these lines behind it. */
std::string refusal_with(const std::string &zones)
{
    const Folder folder;
    write_site(folder / "small.toml", test::small_site());
    const auto file = folder.put("site.toml", test::read_all(folder / "small.toml") + zones);
    return test::refusal([&] { load_site(file); });
}

std::string with(const std::string &from, const std::string &to, std::string text = kDoor)
{
    return text.replace(text.find(from), from.size(), to);
}

#define EXPECT_ZONE_REFUSED(zones, words)                                                                              \
    EXPECT_NE(refusal_with(zones).find(words), std::string::npos) << refusal_with(zones)

TEST(HostZone, ReadsAndWritesWhatItReads)
{
    const Folder folder;
    write_site(folder / "small.toml", test::small_site());
    const auto file = folder.put("site.toml", test::read_all(folder / "small.toml") + kDoor + kTank);
    const Site site = load_site(file);
    ASSERT_EQ(site.pairs[0].zones.size(), 2u);
    EXPECT_TRUE(site.pairs[1].zones.empty());
    const SiteZone &door = site.pairs[0].zones[0], &tank = site.pairs[0].zones[1];
    EXPECT_EQ(door.name, "door");
    EXPECT_EQ(door.kind, ZoneKind::below);
    EXPECT_EQ(door.depth_m, 1.5);
    EXPECT_EQ(door.part.height, 10);
    EXPECT_EQ(door.area_percent, 10);
    EXPECT_EQ(tank.kind, ZoneKind::changed);
    EXPECT_EQ(tank.area_percent, 25);
    write_site(folder / "again.toml", site);
    write_site(folder / "third.toml", load_site(folder / "again.toml"));
    EXPECT_EQ(test::read_all(folder / "again.toml"), test::read_all(folder / "third.toml"));
    EXPECT_NE(test::read_all(folder / "again.toml").find("changed_by_m = 0.05"), std::string::npos);
}

TEST(HostZone, RefusesFieldsThatCannotBe)
{
    EXPECT_ZONE_REFUSED(with("pair = \"porch\"\n", ""), "zone 'door': pair: is missing");
    EXPECT_ZONE_REFUSED(with("\"porch\"", "\"attic\""), "zone 'door': pair: there is no pair 'attic'");
    EXPECT_ZONE_REFUSED(with("name = \"door\"\n", ""), "name: is missing");
    EXPECT_ZONE_REFUSED(with("\"door\"", "\"\""), "name: has 0 bytes");
    EXPECT_ZONE_REFUSED(kDoor + kDoor, "name: is used twice for pair 'porch'");
    EXPECT_ZONE_REFUSED(with("[1, 2, 20, 10]", "[1, 2, 20]"), "rectangle: is not a list of 4");
    EXPECT_ZONE_REFUSED(with("[1, 2, 20, 10]", "[1, 2, 20.5, 10]"),
                        "rectangle: is not x, y, width, height in whole px");
    EXPECT_ZONE_REFUSED(with("[1, 2, 20, 10]", "[13, 2, 20, 10]"),
                        "rectangle: [13, 2, 20, 10] is not a rectangle x, y, width, height inside the pair's 32x24");
    EXPECT_ZONE_REFUSED(with("[1, 2, 20, 10]", "[1, 2, 0, 10]"), "rectangle: [1, 2, 0, 10] is not");
    EXPECT_ZONE_REFUSED(kDoor + "colour = 1\n", "zone 'door': colour: unknown field");
    EXPECT_ZONE_REFUSED(kDoor + "area_percent = 0\n", "area_percent: 0 is outside");
    EXPECT_ZONE_REFUSED(kDoor + "area_percent = 101\n", "area_percent: 101 is outside");
    EXPECT_ZONE_REFUSED(kDoor + "hysteresis_percent = 100\n", "hysteresis_percent: 100 is outside");
    EXPECT_ZONE_REFUSED(kTank + "every_s = -1\n", "every_s: -1 is outside 0..3600");
    EXPECT_ZONE_REFUSED(kTank + "hysteresis_percent = 5\n", "hysteresis_percent: does not belong to changed_by_m");
}

TEST(HostZone, HasExactlyOneLimit)
{
    EXPECT_ZONE_REFUSED(with("below_m = 1.5\n", ""),
                        "zone 'door': below_m: is missing, and so are above_m and changed_by_m");
    EXPECT_ZONE_REFUSED(kDoor + "above_m = 2\n", "a zone has one of them");
    EXPECT_ZONE_REFUSED(with("1.5", "-1"), "below_m: -1 is outside");
    EXPECT_ZONE_REFUSED(with("1.5", "nan"), "below_m");
    EXPECT_ZONE_REFUSED(with("0.05", "66", kTank), "changed_by_m: 66 is outside");
}

/* f B = 6 px m, d0 = 1.5 px, 16 disparities: 15 px are 0.364 m, 0 px are 4 m. */
TEST(HostZone, RefusesDepthsThatThePairCannotTell)
{
    EXPECT_EQ(refusal_with(with("1.5", "0.365")), "");
    EXPECT_ZONE_REFUSED(with("1.5", "0.363"), "zone 'door': below_m: is nearer than the pair's 16 disparities reach");
    EXPECT_EQ(refusal_with(with("below_m = 1.5", "above_m = 3.99")), "");
    EXPECT_ZONE_REFUSED(with("below_m = 1.5", "above_m = 4"), "above_m: is farther than the pair's first disparity");
    Site site = test::small_site();
    site.pairs[0].focal_px = 1e6;
    site.pairs[0].zones = {SiteZone{"far", "porch", {0, 0, 1, 1}, ZoneKind::changed, 1}};
    EXPECT_EQ(test::refusal([&] { check_site(site); }),
              "site: zone 'far': pair: focal_px times baseline_mm is above 16777215, more than a node reckons with");
}

TEST(HostZone, AtMostEightOfAPair)
{
    std::string zones;
    for (int i = 0; i < 9; i++) {
        zones += with("door", "door " + std::to_string(i));
    }
    EXPECT_ZONE_REFUSED(zones, "zone 'door 8': pair: 'porch' has 9 zones, not at most 8");
}

TEST(HostZone, PercentBecomePixels)
{
    SiteZone zone;
    zone.part = {0, 0, 10, 7};
    zone.area_percent = 10;
    zone.hysteresis_percent = 50;
    EXPECT_EQ(begin_pixels(zone), 7u);
    EXPECT_EQ(end_pixels(zone), 4u); /* 3.5, rounded up */
    zone.area_percent = 0.01;
    EXPECT_EQ(begin_pixels(zone), 1u);
    EXPECT_EQ(end_pixels(zone), 1u);
}

} // namespace
} // namespace tsr
