/*
 * Baseline nodes: what the sink gets is what the cameras saw, once for each
 * change or period, however frames and sinks are lost.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cstdlib>

#include <gtest/gtest.h>

#include "memory_run.h"
#include "test_host_folder.h"
#include "tsr/emulator/jpeg_sink.h"
#include "tsr/host/image_file.h"

namespace tsr
{
namespace
{

using namespace test;

/* Gateway 1, relay 2, binocular 5. */
Site one_pair()
{
    Site site = short_site();
    std::erase_if(site.nodes, [](const SiteNode &node) { return node.id == kLead || node.id == kWing; });
    std::erase_if(site.pairs, [](const SitePair &pair) { return pair.lead == kLead; });
    return site;
}

struct BaselineRun {
    BaselineRun(const Site &of_maps, const Baseline &baseline, std::uint64_t end_us = kSceneEndUs)
        : site(baseline_site(of_maps)), keys(derive_test_keys(7, site)), pictures(site, end_us),
          sink(keys, folder.path()), simulation(site, keys, pictures, sink, baseline)
    {
    }
    /* Restarts the sink after so many events; returns how many there were. */
    std::uint64_t run(std::uint64_t restart_at = UINT64_MAX)
    {
        std::uint64_t events = 0;
        simulation.run([&](std::uint64_t, std::uint64_t) {
            if (events++ == restart_at) {
                sink.restart();
            }
            return true;
        });
        return events;
    }
    const EmulatedNode &binocular() const { return *simulation.nodes().back(); }
    GrayImage picture(const JpegSink::Received &received, const char *side) const
    {
        return read_gray_image(folder / (received.name + "-" + side + ".jpg"));
    }

    Folder folder;
    Site site;
    KeyRing keys;
    TinyPictures pictures;
    JpegSink sink;
    Simulation simulation;
};

/* Mean difference from what the camera saw, gray levels. */
double difference(const GrayImage &image, bool right, unsigned version)
{
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int saw = TinyScene::pixel(right, static_cast<unsigned>(x), static_cast<unsigned>(y), version);
            sum += std::abs(saw - image.pixels[static_cast<std::size_t>(y * image.width + x)]);
        }
    }
    return sum / static_cast<double>(image.pixels.size());
}

void expect_both_views_of_the_change(BaselineRun &run)
{
    const auto &received = run.sink.received();
    ASSERT_EQ(received.size(), 2u);
    EXPECT_LT(received[0].capture_time_us, kSceneChangeUs);
    EXPECT_GE(received[1].capture_time_us, kSceneChangeUs);
    for (const unsigned version : {0u, 1u}) {
        for (const bool right : {false, true}) {
            const GrayImage image = run.picture(received[version], right ? "right" : "left");
            EXPECT_EQ(image.size(), (ImageSize{48, 32}));
            /* Noise in blocks of 2x2 is hard for JPEG. */
            EXPECT_LT(3 * difference(image, right, version), difference(image, right, 1 - version)) << version << right;
        }
    }
    EXPECT_EQ(run.binocular().counters().maps_sent, 2u);
    EXPECT_EQ(run.binocular().counters().maps_lost, 0u);
    EXPECT_TRUE(run.simulation.quiet());
}

TEST(Baseline, TheViewsOfAChangeArrive)
{
    BaselineRun run(one_pair(), {});
    run.run();
    expect_both_views_of_the_change(run);
}

TEST(Baseline, LostFramesAreAskedForAgain)
{
    Site site = one_pair();
    site.radio.frame_loss = 0.3;
    BaselineRun run(site, {});
    run.run();
    expect_both_views_of_the_change(run);
    EXPECT_GT(run.binocular().sender_counters().fragments_again, 0u);
}

TEST(Baseline, ARestartedSinkForgetsOnlyWhatItHasNotAcknowledged)
{
    BaselineRun whole(one_pair(), {});
    const std::uint64_t events = whole.run();
    const std::uint32_t never_again = whole.binocular().sender_counters().fragments_again;
    unsigned in_a_message = 0;
    for (std::uint64_t at = 0; at < events; at += events / 40) {
        BaselineRun run(one_pair(), {});
        run.run(at);
        expect_both_views_of_the_change(run);
        EXPECT_EQ(run.sink.restarts(), 1u);
        in_a_message += run.binocular().sender_counters().fragments_again > never_again ? 1 : 0;
    }
    EXPECT_GT(in_a_message, 3u); /* what was being put together is asked for again */
}

TEST(Baseline, CodingTakesTheProcessorItsTime)
{
    BaselineRun run(one_pair(), {});
    run.run();
    const PowerModel power;
    double cycles = 2 * 2 * 48 * 32 * Baseline::kInstructionsPerPixel * power.cycles_per_instruction;
    double others_us = 0;
    const auto &units = run.binocular().work_units();
    for (std::size_t kind = 1; kind < units.size(); ++kind) {
        others_us += instructions_per_unit(static_cast<tsr_work_kind>(kind)) * static_cast<double>(units.at(kind)) *
                     power.cycles_per_instruction / power.cpu_mhz;
    }
    const double run_mj =
        power.cpu_ua_per_mhz * power.cpu_mhz / 1000 * power.supply_v * (cycles / power.cpu_mhz + others_us) / 1e6;
    EXPECT_NEAR(run.binocular().energy().cpu.run, run_mj, 0.01 * run_mj);
    EXPECT_EQ(units.at(TSR_WORK_MATCH) + units.at(TSR_WORK_MAP_ENCODE), 0u);
}

TEST(Baseline, AStreamNeedsNoChange)
{
    Baseline stream;
    stream.stream = true;
    stream.period_ms = 1000;
    BaselineRun run(one_pair(), stream, 30'000'000);
    run.run();
    const auto &received = run.sink.received();
    ASSERT_GE(received.size(), 25u); /* the detector settles in the first frames */
    for (std::size_t i = 1; i < received.size(); ++i) {
        EXPECT_NEAR(static_cast<double>(received[i].capture_time_us - received[i - 1].capture_time_us), 1e6, 50e3);
    }
}

TEST(Baseline, ViewsThatFitNoMessageAreAFailedCapture)
{
    Baseline finest;
    finest.quality = 100;
    Site site = one_pair();
    for (SitePair &pair : site.pairs) {
        pair.width = 24; /* two files' tables alone are more than any map of so few pixels */
        pair.height = 16;
        pair.principal_px = {11.5, 7.5};
    }
    BaselineRun run(site, finest);
    run.run();
    EXPECT_TRUE(run.sink.received().empty());
    EXPECT_GT(run.binocular().counters().captures_failed, 0u);
    EXPECT_EQ(run.binocular().counters().maps_made, 0u);
}

TEST(Baseline, TwoBoardsAreRefused)
{
    const std::string error = refusal([] { baseline_site(short_site()); });
    EXPECT_NE(error.find("porch"), std::string::npos) << error;
    EXPECT_NE(error.find("two boards"), std::string::npos) << error;
}

TEST(Baseline, OnlyJpegFilesAreAccepted)
{
    /* The same nodes with their own coder: the sink refuses maps. */
    const Site site = one_pair();
    const KeyRing keys = derive_test_keys(7, site);
    TinyPictures pictures(site, kSceneEndUs);
    const Folder folder;
    JpegSink sink(keys, folder.path());
    Simulation simulation(site, keys, pictures, sink);
    simulation.run({});
    EXPECT_TRUE(sink.received().empty());
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_GT(simulation.nodes().back()->counters().maps_lost, 0u);
    EXPECT_EQ(simulation.nodes().back()->counters().maps_sent, 0u);
}

} // namespace
} // namespace tsr
