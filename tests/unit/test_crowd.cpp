/*
 * Crowds: copies of recorded pairs, what they see, and what is refused.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/emulator/crowd_pictures.h"
#include "tsr/emulator/pair_site.h"
#include "tsr/host/input_error.h"
#include "tsr/scenario/crowd.h"
#include "tsr/scenario/staging.h"

namespace tsr
{
namespace
{

constexpr int kWidth = 32, kHeight = 16;
constexpr std::uint32_t kFrames = 6;

class CrowdTest : public testing::Test
{
  protected:
    CrowdTest()
    {
        record("left", 0);
        record("right", 100);
        Site site = make_pair_site({folder_ / "left", folder_ / "right", 100, 50, 0, 16, 1});
        site.nodes[1].watch_period_ms = 500;
        add_two_boards(site);
        write_site(folder_ / "site.toml", site);
    }
    /* Frame i is gray i + first. */
    void record(const char *name, std::uint32_t first, int height = kHeight)
    {
        std::filesystem::create_directories(folder_ / name);
        for (std::uint32_t i = 0; i < kFrames; ++i) {
            std::ofstream file(folder_ / name / (std::to_string(i) + ".pgm"));
            file << "P5 " << kWidth << ' ' << height << " 255\n"
                 << std::string(static_cast<std::size_t>(kWidth * height), static_cast<char>(i + first));
        }
    }
    /* The same pictures once more, on a lead and a wing. */
    static void add_two_boards(Site &site)
    {
        SiteNode lead = site.nodes[1], wing = lead;
        lead.id = 3;
        lead.name = "lead";
        lead.role = Role::lead;
        wing.id = 4;
        wing.name = "wing";
        wing.role = Role::wing;
        wing.parent = 3;
        wing.frames = lead.frames_right;
        lead.frames_right.clear();
        wing.frames_right.clear();
        wing.position_m[0] += 0.05;
        SitePair pair = site.pairs[0];
        pair.name = "two boards";
        pair.lead = 3;
        pair.wing = 4;
        site.nodes.push_back(lead);
        site.nodes.push_back(wing);
        site.pairs.push_back(pair);
    }
    Scenario load(const std::string &recorded, const std::string &pairs, const std::vector<std::string> &settings = {})
    {
        std::ofstream(folder_ / "crowd.toml") << "name = \"c\"\nduration_s = 20\n[recorded]\nsite = \"site.toml\"\n"
                                              << recorded << "[pairs]\n"
                                              << pairs;
        return load_scenario(folder_ / "crowd.toml", settings);
    }
    std::string refusal(const std::string &recorded, const std::string &pairs)
    {
        try {
            const Scenario scenario = load(recorded, pairs);
            const Crowd crowd = stage_crowd(scenario);
            CrowdPictures(crowd, scenario.scene.duration_s);
        } catch (const InputError &error) {
            return error.what();
        }
        return "";
    }
    /* What a camera sees at a time. */
    static int gray(Pictures &pictures, const SiteNode &node, bool right, std::uint64_t time_ms)
    {
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(kWidth * kHeight));
        pictures.source(node, right)->show(time_ms * 1000, {pixels.data(), kWidth, kHeight, kWidth});
        EXPECT_EQ(std::count(pixels.begin(), pixels.end(), pixels[0]), static_cast<std::ptrdiff_t>(pixels.size()));
        return pixels[0];
    }

    const test::Folder folder_;
};

/* Those of the recorded site and those of the scenario, under the names that the copies have. */
TEST_F(CrowdTest, ZonesAreTheCopies)
{
    Site recorded = load_site(folder_ / "site.toml");
    recorded.pairs[0].zones = {SiteZone{"there", recorded.pairs[0].name, {0, 0, 4, 4}, ZoneKind::changed, 0.1}};
    write_site(folder_ / "site.toml", recorded);
    std::ofstream(folder_ / "crowd.toml")
        << "name = \"c\"\nduration_s = 20\n[recorded]\nsite = \"site.toml\"\n[pairs]\ncount = 3\n"
        << "[[zone]]\nname = \"here\"\nrectangle = [0, 0, 4, 4]\nchanged_by_m = 0.1\n";
    const Crowd crowd = stage_crowd(load_scenario(folder_ / "crowd.toml", {}));
    write_site(folder_ / "again.toml", crowd.site);
    const Site again = load_site(folder_ / "again.toml");
    ASSERT_EQ(again.pairs.size(), 3u);
    for (std::size_t i = 0; i < again.pairs.size(); ++i) {
        const bool copied = crowd.pairs[i].original == 0;
        ASSERT_EQ(again.pairs[i].zones.size(), copied ? 2u : 1u);
        EXPECT_EQ(again.pairs[i].zones.front().name, copied ? "there" : "here");
        EXPECT_EQ(again.pairs[i].zones.back().name, "here");
    }
}

TEST_F(CrowdTest, CopiesThePairsInTurn)
{
    const Crowd crowd = stage_crowd(load("spacing_m = 10\n", "count = 9\nreference_image = false\n"));
    EXPECT_EQ(crowd.site.pairs.size(), 9u);
    EXPECT_EQ(crowd.site.nodes.size(), 5u + 2 * 4 + 1);
    std::map<std::uint16_t, int> children;
    for (std::size_t i = 0; i < 9; ++i) {
        const SitePair &pair = crowd.site.pairs[i];
        const SiteNode &lead = *crowd.site.node(pair.lead);
        EXPECT_EQ(crowd.pairs[i].original, i % 2);
        EXPECT_EQ(pair.wing == kNodeNone, i % 2 == 0);
        EXPECT_EQ(pair.focal_px, 100);
        EXPECT_FALSE(pair.reference_image);
        EXPECT_EQ(lead.watch_period_ms, 500u);
        EXPECT_TRUE(lead.frames.empty());
        EXPECT_EQ(lead.position_m[0], 10 * static_cast<double>(i % 3));
        EXPECT_EQ(lead.position_m[1], 10 * static_cast<double>(i / 3));
        ++children[lead.parent];
        if (pair.wing != kNodeNone) {
            EXPECT_EQ(crowd.site.node(pair.wing)->parent, pair.lead);
            EXPECT_NEAR(crowd.site.node(pair.wing)->position_m[0] - lead.position_m[0], 0.05, 1e-9);
        }
    }
    for (const auto &[parent, count] : children) {
        EXPECT_LE(count, 2) << parent;
    }
    EXPECT_NEAR(crowd.site.gateway().position_m[0], 10, 0.05); /* the middle, and a wing stands beside its lead */
}

TEST_F(CrowdTest, StandsAnywhereInItsArea)
{
    const Crowd crowd = stage_crowd(load("area_m = [50, 20]\n", "count = 30\n"));
    std::set<std::array<double, 3>> places;
    for (const SitePair &pair : crowd.site.pairs) {
        const auto &place = crowd.site.node(pair.lead)->position_m;
        EXPECT_TRUE(place[0] >= 0 && place[0] <= 50 && place[1] >= 0 && place[1] <= 20);
        places.insert(place);
    }
    EXPECT_EQ(places.size(), 30u);
}

TEST_F(CrowdTest, OffsetsAndStartsComeFromTheSeed)
{
    const std::string recorded = "offset_s = [1, 2]\n", pairs = "count = 40\nstart_within_s = 10\n";
    const Crowd crowd = stage_crowd(load(recorded, pairs));
    const Crowd again = stage_crowd(load(recorded, pairs));
    const Crowd other = stage_crowd(load(recorded, pairs, {"seed=2"}));
    std::set<std::uint64_t> offsets;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < 40; ++i) {
        const std::uint64_t offset_ms = crowd.pairs[i].offset_ms;
        EXPECT_TRUE(offset_ms >= 1000 && offset_ms <= 2000) << offset_ms;
        EXPECT_EQ(offset_ms, again.pairs[i].offset_ms);
        differ += offset_ms != other.pairs[i].offset_ms ? 1u : 0u;
        offsets.insert(offset_ms);
        const SiteNode &lead = *crowd.site.node(crowd.site.pairs[i].lead);
        EXPECT_LE(lead.start_ms, 10'000u);
        EXPECT_GE(lead.start_ms, crowd.site.node(lead.parent)->start_ms) << "before its parent";
    }
    EXPECT_GT(offsets.size(), 30u);
    EXPECT_GT(differ, 30u);
}

TEST_F(CrowdTest, EachPlaysInRoundsFromItsOffset)
{
    const Scenario scenario = load("offset_s = [1, 1]\npause_s = 2\n", "count = 2\n");
    const Crowd crowd = stage_crowd(scenario);
    CrowdPictures pictures(crowd, scenario.scene.duration_s);
    EXPECT_EQ(pictures.end_us(), 20'000'000u);
    const SiteNode &both = crowd.site.nodes[0], &lead = crowd.site.nodes[1], &wing = crowd.site.nodes[2];
    EXPECT_EQ(gray(pictures, both, false, 0), 2); /* frames of 500 ms, entered at 1 s */
    EXPECT_EQ(gray(pictures, both, true, 0), 102);
    EXPECT_EQ(gray(pictures, lead, false, 499), 2);
    EXPECT_EQ(gray(pictures, wing, false, 500), 103);
    EXPECT_EQ(gray(pictures, lead, false, 1999), 5);
    /* The pause: the first two in turn, then the next round. */
    for (const auto &[time_ms, seen] :
         {std::pair{2000u, 0}, {2500u, 1}, {3000u, 0}, {3500u, 1}, {4000u, 0}, {5000u, 2}}) {
        EXPECT_EQ(gray(pictures, lead, false, time_ms), seen) << time_ms;
    }
    EXPECT_EQ(pictures.source(lead, true), nullptr);
    EXPECT_EQ(pictures.source(crowd.site.gateway(), false), nullptr);
}

TEST_F(CrowdTest, RefusesByLineAndField)
{
    const auto contains = [](const std::string &text, const std::string &part) {
        return text.find(part) != std::string::npos ? std::string() : text;
    };
    const std::string two = "count = 2\n";
    EXPECT_EQ(refusal("", two), "");
    EXPECT_EQ(contains(refusal("", "count = 0\n"), "crowd.toml:6: pairs.count: 0 is outside 1..10000"), "");
    EXPECT_EQ(contains(refusal("", ""), "pairs.count: is missing"), "");
    EXPECT_EQ(contains(refusal("", two + "baseline_mm = 60\n"), "crowd.toml:7: pairs.baseline_mm: unknown field"), "");
    EXPECT_EQ(contains(refusal("", two + "start_within_s = 21\n"), "crowd.toml:7: pairs.start_within_s: is after"), "");
    EXPECT_EQ(contains(refusal("offset_s = [-1, 2]\n", two), "crowd.toml:5: recorded.offset_s: is not two numbers"),
              "");
    EXPECT_EQ(contains(refusal("offset_s = [3, 2]\n", two), "crowd.toml:5: recorded.offset_s: ends before"), "");
    EXPECT_EQ(contains(refusal("pause_s = -1\n", two), "crowd.toml:5: recorded.pause_s: -1 is outside"), "");
    EXPECT_EQ(contains(refusal("spacing_m = 5\narea_m = [9, 9]\n", two), "recorded.area_m: stands beside"), "");
    EXPECT_EQ(contains(refusal("area_m = [9, 0]\n", two), "recorded.area_m: is not two numbers of 0.1"), "");
    EXPECT_EQ(contains(refusal("[scene]\nkind = \"tank\"\n", two), "scene: stands beside recorded"), "");
    std::filesystem::rename(folder_ / "right", folder_ / "gone");
    EXPECT_EQ(contains(refusal("", two), "right: "), "");
    record("right", 0, kHeight + 1);
    EXPECT_EQ(contains(refusal("", two), "frames are 32x17, pair 'pair' says 32x16"), "");
    std::filesystem::remove(folder_ / "site.toml");
    EXPECT_EQ(contains(refusal("", two), "recorded.site: there is no "), "");
}

TEST_F(CrowdTest, RefusesSitesWithoutPicturesAndScenesWithoutOne)
{
    Site site = load_site(folder_ / "site.toml");
    site.nodes[3].frames.clear();
    write_site(folder_ / "site.toml", site);
    EXPECT_NE(refusal("", "count = 2\n").find("node 4: frames: is missing"), std::string::npos);
    EXPECT_THROW(stage_scenario(load("", "count = 2\n")), InputError); /* there is nothing to render */
}

} // namespace
} // namespace tsr
