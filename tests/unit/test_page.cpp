/*
 * index.html: what a run leaves of it does not grow with the run.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "memory_run.h"
#include "test_host_folder.h"
#include "tsr/emulator/report.h"
#include "tsr/host/image_file.h"
#include "tsr/host/ply.h"
#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

constexpr std::size_t kPageBytesMax = 5'000'000;

class Page : public ::testing::Test
{
  protected:
    Page() : run_(test::short_site())
    {
        run_.run();
        record_ = gather(run_.site, run_.simulation, run_.pictures, {}, {});
        PlyWriter(folder_.path() / "cloud.ply", 0).complete();
        std::filesystem::create_directory(folder_.path() / "maps");
    }
    nlohmann::json written()
    {
        write_page(folder_.path(), make_summary(record_), record_, gallery_);
        const std::string text = read_text_file(folder_.path() / "index.html");
        EXPECT_LT(text.size(), kPageBytesMax);
        constexpr std::string_view kBegin = "<script id=\"data\" type=\"application/json\">";
        const std::size_t begin = text.find(kBegin) + kBegin.size();
        return nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
    }

    test::Folder folder_;
    test::MemoryRun run_;
    RunRecord record_;
    std::vector<GalleryMap> gallery_;
};

/* Noise, which PNG cannot shorten. */
void write_noise(const std::filesystem::path &file)
{
    RgbImage image{200, 150, {}};
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < 3u * 200 * 150; ++i) {
        state = state * 1664525 + 1013904223;
        image.pixels.push_back(static_cast<std::uint8_t>(state >> 24));
    }
    write_png(file, image);
}

TEST_F(Page, OfAShortRunHasEverything)
{
    const auto data = written();
    EXPECT_EQ(data.at("nodes").at("rows").size(), record_.nodes.size());
    EXPECT_EQ(data.at("links").at("rows").size(), record_.links.size());
    EXPECT_EQ(data.at("episodes").at("rows").size(), record_.episodes.size());
    EXPECT_FALSE(data.at("phases").empty());
    EXPECT_EQ(data.at("cloud").at("count"), 0);
}

TEST_F(Page, StaysSmallWhateverWasRun)
{
    /* Twice as many as the page takes: half of them are left, as many as can be. */
    const auto repeat = [](auto &records, std::size_t count) {
        const std::size_t own = records.size();
        for (std::size_t i = own; i < count; ++i) {
            records.push_back(records[i % own]);
        }
    };
    repeat(record_.nodes, 4'000);
    repeat(record_.links, 8'000);
    repeat(record_.episodes, 10'000);
    for (std::uint32_t i = 0; i < 6'000; ++i) {
        ReceivedMap map;
        map.node = test::kLead;
        map.counter = i;
        map.capture_time_us = 1'000'000ULL * i + 123'456;
        map.commit_time_us = map.capture_time_us + 765'432;
        map.map_bytes = 1234;
        map.reference_bytes = 2345;
        map.file = "maps/00003-" + std::to_string(1'000'000'000 + i);
        map.error = MapError{19'200, 12'345, 0.1234, 0.1234, 0.1234, 1.2345, 1.2345, 1234.56, 12.345};
        record_.maps.push_back(map);
        record_.events.push_back({map.capture_time_us, "somebody comes by"});
        record_.zone_events.push_back(
            {map.node, i, map.capture_time_us, map.commit_time_us, "level", "measured", 98.76, 2.3456, 2.3457});
    }
    std::vector<CloudPoint> cloud(160'000);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        cloud[i] = {static_cast<float>(i % 1000), static_cast<float>(i / 1000), 1.5F};
    }
    PlyWriter writer(folder_.path() / "cloud.ply", cloud.size());
    writer.add(cloud);
    writer.complete();
    write_noise(folder_.path() / "noise.png");
    for (std::size_t i = 0; i < kGalleryMax; ++i) {
        gallery_.push_back({&record_.maps[i], &run_.site.pairs[0], "newest"});
        for (const char *kind : {"", "-reference", "-truth", "-error"}) {
            std::filesystem::copy_file(folder_.path() / "noise.png",
                                       folder_.path() / (record_.maps[i].file + kind + ".png"));
        }
    }
    const auto data = written();
    EXPECT_EQ(data.at("nodes").at("of"), 4'000);
    EXPECT_EQ(data.at("maps").at("of"), 6'000);
    EXPECT_GT(data.at("maps").at("rows").size(), 2'000u);
    EXPECT_EQ(data.at("zone_events").at("of"), 6'000);
    EXPECT_EQ(data.at("zone_events").at("rows").size(), 3'000u);
    ASSERT_EQ(data.at("zone_events").at("newest").size(), 300u);
    EXPECT_EQ(data.at("zone_events").at("newest").back(),
              nlohmann::json::array({5999.123456, test::kLead, "level", "measured", 2.3456, 98.76, 0.765432, 2.3457}));
    EXPECT_EQ(data.at("cloud").at("of"), cloud.size());
    EXPECT_GT(data.at("cloud").at("count"), 50'000u);
    EXPECT_EQ(data.at("gallery").size(), 3u) << "not all pictures fit";
    EXPECT_EQ(data.at("gallery_of"), kGalleryMax) << "and the page knows it";
    EXPECT_LE(data.at("timeline").at("looks").size(), 240u);
}

} // namespace
} // namespace tsr
