/*
 * Scenario files: what they say, what is refused, how nodes are joined.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/host/input_error.h"
#include "tsr/scenario/effective.h"
#include "tsr/scenario/staging.h"
#include "tsr/scenario/zone_truth.h"

namespace
{

using tsr::Role;
using tsr::Scenario;

class ScenarioFile : public testing::Test
{
  protected:
    std::filesystem::path write(const std::string &text)
    {
        const auto file = folder_.path() / "scenario.toml";
        std::ofstream(file) << text;
        return file;
    }
    std::string refusal(const std::string &text, const std::vector<std::string> &settings = {})
    {
        try {
            tsr::stage_scenario(tsr::load_scenario(write(text), settings));
        } catch (const tsr::InputError &error) {
            const std::string what = error.what();
            return what.substr(what.find("scenario.toml"));
        }
        return "";
    }

    tsr::test::Folder folder_;
};

constexpr const char *kTank = "name = \"t\"\nduration_s = 20\n[scene]\nkind = \"tank\"\n";

TEST_F(ScenarioFile, IsWrittenWithItsSettings)
{
    const std::vector<std::string> settings = {"scene.level_step_m=0.3", "seed=9", "pairs.heights_m=[1.1, 2]"};
    const std::string text = tsr::EffectiveScenario(write(kTank), settings).text_for(folder_.path());
    for (const char *line : {"seed = 9\n", "level_step_m = 0.3\n", "duration_s = 20\n", "heights_m = [ 1.1, 2 ]\n"}) {
        EXPECT_NE(text.find(line), std::string::npos) << line << " in " << text;
    }
    const Scenario again = tsr::load_scenario(write(text), {});
    EXPECT_EQ(again.scene.level_step_m, 0.3);
    EXPECT_EQ(again.seed, 9u);
    EXPECT_EQ(tsr::EffectiveScenario(write(text), {}).text_for(folder_.path()), text);
}

TEST_F(ScenarioFile, FindsItsRecordingFromAnotherFolder)
{
    const std::string crowd = "name = 'c'\n[pairs]\ncount = 2\n[recorded]\npause_s = 0.1\nsite = ";
    const auto out = folder_.path() / "out/run";
    std::filesystem::create_directories(out);
    const auto text = [&](const std::string &site) {
        return tsr::EffectiveScenario(write(crowd + site), {}).text_for(out);
    };
    EXPECT_NE(text("'frames/site.toml'").find("site = '../../frames/site.toml'"), std::string::npos);
    EXPECT_NE(text("'../site.toml'").find("site = '../../../site.toml'"), std::string::npos);
    EXPECT_NE(text("'/frames/site.toml'").find("site = '/frames/site.toml'"), std::string::npos);
    EXPECT_NE(text("'0.29999999999999999'").find("0.29999999999999999'"), std::string::npos) << "a name, no number";
}

TEST(Settings, AreToldWithoutFolders)
{
    EXPECT_EQ(tsr::without_folders("recorded.site='/a/b/site.toml'"), "recorded.site = 'site.toml'");
    EXPECT_EQ(tsr::without_folders("recorded.site = '/a//x.toml'"), "recorded.site = 'x.toml'");
    EXPECT_EQ(tsr::without_folders("recorded.site = '/x.toml'"), "recorded.site = 'x.toml'");
    EXPECT_EQ(tsr::without_folders("recorded.site = \"/\\u0061/x.toml\""), "recorded.site = 'x.toml'");
    EXPECT_EQ(tsr::without_folders("recorded.site='b/site.toml'"), "recorded.site='b/site.toml'");
    EXPECT_EQ(tsr::without_folders("pairs.count = 3"), "pairs.count = 3");
}

/* f B = 4 px m; the depth at 2 px is 2 m, at 4 px 1 m. */
TEST(ZoneTruth, IsOfThePixelsThatCount)
{
    tsr::SitePair pair;
    pair.focal_px = 40;
    pair.baseline_mm = 100;
    pair.width = 4;
    pair.height = 2;
    const tsr::FloatImage truth{4, 2, {2, 2, 4, 9, 2.5F, tsr::kFloatInvalid, 4, 9}};
    tsr::SiteZone zone{"z", "", {0, 0, 3, 2}, tsr::ZoneKind::below, 1.5};
    EXPECT_NEAR(tsr::zone_truth(pair, zone, truth).share, 2 / 6.0, 1e-9);
    EXPECT_NEAR(tsr::zone_truth(pair, zone, truth).depth_m.value(), 1, 1e-9);
    zone.kind = tsr::ZoneKind::changed; /* the lower median is 2 px: those of 1 .. 3 px */
    EXPECT_NEAR(tsr::zone_truth(pair, zone, truth).share, 3 / 6.0, 1e-9);
    EXPECT_NEAR(tsr::zone_truth(pair, zone, truth).depth_m.value(), 4 / (6.5 / 3), 1e-6);
    zone.kind = tsr::ZoneKind::below;
    zone.depth_m = 0.1;
    EXPECT_EQ(tsr::zone_truth(pair, zone, truth).share, 0);
    EXPECT_FALSE(tsr::zone_truth(pair, zone, truth).depth_m);
}

TEST_F(ScenarioFile, HasDefaultsAndTakesSettings)
{
    const Scenario plain = tsr::load_scenario(write(kTank), {});
    EXPECT_EQ(plain.pairs.layout.count, 7);
    EXPECT_EQ(plain.scene.duration_s, 20);
    const Scenario set = tsr::load_scenario(write(kTank), {"pairs.count=3", "scene.level_step_m = 0.5", "seed=9"});
    EXPECT_EQ(set.pairs.layout.count, 3);
    EXPECT_EQ(set.scene.level_step_m, 0.5);
    EXPECT_EQ(set.seed, 9u);
    const auto staging = tsr::stage_scenario(tsr::load_scenario(write(kTank), {"battery.capacity_mah=1500"}));
    EXPECT_EQ(staging.site.battery.capacity_mah, 1500);
    EXPECT_TRUE(tsr::is_scenario_file(write(kTank)));
    EXPECT_FALSE(tsr::is_scenario_file(write("[site]\nname = \"s\"\n")));
}

TEST_F(ScenarioFile, AZoneWithoutAPairIsEveryPairs)
{
    const std::string zone = "[[zone]]\nname = \"level\"\nrectangle = [40, 40, 20, 20]\nchanged_by_m = 0.1\n";
    const auto staging = tsr::stage_scenario(tsr::load_scenario(write(kTank + zone), {}));
    for (const tsr::SitePair &pair : staging.site.pairs) {
        ASSERT_EQ(pair.zones.size(), 1u);
        EXPECT_EQ(pair.zones[0].name, "level");
    }
    const auto one = tsr::stage_scenario(tsr::load_scenario(write(kTank + zone + "pair = \"pair 2\"\n"), {}));
    EXPECT_TRUE(one.site.pairs[0].zones.empty());
    EXPECT_EQ(one.site.pairs[1].zones.size(), 1u);
    EXPECT_EQ(refusal(kTank + zone + "pair = \"attic\"\n"),
              "scenario.toml:5: zone 'level': pair: there is no pair 'attic'");
}

TEST_F(ScenarioFile, RefusesByLineAndField)
{
    EXPECT_EQ(refusal("name = \"t\"\n"), "scenario.toml:1: scene: is missing, and so is recorded");
    EXPECT_EQ(refusal("name = \"t\"\n[scene]\nkind = \"moon\"\n").substr(0, 48),
              "scenario.toml:3: scene.kind: 'moon' is none of b");
    EXPECT_EQ(refusal(std::string(kTank) + "lids = 3\n"), "scenario.toml:5: scene.lids: unknown field");
    EXPECT_EQ(refusal(std::string(kTank) + "[battery]\nvoltage_v = 0\n").substr(0, 51),
              "scenario.toml:6: battery.voltage_v: 0 is outside 0.");
    EXPECT_EQ(refusal(std::string(kTank) + "people = 3\n"), "scenario.toml:5: scene.people: unknown field");
    EXPECT_EQ(refusal("name = \"t\"\nduration_s = -1\n[scene]\nkind = \"tank\"\n").substr(0, 29),
              "scenario.toml:2: duration_s: ");
    EXPECT_EQ(refusal(std::string(kTank) + "[pairs]\nangle_deg = -5\n"),
              "scenario.toml:6: pairs.angle_deg: -5 is outside 0..89.9");
}

TEST_F(ScenarioFile, ASettingIsNamedInItsRefusal)
{
    try {
        tsr::load_scenario(write(kTank), {"pairs.count=0"});
        FAIL();
    } catch (const tsr::InputError &error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 34), "--set 'pairs.count=0': pairs.count");
    }
    for (const char *nothing : {"", "  ", "# seed = 3"}) {
        EXPECT_REFUSED(tsr::load_scenario(write(kTank), {nothing}),
                       "--set '" + std::string(nothing) + "': is not TABLE.FIELD=VALUE");
    }
}

TEST_F(ScenarioFile, RefusesImpossibleGeometry)
{
    EXPECT_NE(refusal(std::string(kTank) + "[pairs]\ncount = 4\ndistance_m = 1.25\nheights_m = [0.8, 0.8]\n")
                  .find("is inside the"),
              std::string::npos);
    EXPECT_NE(refusal(std::string(kTank) + "[pairs]\nangle_deg = 70\n").find("share less than a fifth"),
              std::string::npos);
    EXPECT_NE(refusal(std::string(kTank) + "[camera]\ndistortion = [-3, 0, 0, 0]\n").find("the image folds"),
              std::string::npos);
}

TEST_F(ScenarioFile, JoinsABinaryTree)
{
    for (const char *boards : {"one", "two"}) {
        const auto staging = tsr::stage_scenario(
            tsr::load_scenario(write(kTank), {"pairs.count=15", std::string("pairs.boards=\"") + boards + "\""}));
        std::map<std::uint16_t, int> children;
        for (const tsr::SiteNode &node : staging.site.nodes) {
            if (node.role == Role::wing) {
                EXPECT_EQ(node.parent, node.id - 1);
            } else if (node.role != Role::gateway) {
                ++children[node.parent];
            }
        }
        for (const auto &[parent, count] : children) {
            EXPECT_LE(count, 2) << parent;
        }
        EXPECT_EQ(staging.site.pairs.size(), 15u);
        EXPECT_EQ(staging.cameras.size(), 30u);
        EXPECT_EQ(staging.site.nodes.size(), std::string(boards) == "one" ? 16u : 31u);
    }
}

/* The axes meet: a point where they do has disparity 0 after d0 is added. */
TEST_F(ScenarioFile, TheAngleBecomesAnOffset)
{
    const auto staging = tsr::stage_scenario(tsr::load_scenario(write(kTank), {"pairs.angle_deg=2.0"}));
    const tsr::SitePair &pair = staging.site.pairs.front();
    const double meet_m = pair.baseline_mm / 1000 / std::tan(2.0 * 3.14159265358979 / 180);
    EXPECT_NEAR(pair.focal_px * pair.baseline_mm / 1000 / meet_m - pair.d0_px, 0, 1e-6);
}

} // namespace
