/* site.toml: what is read, what is refused and with which words. SPDX-License-Identifier: Apache-2.0 */
#include <cstdlib>

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
using test::small_site;

const std::string kGood = R"([site]
name = "demo"
pan_id = 0xbeef
channel = 15
seed = 7

[radio]
tx_power_dbm = 4
shadowing_db = 6.5
fading_db = 2
fading_period_ms = 250
sensitivity_dbm = -97
capture_db = 4
frame_loss = 0.125

[thresholds]
similarity_px2 = 1

[battery]
capacity_mah = 3500
voltage_v = 3
self_discharge_percent_year = 0.5

[[node]]
id = 1
role = "gateway"

[[node]]
id = 2
name = "attic"
role = "relay"
parent = 1
position_m = [1, 2.5, 3]

[[node]]
id = 3
role = "lead"
parent = 2
frames = "left160"
watch_period_ms = 500
start_ms = 250
watch = [[0, 8, 32, 16], [159, 119, 1, 1]]

[[node]]
id = 4
role = "wing"
parent = 3

[[pair]]
name = "porch"
lead = 3
wing = 4
width = 160
height = 120
disparities = 32
search_start_px = 2
focal_px = 150.5
baseline_mm = 65
principal_px = [80, 60]
left = { position_m = [0, 0, 1] }
right = { position_m = [0.065, 0, 1], principal_px = [81.5, 60] }
)";

/* kGood with the first occurrence of one text replaced. */
std::string with(const std::string &from, const std::string &to)
{
    std::string text = kGood;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string refusal_of(const std::string &text)
{
    const Folder folder;
    const auto file = folder.put("site.toml", text);
    std::string what = test::refusal([&] { load_site(file); });
    EXPECT_EQ(what.find('\n'), std::string::npos);
    const std::size_t name = what.find("site.toml");
    return name == std::string::npos ? what : what.substr(name);
}

#define EXPECT_SITE_REFUSED(text, expected)                                                                            \
    do {                                                                                                               \
        const std::string what_ = refusal_of(text);                                                                    \
        EXPECT_NE(what_.find(expected), std::string::npos) << what_;                                                   \
    } while (false)

TEST(HostSite, ReadsEveryField)
{
    const Folder folder;
    const Site site = load_site(folder.put("site.toml", kGood));
    EXPECT_EQ(site.name, "demo");
    EXPECT_EQ(site.pan_id, 0xbeef);
    EXPECT_EQ(site.seed, 7u);
    EXPECT_EQ(site.radio.tx_power_dbm, 4.0);
    EXPECT_EQ(site.radio.shadowing_db, 6.5);
    EXPECT_EQ(site.radio.fading_db, 2.0);
    EXPECT_EQ(site.radio.fading_period_ms, 250u);
    EXPECT_EQ(site.radio.sensitivity_dbm, -97.0);
    EXPECT_EQ(site.radio.capture_db, 4.0);
    EXPECT_EQ(site.radio.cca_threshold_dbm, -87.0);
    EXPECT_EQ(site.radio.frame_loss, 0.125);
    EXPECT_EQ(site.thresholds.similarity_px2, 1.0);
    EXPECT_EQ(site.battery.capacity_mah, 3500.0);
    EXPECT_EQ(site.battery.voltage_v, 3.0);
    EXPECT_EQ(site.battery.self_discharge_percent_year, 0.5);
    EXPECT_EQ(site.battery.usable_percent, SiteBattery{}.usable_percent);
    ASSERT_EQ(site.nodes.size(), 4u);
    EXPECT_EQ(site.node(2)->name, "attic");
    EXPECT_EQ(site.node(2)->position_m[1], 2.5);
    EXPECT_EQ(site.node(3)->watch_period_ms, 500u);
    EXPECT_EQ(site.node(3)->start_ms, 250u);
    EXPECT_EQ(site.node(2)->start_ms, 0u);
    ASSERT_EQ(site.node(3)->watch.size(), 2u);
    EXPECT_EQ(site.node(3)->watch[0].y, 8);
    EXPECT_EQ(site.node(3)->watch[0].width, 32);
    EXPECT_EQ(site.node(3)->watch[1].x, 159);
    EXPECT_EQ(site.node(3)->watch[1].height, 1);
    EXPECT_EQ(site.node(9), nullptr);
    EXPECT_EQ(site.gateway().id, 1);
    ASSERT_EQ(site.pairs.size(), 1u);
    EXPECT_EQ(site.pair_of(4), &site.pairs[0]);
    EXPECT_EQ(site.pair_of(2), nullptr);
    EXPECT_EQ(site.pairs[0].d0_px, 3.5); /* 2 + 81.5 - 80 */
    EXPECT_EQ(site.resolve(site.node(3)->frames), folder / "left160");
}

TEST(HostSite, WritesWhatItReads)
{
    const Folder folder;
    Site site = small_site();
    site.name = "a \"quoted\" \\ name";
    site.seed = 123456789012345;
    site.pairs[0].left.rotation = {0, 0, 1, -1, 0, 0, 0, -1, 0};
    site.pairs[0].truth = "truth";
    site.nodes[2].frames = "left";
    site.pairs[1].right = SitePose{{0.06, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    site.radio.path_loss_exponent = 1.0 / 0.3;
    site.radio.shadowing_db = 5;
    site.radio.fading_db = 1.5;
    site.radio.fading_period_ms = 333;
    site.radio.capture_db = 0.5;
    site.radio.cca_threshold_dbm = -77;
    site.battery = {2600, 1.0 / 0.3, 70, 2.5, 80, 12.5};
    const std::uint16_t lead = site.pairs[0].lead;
    for (SiteNode &node : site.nodes) {
        if (node.id == lead) {
            node.watch = {{1, 2, 3, 4}, {0, 0, site.pairs[0].width, site.pairs[0].height}};
        }
    }
    write_site(folder / "site.toml", site);
    const Site read = load_site(folder / "site.toml");
    write_site(folder / "again.toml", read);
    EXPECT_EQ(test::read_all(folder / "site.toml"), test::read_all(folder / "again.toml"));
    EXPECT_EQ(read.name, site.name);
    EXPECT_EQ(read.seed, site.seed);
    EXPECT_EQ(read.radio.path_loss_exponent, site.radio.path_loss_exponent);
    EXPECT_EQ(read.radio.shadowing_db, 5.0);
    EXPECT_EQ(read.radio.fading_db, 1.5);
    EXPECT_EQ(read.radio.fading_period_ms, 333u);
    EXPECT_EQ(read.radio.capture_db, 0.5);
    EXPECT_EQ(read.radio.cca_threshold_dbm, -77.0);
    EXPECT_EQ(read.battery.capacity_mah, 2600.0);
    EXPECT_EQ(read.battery.voltage_v, 1.0 / 0.3);
    EXPECT_EQ(read.battery.usable_percent, 70.0);
    EXPECT_EQ(read.battery.self_discharge_percent_year, 2.5);
    EXPECT_EQ(read.battery.converter_efficiency_percent, 80.0);
    EXPECT_EQ(read.battery.converter_quiescent_ua, 12.5);
    EXPECT_EQ(read.pairs[0].left.rotation, site.pairs[0].left.rotation);
    EXPECT_EQ(read.pairs[0].d0_px, 1.5);
    ASSERT_EQ(read.node(lead)->watch.size(), 2u);
    EXPECT_EQ(read.node(lead)->watch[0].height, 4);
    EXPECT_TRUE(read.pairs[1].right.has_value());
}

TEST(HostSite, RefusesSyntaxAndTypesWithTheLine)
{
    EXPECT_SITE_REFUSED("[site\n", "site.toml:");
    EXPECT_SITE_REFUSED("", "site: is missing");
    EXPECT_SITE_REFUSED(with("channel = 15", "channel = \"15\""), "site.toml:4: site.channel: is not a whole number");
    EXPECT_SITE_REFUSED(with("channel = 15", "channel = 27"), "site.toml:4: site.channel: 27 is outside 11..26");
    EXPECT_SITE_REFUSED(with("channel = 15", "chanel = 15"), "site.toml:4: site.chanel: unknown field");
    EXPECT_SITE_REFUSED(with("[radio]", "[radios]"), "radios: unknown field");
    EXPECT_SITE_REFUSED(with("frame_loss = 0.125", "frame_loss = 1.5"), "frame_loss: 1.5 is outside 0..1");
    EXPECT_SITE_REFUSED(with("frame_loss = 0.125", "frame_loss = nan"), "frame_loss");
    EXPECT_SITE_REFUSED(with("position_m = [1, 2.5, 3]", "position_m = [1, 2.5]"),
                        "node 2: position_m: is not a list of 3");
    EXPECT_SITE_REFUSED(with("position_m = [1, 2.5, 3]", "position_m = [1, 2.5, inf]"),
                        "node 2: position_m: element 3");
    EXPECT_SITE_REFUSED(with("focal_px = 150.5\n", ""), "pair 'porch': focal_px: is missing");
    EXPECT_SITE_REFUSED(with("similarity_px2 = 1", "similarity_px2 = 100"), "similarity_px2");
    EXPECT_SITE_REFUSED(std::string(5000, '['), "site.toml:");
    EXPECT_SITE_REFUSED("node = 3\n" + kGood, "site.toml:");
}

TEST(HostSite, RefusesRadiosThatCannotBe)
{
    EXPECT_SITE_REFUSED(with("shadowing_db = 6.5", "shadowing_db = -1"),
                        "site.toml:9: radio.shadowing_db: -1 is outside 0..20");
    EXPECT_SITE_REFUSED(with("fading_db = 2", "fading_db = 21"), "site.toml:10: radio.fading_db: 21 is outside");
    EXPECT_SITE_REFUSED(with("fading_period_ms = 250", "fading_period_ms = 0"), "fading_period_ms: 0 is outside");
    EXPECT_SITE_REFUSED(with("capture_db = 4", "capture_db = nan"), "capture_db");
    EXPECT_SITE_REFUSED(with("capture_db = 4", "cca_threshold_dbm = -97.5"),
                        "site.toml:13: radio.cca_threshold_dbm: -97.5 is outside -97..10");
    Site site = small_site();
    site.radio.cca_threshold_dbm = site.radio.sensitivity_dbm - 1;
    EXPECT_THROW(check_site(site), InputError);
}

TEST(HostSite, RefusesBatteriesThatCannotBe)
{
    EXPECT_SITE_REFUSED(with("capacity_mah = 3500", "capacity_mah = 0"),
                        "site.toml:20: battery.capacity_mah: 0 is outside 1..");
    EXPECT_SITE_REFUSED(with("capacity_mah = 3500", "capacity_mah = \"big\""),
                        "site.toml:20: battery.capacity_mah: is not");
    EXPECT_SITE_REFUSED(with("voltage_v = 3", "voltage_v = -3"), "site.toml:21: battery.voltage_v: -3 is outside");
    EXPECT_SITE_REFUSED(with("voltage_v = 3", "voltage_v = nan"), "site.toml:21: battery.voltage_v: ");
    EXPECT_SITE_REFUSED(with("voltage_v = 3", "usable_percent = 101"), "battery.usable_percent: 101 is outside 1..100");
    EXPECT_SITE_REFUSED(with("voltage_v = 3", "converter_efficiency_percent = 0"),
                        "converter_efficiency_percent: 0 is");
    EXPECT_SITE_REFUSED(with("voltage_v = 3", "converter_quiescent_ua = -1"), "converter_quiescent_ua: -1 is outside");
    EXPECT_SITE_REFUSED(with("voltage_v = 3", "cells = 2"), "site.toml:21: battery.cells: unknown field");
    Site site = small_site();
    site.battery.self_discharge_percent_year = 101;
    EXPECT_EQ(test::refusal([&] { check_site(site); }), "site: battery.self_discharge_percent_year: is outside 0..100");
}

TEST(HostSite, RefusesRectanglesThatCannotBeWatched)
{
    const std::string good = "watch = [[0, 8, 32, 16], [159, 119, 1, 1]]";
    const std::string at = "node 3: watch: ";
    EXPECT_SITE_REFUSED(with(good, "watch = 7"), at + "is not a list of lists");
    EXPECT_SITE_REFUSED(with(good, "watch = [0, 8, 32, 16]"), at + "is not a list of lists");
    EXPECT_SITE_REFUSED(with(good, "watch = [[0, 8, 32]]"), at + "element 1 is not a list of 4 whole numbers");
    EXPECT_SITE_REFUSED(with(good, "watch = [[0, 8, 32, 16], [0, 8, 32, 1.5]]"),
                        at + "element 2: number 4 is not a whole number in 0..640");
    EXPECT_SITE_REFUSED(with(good, "watch = [[-1, 8, 32, 16]]"), at + "element 1: number 1 is not");
    EXPECT_SITE_REFUSED(with(good, "watch = [[129, 8, 32, 16]]"),
                        at + "[129, 8, 32, 16] is not a rectangle x, y, width, height inside the pair's 160x120");
    EXPECT_SITE_REFUSED(with(good, "watch = [[0, 105, 32, 16]]"), at + "[0, 105, 32, 16] is not");
    EXPECT_SITE_REFUSED(with(good, "watch = [[0, 8, 0, 16]]"), at + "[0, 8, 0, 16] is not");
    EXPECT_SITE_REFUSED(with(good, "watch = [[0, 8, 32, 0]]"), at + "[0, 8, 32, 0] is not");
    EXPECT_SITE_REFUSED(with(good, "watch = [[0,0,1,1],[0,0,1,1],[0,0,1,1],[0,0,1,1],[0,0,1,1]]"),
                        at + "5 rectangles, not at most 4");
    EXPECT_SITE_REFUSED(with("role = \"relay\"", "role = \"relay\"\nwatch = [[0, 0, 1, 1]]"),
                        "node 2: watch: a relay does not watch");
}

TEST(HostSite, RefusesTreesThatCannotWork)
{
    EXPECT_SITE_REFUSED(with("id = 4\n", "id = 3\n"), "node 3: id: is used twice");
    EXPECT_SITE_REFUSED(with("id = 4\n", "id = 0\n"), "id: 0 is outside 1..65533");
    EXPECT_SITE_REFUSED(with("id = 4\n", "id = 0xfffe\n"), "id: 65534 is outside");
    EXPECT_SITE_REFUSED(with("role = \"relay\"", "role = \"rely\""), "site.toml:31: node 2: role: 'rely' is not");
    EXPECT_SITE_REFUSED(with("role = \"relay\"", "role = \"gateway\""), "there is exactly one");
    EXPECT_SITE_REFUSED(with("role = \"gateway\"", "role = \"relay\""), "no node has role = \"gateway\"");
    EXPECT_SITE_REFUSED(with("parent = 1", "parent = 9"), "node 2: parent: there is no node 9");
    EXPECT_SITE_REFUSED(with("parent = 1\n", ""), "node 2: parent: is missing");
    EXPECT_SITE_REFUSED(with("parent = 1", "parent = 2"), "runs in a circle");
    EXPECT_SITE_REFUSED(with("parent = 1", "parent = 3"), "runs in a circle");
    EXPECT_SITE_REFUSED(with("parent = 1", "parent = 4"), "forwards nothing");
    EXPECT_SITE_REFUSED(with("parent = 3", "parent = 2"), "a wing's parent is its lead, 3");
    EXPECT_SITE_REFUSED(with("role = \"gateway\"", "role = \"gateway\"\nparent = 2"), "root of the tree");
}

TEST(HostSite, RefusesPairsThatDoNotExist)
{
    EXPECT_SITE_REFUSED(with("lead = 3", "lead = 9"), "pair 'porch': lead: there is no node 9");
    EXPECT_SITE_REFUSED(with("wing = 4", "wing = 9"), "pair 'porch': wing: there is no node 9");
    EXPECT_SITE_REFUSED(with("lead = 3", "lead = 2"), "lead: node 2 is a relay");
    EXPECT_SITE_REFUSED(with("wing = 4", "wing = 2"), "wing: node 2 is a relay");
    EXPECT_SITE_REFUSED(with("wing = 4\n", ""), "wing: is missing");
    EXPECT_SITE_REFUSED(kGood.substr(0, kGood.find("[[pair]]")), "a lead that no [[pair]] names");
    EXPECT_SITE_REFUSED(with("start_ms = 250", "start_ms = -1"), "start_ms: -1 is outside 0..86400000");
    EXPECT_SITE_REFUSED(with("frames = \"left160\"", "frames_right = \"x\""), "only a binocular node");
    EXPECT_SITE_REFUSED(with("disparities = 32", "disparities = 33"), "disparities");
    EXPECT_SITE_REFUSED(with("search_start_px = 2", "search_start_px = 200"), "search_start_px: is outside -128..128");
    EXPECT_SITE_REFUSED(with("focal_px = 150.5", "focal_px = 150.5\nd0_px = 2"), "d0_px: is not search_start_px plus");
    EXPECT_SITE_REFUSED(with("focal_px = 150.5", "focal_px = 150.5\nstep_px = 0.3"), "step_px");
    EXPECT_SITE_REFUSED(with(", principal_px = [81.5, 60] }", "}\nd0_px = -40"), "no searched disparity");
    EXPECT_SITE_REFUSED(with("\nprincipal_px = [80, 60]", "\nprincipal_px = [1281, 60]"),
                        "principal_px: is farther than 8 times");
    EXPECT_SITE_REFUSED(with("\nprincipal_px = [80, 60]", "\nprincipal_px = [80, -960.5]"),
                        "principal_px: is farther than 8 times");
    EXPECT_SITE_REFUSED(with("principal_px = [81.5, 60]", "principal_px = [81.5, 1e300]"),
                        "right.principal_px: is farther");
    EXPECT_SITE_REFUSED(with("name = \"attic\"", "name = \"at\\u0000tic\""), "name: holds a NUL");
}

TEST(HostSite, RefusesCamerasThatAreNotRectified)
{
    const std::string right = "position_m = [0.065, 0, 1], ";
    EXPECT_SITE_REFUSED(with(right, "position_m = [0.07, 0, 1], "), "right.position_m: is 70.0 mm from the left");
    EXPECT_SITE_REFUSED(with(right, "position_m = [0, 0, 1.065], "), "the epipole lies in the image");
    EXPECT_SITE_REFUSED(with(right, "position_m = [-0.065, 0, 1], "), "180.0 degrees off");
    EXPECT_SITE_REFUSED(with(right, "position_m = [0.0649, 0.0034, 1], "), "baseline is 3.0 degrees off");
    /* Turned by 12.3 degrees about y. */
    EXPECT_SITE_REFUSED(with(right, right + "rotation = [0.97705, 0, 0.21303, 0, 1, 0, -0.21303, 0, 0.97705], "),
                        "turned by 12.3 degrees against each other: not rectified");
    EXPECT_SITE_REFUSED(with(right, right + "rotation = [1, 0, 0, 0, 1, 0, 0, 0, -1], "), "mirror image");
    EXPECT_SITE_REFUSED(with(right, right + "rotation = [1, 0.1, 0, 0, 1, 0, 0, 0, 1], "), "not orthonormal");
    /* 0.4 degrees pass. */
    EXPECT_EQ(refusal_of(with(right, right + "rotation = [0.999976, 0, 0.006981, 0, 1, 0, -0.006981, 0, 0.999976], ")),
              "");
}

TEST(HostSite, ChecksSitesBuiltInMemory)
{
    Site site = small_site();
    EXPECT_EQ(test::refusal([&] { check_site(site); }), "");
    site.nodes[3].parent = 2;
    EXPECT_EQ(test::refusal([&] { check_site(site); }),
              "site: node 4: parent: is 2, but a wing's parent is its lead, 3");
    site = small_site();
    site.pairs[0].name = "yard";
    EXPECT_REFUSED(check_site(site), "pair 'yard': name: is used twice");
    site = small_site();
    site.pairs[0].focal_px = 0;
    EXPECT_REFUSED(check_site(site), "focal_px");
    site = small_site();
    site.name = "two\nlines";
    EXPECT_REFUSED(check_site(site), "control character");
}

TEST(HostSite, TheDocumentedExampleIsOne)
{
    const char *source = std::getenv("TSR_SOURCE");
    if (source == nullptr) {
        GTEST_SKIP() << "TSR_SOURCE is not set";
    }
    const std::string text = test::read_all(std::filesystem::path(source) / "docs/units.md");
    const std::size_t start = text.find("```toml\n") + 8;
    ASSERT_LT(start, text.size());
    EXPECT_EQ(refusal_of(text.substr(start, text.find("```", start) - start)), "");
}

TEST(HostSite, AnyBytesAreRefusedOrRead)
{
    const Folder folder;
    for (std::size_t i = 0; i < kGood.size(); i += 3) {
        std::string text = kGood;
        text[i] = static_cast<char>(text[i] ^ 0x15);
        const auto file = folder.put("site.toml", text);
        test::refusal([&] { load_site(file); }); /* any other exception fails the test */
    }
}

} // namespace
} // namespace tsr
