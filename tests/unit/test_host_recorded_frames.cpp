/* Folders of frames. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "tsr/host/recorded_frames.h"

namespace tsr
{
namespace
{

using test::Folder;

std::string pgm(int width, int height, char fill)
{
    return "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n" +
           std::string(static_cast<std::size_t>(width * height), fill);
}

TEST(HostFrames, SortsByNameAndSpacesByPeriod)
{
    const Folder folder;
    folder.put("b.pgm", pgm(4, 3, 'b'));
    folder.put("a.pgm", pgm(4, 3, 'a'));
    folder.put("notes.txt", "not a frame");
    RecordedFrames frames(folder.path(), 250);
    ASSERT_EQ(frames.count(), 2u);
    EXPECT_EQ(frames.size(), (ImageSize{4, 3}));
    EXPECT_EQ(frames.frame(0)->pixels[0], 'a');
    EXPECT_EQ(frames.frame(1)->pixels[0], 'b');
    EXPECT_EQ(frames.time_ms(1), 250u);
    EXPECT_EQ(frames.length_ms(), 500u);
    EXPECT_EQ(frames.index_at(0), 0u);
    EXPECT_EQ(frames.index_at(249), 0u);
    EXPECT_EQ(frames.index_at(250), 1u);
    EXPECT_EQ(frames.index_at(99999), 1u);
    EXPECT_THROW(frames.frame(2), std::out_of_range);
}

TEST(HostFrames, TimesFileDecidesOrderAndTime)
{
    const Folder folder;
    folder.put("a.pgm", pgm(4, 3, 'a'));
    folder.put("b.pgm", pgm(4, 3, 'b'));
    folder.put("times.csv", "\xef\xbb\xbf"
                            "file,time_ms\r\n\"b.pgm\",10\r\n\na.pgm,40\nb.pgm,50\n\r\n");
    RecordedFrames frames(folder.path(), 1);
    ASSERT_EQ(frames.count(), 3u);
    EXPECT_EQ(frames.frame(0)->pixels[0], 'b');
    EXPECT_EQ(frames.time_ms(2), 50u);
    EXPECT_EQ(frames.index_at(5), 0u);
    EXPECT_EQ(frames.index_at(45), 1u);
    EXPECT_EQ(frames.frame(0), frames.frame(2)); /* one file, one image */
    EXPECT_EQ(frames.length_ms(), 60u);          /* the last frame stays as long as the one before it */
}

TEST(HostFrames, CacheForgetsTheOldestAndReadsAgain)
{
    const Folder folder;
    for (const char name : {'a', 'b', 'c'}) {
        folder.put(std::string(1, name) + ".pgm", pgm(4, 3, name));
    }
    RecordedFrames frames(folder.path(), 1, 24); /* two frames of 12 bytes */
    const auto first = frames.frame(0);
    frames.frame(1);
    EXPECT_EQ(frames.frame(0), first);
    frames.frame(2);
    EXPECT_NE(frames.frame(0), first);
    EXPECT_EQ(frames.frame(0)->pixels, first->pixels);
}

TEST(HostFrames, RefusesFoldersThatDoNotFit)
{
    const Folder folder;
    EXPECT_REFUSED(RecordedFrames(folder / "absent", 1), "absent");
    EXPECT_REFUSED(RecordedFrames(folder.path(), 1), "holds no frames");
    EXPECT_REFUSED(RecordedFrames(folder.path(), 0), "period_ms");
    folder.put("a.pgm", pgm(4, 3, 'a'));
    folder.put("b.pgm", pgm(4, 4, 'b'));
    EXPECT_REFUSED(RecordedFrames(folder.path(), 1), "b.pgm: size: 4x4, the frames before it are 4x3");
    folder.put("b.pgm", "P5 4 3 255\nshort");
    RecordedFrames frames(folder.path(), 1);
    EXPECT_REFUSED(frames.frame(1), "b.pgm: pixels: 5 bytes");
    folder.put("large/a.pgm", pgm(641, 2, 'a'));
    EXPECT_REFUSED(RecordedFrames(folder / "large", 1), "at most 640x480");
}

TEST(HostFrames, RefusesTimesThatDoNotFit)
{
    const Folder folder;
    folder.put("a.pgm", pgm(4, 3, 'a'));
    const auto refuse = [&](const std::string &text, const std::string &expected) {
        folder.put("times.csv", text);
        EXPECT_REFUSED(RecordedFrames(folder.path(), 1), expected);
    };
    refuse("", "holds no frames");
    refuse("a.pgm,0\n", "times.csv:1: header");
    refuse("file,time_ms\na.pgm\n", "times.csv:2: file");
    refuse("file,time_ms\na.pgm,x\n", "times.csv:2: time_ms: 'x'");
    refuse("file,time_ms\na.pgm,-1\n", "times.csv:2: time_ms");
    refuse("file,time_ms\na.pgm,5\na.pgm,5\n", "times.csv:3: time_ms: is not later");
    refuse("file,time_ms\nz.pgm,5\n", "z.pgm: No such file");
    refuse("file,time_ms\n../a.pgm,5\n", "times.csv:2: file");
    refuse("file,time_ms\n\n\"a.pgm,5\n", "times.csv:3: file");
}

TEST(HostFrames, RecordingsHaveThePairsSize)
{
    const Folder folder;
    folder.put("left/a.pgm", pgm(32, 24, 'a'));
    folder.put("right/a.pgm", pgm(32, 20, 'a'));
    Site site = test::small_site();
    site.file = folder / "site.toml";
    site.nodes[2].frames = "left";
    EXPECT_EQ(test::refusal([&] { check_recordings(site); }), "");
    site.nodes[3].frames = "right";
    EXPECT_REFUSED(check_recordings(site), "right: size: frames are 32x20, pair 'porch' says 32x24");
}

} // namespace
} // namespace tsr
