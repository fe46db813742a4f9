/*
 * Where a scene is rendered to: names, what is there already, what a render before left, when it can be stopped.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/scenario/render.h"

using namespace tsr;
using namespace tsr::test;

namespace
{

namespace fs = std::filesystem;

constexpr const char *kTiny =
    "name = \"t\"\nduration_s = 10\n[scene]\nkind = \"tank\"\n[pairs]\ncount = 1\nwidth = 16\n"
    "height = 16\ndisparities = 16\nwatch_period_ms = 5000\n";

class Render : public testing::Test
{
  protected:
    bool render(const fs::path &out)
    {
        const fs::path file = folder_.put("scenario.toml", kTiny);
        RenderOptions options;
        options.out = out;
        options.threads = 1;
        options.progress = [this](std::size_t done, std::size_t) {
            most_done_ = done;
            return !stops_;
        };
        return render_scenario(load_scenario(file, {}), options);
    }
    /* out is whole and nothing else is left. */
    void expect_whole(const fs::path &out)
    {
        EXPECT_TRUE(fs::exists(out / "site.toml"));
        EXPECT_TRUE(fs::exists(out / "pair-1/labels/000002.png"));
        EXPECT_FALSE(fs::exists(out / "tarsier-render"));
        EXPECT_FALSE(fs::exists(out.string() + ".partial"));
    }

    Folder folder_;
    bool stops_ = false;
    std::size_t most_done_ = 0;
};

TEST_F(Render, ASlashAtTheEndAndAnEmptyFolderAreNoMatter)
{
    EXPECT_TRUE(render(folder_ / "slash/"));
    expect_whole(folder_ / "slash");
    fs::create_directory(folder_ / "empty");
    EXPECT_TRUE(render(folder_ / "empty"));
    expect_whole(folder_ / "empty");
    EXPECT_TRUE(render(folder_ / "new/below/it"));
    expect_whole(folder_ / "new/below/it");
}

TEST_F(Render, AStopBeforeTheFirstFrameIsHeard)
{
    stops_ = true;
    EXPECT_FALSE(render(folder_ / "out"));
    EXPECT_EQ(most_done_, 0u);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    EXPECT_FALSE(fs::exists(folder_ / "out.partial"));
}

TEST_F(Render, WhatIsThereIsRefusedBeforeAFrame)
{
    folder_.put("full/notes", "mine");
    folder_.put("file", "");
    fs::create_directory(folder_ / "here");
    fs::create_symlink("nowhere", folder_ / "link");
    EXPECT_REFUSED(render(folder_ / "full"), "full: --out: is there already");
    EXPECT_REFUSED(render(folder_ / "file"), "file: --out: is there already");
    EXPECT_REFUSED(render(folder_ / "link"), "link: --out: is there already");
    EXPECT_REFUSED(render("/proc/self"), "--out: is there already");
    const fs::path before = fs::current_path();
    fs::current_path(folder_ / "here");
    EXPECT_REFUSED(render("."), "here: --out: is the working folder");
    fs::current_path(before);
    EXPECT_EQ(most_done_, 0u);
}

TEST_F(Render, SomebodysPartialFolderStays)
{
    const fs::path mine = folder_.put("a.partial/precious", "mine");
    const fs::path file = folder_.put("b.partial", "mine");
    fs::create_directory_symlink(folder_.put("kept/precious", "mine").parent_path(), folder_ / "c.partial");
    for (const char *name : {"a", "b", "c"}) {
        EXPECT_REFUSED(render(folder_ / name), std::string(name) + ".partial: --out: is where the frames grow");
    }
    EXPECT_EQ(read_all(mine) + read_all(file) + read_all(folder_ / "c.partial/precious"), "mineminemine");
    EXPECT_EQ(most_done_, 0u);
}

TEST_F(Render, WhatAKilledRenderLeftIsRemoved)
{
    folder_.put("out.partial/tarsier-render", "");
    folder_.put("out.partial/pair-7/left/000000.png", "half");
    EXPECT_TRUE(render(folder_ / "out"));
    expect_whole(folder_ / "out");
    EXPECT_FALSE(fs::exists(folder_ / "out/pair-7"));
}

TEST_F(Render, TwoAtOnceAreRefused)
{
    const fs::path mark = folder_.put("out.partial/tarsier-render", "");
    const int other = ::open(mark.c_str(), O_RDWR);
    ASSERT_EQ(::flock(other, LOCK_EX), 0);
    EXPECT_REFUSED(render(folder_ / "out"), "out.partial: --out: another render writes there");
    EXPECT_TRUE(fs::exists(mark));
    ::close(other);
}

TEST_F(Render, MoreFramesThanNamesAreRefused)
{
    const fs::path file =
        folder_.put("long.toml", std::string(kTiny).replace(std::string(kTiny).find("10"), 2, "1000"));
    RenderOptions options;
    options.out = folder_ / "out";
    options.period_ms = 1;
    EXPECT_REFUSED(render_scenario(load_scenario(file, {}), options),
                   "long.toml: --period-ms: 1000001 frames a view in duration_s, at most 1000000 are written");
    EXPECT_FALSE(fs::exists(folder_ / "out.partial"));
}

} // namespace
