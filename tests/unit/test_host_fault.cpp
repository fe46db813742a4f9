/* [[fault]] tables: what is read, what is refused and with which words. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "tsr/host/input_error.h"
#include "tsr/host/site.h"
#include "tsr/scenario/staging.h"

namespace tsr
{
namespace
{

using test::Folder;
using test::small_site;

/* The small site with these tables behind it. */
std::filesystem::path site_with(const Folder &folder, const std::string &tables)
{
    write_site(folder / "site.toml", small_site());
    return folder.put("site.toml", test::read_all(folder / "site.toml") + tables);
}

Site read(const std::string &tables)
{
    const Folder folder;
    return load_site(site_with(folder, tables));
}

/* "L:" stands for the line of the last [[fault]]. */
std::string refusal_of(const std::string &tables)
{
    const Folder folder;
    const auto file = site_with(folder, tables);
    const std::string text = test::read_all(file), what = test::refusal([&] { load_site(file); });
    EXPECT_EQ(what.find('\n'), std::string::npos);
    const std::size_t place = what.find("site.toml:");
    return place == std::string::npos ? what : what.substr(what.find(": ", place) + 2);
}

std::string fault(const std::string &fields)
{
    std::string text = "[[fault]]\nat_s = 10\n";
    return text + fields + "\n";
}

TEST(HostFault, ReadsEveryKind)
{
    const Site site = read(
        fault("kind = \"death\"\nnode = 2") + fault("kind = \"reboot\"\nnode = 3\ncounter_start = 4000000000") +
        fault("kind = \"brown-out\"\nnode = 4\nfor_s = 0.5") + fault("kind = \"clock drift\"\nnode = 5\nppm = -40") +
        fault("kind = \"link loss\"\nnode = 3\nother = 4\nloss_db = 12.5\nfor_s = 3") +
        fault("kind = \"camera failure\"\nnode = 4\nfor_s = 2") + fault("kind = \"gateway restart\"") +
        "[[fault]]\nat_s = 0.000001\nkind = \"sink restart\"\n");
    ASSERT_EQ(site.faults.size(), 8u);
    EXPECT_EQ(site.faults[0].kind, SiteFaultKind::death);
    EXPECT_EQ(site.faults[0].node, 2);
    EXPECT_EQ(site.faults[0].at_us, 10'000'000u);
    EXPECT_EQ(site.faults[0].for_us, 0u);
    EXPECT_EQ(site.faults[1].counter_start, 4'000'000'000u);
    EXPECT_EQ(site.faults[2].for_us, 500'000u);
    EXPECT_EQ(site.faults[3].ppm, -40);
    EXPECT_EQ(site.faults[4].other, 4);
    EXPECT_EQ(site.faults[4].loss_db, 12.5);
    EXPECT_EQ(site.faults[5].kind, SiteFaultKind::camera_failure);
    EXPECT_EQ(site.faults[6].kind, SiteFaultKind::gateway_restart);
    EXPECT_EQ(site.faults[6].node, kNodeNone);
    EXPECT_EQ(site.faults[7].at_us, 1u);
    for (const SiteFault &one : site.faults) {
        EXPECT_GT(one.line, 0);
    }
}

TEST(HostFault, ALinkIsCutUnlessTheFileSaysLess)
{
    const Site site =
        read(fault("kind = \"link loss\"\nnode = 3") + fault("kind = \"link loss\"\nnode = 3\nframe_loss = 0.25") +
             fault("kind = \"link loss\"\nnode = 3\nframe_loss = 0.25\nloss_db = 6"));
    EXPECT_EQ(site.faults[0].loss_db, kLinkLossDbMax);
    EXPECT_EQ(site.faults[0].frame_loss, 0.0);
    EXPECT_EQ(site.faults[0].other, kNodeNone);
    EXPECT_EQ(site.faults[1].loss_db, 0.0);
    EXPECT_EQ(site.faults[1].frame_loss, 0.25);
    EXPECT_EQ(site.faults[2].loss_db, 6.0);
}

TEST(HostFault, WritesWhatItReads)
{
    const Folder folder;
    Site site = small_site();
    const auto add = [&](SiteFault one) { site.faults.push_back(one); };
    add({.at_us = 1, .kind = SiteFaultKind::death, .node = 2});
    add({.at_us = 12'345'678, .kind = SiteFaultKind::reboot, .node = 3, .counter_start = 77});
    add({.at_us = kFaultTimeUsMax, .for_us = 1, .kind = SiteFaultKind::brown_out, .node = 4});
    add({.for_us = 333'333, .kind = SiteFaultKind::clock_drift, .node = 5, .ppm = 1000});
    add({.kind = SiteFaultKind::link_loss, .node = 3, .other = 5, .loss_db = 1.0 / 3, .frame_loss = 0.1});
    add({.kind = SiteFaultKind::link_loss, .node = 3, .frame_loss = 1});
    add({.for_us = 5, .kind = SiteFaultKind::camera_failure, .node = 4});
    add({.for_us = 6, .kind = SiteFaultKind::gateway_restart, .counter_start = 8});
    add({.at_us = 9, .kind = SiteFaultKind::sink_restart});
    write_site(folder / "site.toml", site);
    const Site again = load_site(folder / "site.toml");
    ASSERT_EQ(again.faults.size(), site.faults.size());
    for (std::size_t i = 0; i < site.faults.size(); i++) {
        const SiteFault &a = site.faults[i], &b = again.faults[i];
        EXPECT_EQ(a.at_us, b.at_us) << i;
        EXPECT_EQ(a.for_us, b.for_us) << i;
        EXPECT_EQ(a.kind, b.kind) << i;
        EXPECT_EQ(a.node, b.node) << i;
        EXPECT_EQ(a.other, b.other) << i;
        EXPECT_EQ(a.ppm, b.ppm) << i;
        EXPECT_EQ(a.loss_db, b.loss_db) << i;
        EXPECT_EQ(a.frame_loss, b.frame_loss) << i;
        EXPECT_EQ(a.counter_start, b.counter_start) << i;
    }
}

TEST(HostFault, RefusesNumbersAndNames)
{
    EXPECT_EQ(refusal_of("[[fault]]\nat_s = -1\nkind = \"reboot\"\nnode = 2\n"),
              "fault 1: at_s: -1 is outside 0..31536000");
    EXPECT_EQ(refusal_of("[[fault]]\nkind = \"reboot\"\nnode = 2\n"), "fault 1: at_s: is missing");
    EXPECT_EQ(refusal_of("[[fault]]\nat_s = 1\nnode = 2\n"), "fault 1: kind: is missing");
    EXPECT_EQ(refusal_of(fault("kind = \"flood\"\nnode = 2")).substr(0, 46),
              "fault 1: kind: 'flood' is none of death, reboo");
    EXPECT_EQ(refusal_of(fault("kind = \"reboot\"")), "fault 1: node: is missing");
    EXPECT_EQ(refusal_of(fault("kind = \"reboot\"\nnode = 0")), "fault 1: node: 0 is outside 1..65533");
    EXPECT_EQ(refusal_of(fault("kind = \"reboot\"\nnode = 2\ncolour = 3")), "fault 1: colour: unknown field");
    EXPECT_EQ(refusal_of(fault("kind = \"reboot\"\nnode = 2\ncounter_start = -1")).substr(0, 34),
              "fault 1: counter_start: -1 is outs");
    EXPECT_EQ(refusal_of(fault("kind = \"brown-out\"\nnode = 2")), "fault 1: for_s: is missing");
    EXPECT_EQ(refusal_of(fault("kind = \"brown-out\"\nnode = 2\nfor_s = 0")).substr(0, 33),
              "fault 1: for_s: is not above 0; a");
    EXPECT_EQ(refusal_of(fault("kind = \"brown-out\"\nnode = 2\nfor_s = nan")).substr(0, 27),
              "fault 1: for_s: nan is outs");
    EXPECT_EQ(refusal_of(fault("kind = \"camera failure\"\nnode = 3\nfor_s = -2")).substr(0, 26),
              "fault 1: for_s: -2 is outs");
    EXPECT_EQ(refusal_of(fault("kind = \"clock drift\"\nnode = 2")), "fault 1: ppm: is missing");
    EXPECT_EQ(refusal_of(fault("kind = \"clock drift\"\nnode = 2\nppm = 0")), "fault 1: ppm: 0 is no drift");
    EXPECT_EQ(refusal_of(fault("kind = \"clock drift\"\nnode = 2\nppm = 1001")),
              "fault 1: ppm: 1001 is outside -1000..1000");
    EXPECT_EQ(refusal_of(fault("kind = \"link loss\"\nnode = 2\nloss_db = 201")),
              "fault 1: loss_db: 201 is outside 0..200");
    EXPECT_EQ(refusal_of(fault("kind = \"link loss\"\nnode = 2\nloss_db = 0")), "fault 1: loss_db: 0 loses nothing");
    EXPECT_EQ(refusal_of(fault("kind = \"link loss\"\nnode = 2\nframe_loss = 0")),
              "fault 1: frame_loss: 0 loses nothing");
    EXPECT_EQ(refusal_of(fault("kind = \"link loss\"\nnode = 2\nframe_loss = 2")),
              "fault 1: frame_loss: 2 is outside 0..1");
    EXPECT_NE(refusal_of("fault = 3\n").find("unknown field"), std::string::npos); /* inside of the last table */
}

TEST(HostFault, RefusesWhatDoesNotBelongToItsKind)
{
    EXPECT_EQ(refusal_of(fault("kind = \"sink restart\"\nnode = 2")),
              "fault 1: node: does not belong to a sink restart");
    EXPECT_EQ(refusal_of(fault("kind = \"gateway restart\"\nnode = 1")),
              "fault 1: node: does not belong to a gateway restart");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 2\nfor_s = 3")), "fault 1: for_s: does not belong to a death");
    EXPECT_EQ(refusal_of(fault("kind = \"reboot\"\nnode = 2\nfor_s = 3")),
              "fault 1: for_s: does not belong to a reboot");
    EXPECT_EQ(refusal_of(fault("kind = \"reboot\"\nnode = 2\nppm = 3")), "fault 1: ppm: does not belong to a reboot");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 2\nother = 3")), "fault 1: other: does not belong to a death");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 2\nloss_db = 3")),
              "fault 1: loss_db: does not belong to a death");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 2\nframe_loss = 1")),
              "fault 1: frame_loss: does not belong to a death");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 2\ncounter_start = 1")),
              "fault 1: counter_start: does not belong to a death");
}

TEST(HostFault, RefusesNodesThatCannotHaveIt)
{
    const std::string good = fault("kind = \"reboot\"\nnode = 2");
    EXPECT_EQ(refusal_of(good + fault("kind = \"reboot\"\nnode = 9")), "fault 2: node: there is no node 9");
    EXPECT_EQ(refusal_of(fault("kind = \"camera failure\"\nnode = 2")),
              "fault 1: node: node 2 is a relay without a camera");
    EXPECT_EQ(refusal_of(fault("kind = \"camera failure\"\nnode = 1")),
              "fault 1: node: node 1 is a gateway without a camera");
    EXPECT_EQ(refusal_of(fault("kind = \"link loss\"\nnode = 2\nother = 9")), "fault 1: other: there is no node 9");
    EXPECT_EQ(refusal_of(fault("kind = \"link loss\"\nnode = 2\nother = 2")),
              "fault 1: other: node 2 has no link with itself");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 2") + good), "fault 2: at_s: node 2 is dead since fault 1");
    EXPECT_EQ(refusal_of(fault("kind = \"death\"\nnode = 1") + fault("kind = \"gateway restart\"")),
              "fault 2: at_s: node 1 is dead since fault 1");
    EXPECT_EQ(refusal_of(good + fault("kind = \"death\"\nnode = 2")), "");
}

TEST(HostFault, NamesTheLine)
{
    const Folder folder;
    const auto file = site_with(folder, "[[fault]]\nat_s = -1\nkind = \"reboot\"\nnode = 2\n");
    const std::string text = test::read_all(file);
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("at_s")), '\n') + 1;
    EXPECT_NE(test::refusal([&] { load_site(file); }).find("site.toml:" + std::to_string(line) + ": fault 1: at_s"),
              std::string::npos);
}

/* The same reader and the same checks: nodes are numbered by the staging. */
TEST(HostFault, AScenarioHasThemToo)
{
    const Folder folder;
    const auto staged = [&](const std::string &tables) {
        const auto file =
            folder.put("scenario.toml", "name = \"t\"\nduration_s = 20\n[scene]\nkind = \"tank\"\n" + tables);
        return stage_scenario(load_scenario(file, {})).site.faults;
    };
    const auto faults = staged(fault("kind = \"camera failure\"\nnode = 1"));
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].line, 5);
    EXPECT_NE(test::refusal([&] {
                  staged(fault("kind = \"death\"\nnode = 99"));
              }).find("scenario.toml:5: fault 1: node: there is no node 99"),
              std::string::npos);
    EXPECT_NE(test::refusal([&] {
                  staged("[[fault]]\nat_s = -3\nkind = \"death\"\nnode = 1\n");
              }).find("scenario.toml:6: fault 1: at_s: -3 is outside"),
              std::string::npos);
    EXPECT_NE(test::refusal([&] {
                  staged("[[fault]]\nat_s = 20.5\nkind = \"death\"\nnode = 1\n");
              }).find("scenario.toml:5: fault 1: at_s: is after duration_s"),
              std::string::npos);
}

} // namespace
} // namespace tsr
