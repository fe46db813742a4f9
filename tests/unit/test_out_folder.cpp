/* Results take the place of others whole, whatever cuts that off. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/emulator/out_folder.h"
#include "tsr/emulator/unfinished_run.h"
#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

namespace fs = std::filesystem;

class OutFolderTest : public testing::Test
{
  protected:
    OutFolderTest()
    {
        const OutFolder out(path);
        put(path / "site.toml", "old");
        put(path / "maps/1.pfm", "old");
        put(path / "sweep.csv", "old");
        put(path / "mine.txt", "mine");
    }

    static void put(const fs::path &file, const std::string &text)
    {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }

    void put_new(const fs::path &where) const
    {
        put(where / "site.toml", "new");
        put(where / "maps/2.pfm", "new");
    }

    bool has_old() const
    {
        return is(path / "site.toml", "old") && is(path / "maps/1.pfm", "old") && is(path / "sweep.csv", "old");
    }
    bool has_new() const
    {
        return is(path / "site.toml", "new") && is(path / "maps/2.pfm", "new") && !fs::exists(path / "maps/1.pfm") &&
               !fs::exists(path / "sweep.csv");
    }
    bool is_tidy() const
    {
        return is(path / "mine.txt", "mine") && !fs::exists(path / "unfinished") && !fs::exists(path / "replaced") &&
               !fs::exists(path / "placing");
    }
    static bool is(const fs::path &file, const std::string &text)
    {
        return fs::exists(file) && read_text_file(file) == text;
    }

    test::Folder folder;
    fs::path path = folder / "out";
};

TEST_F(OutFolderTest, CompleteResultsReplaceAllOfBefore)
{
    const OutFolder out(path);
    UnfinishedRun run(out);
    put_new(run.path());
    EXPECT_TRUE(has_old());
    run.complete();
    EXPECT_TRUE(has_new() && is_tidy());
}

TEST_F(OutFolderTest, AnUnfinishedRunLeavesAllAsItWas)
{
    {
        const OutFolder out(path);
        const UnfinishedRun run(out);
        put_new(run.path());
    }
    EXPECT_TRUE(has_old() && is_tidy());
}

TEST_F(OutFolderTest, WhatItsSinkHadToSayStays)
{
    {
        const OutFolder out(path);
        const UnfinishedRun run(out);
        put_new(run.path());
        put(run.file("sink.log"), "why");
    }
    EXPECT_TRUE(has_old());
    EXPECT_TRUE(is(path / "unfinished/sink.log", "why"));
    EXPECT_FALSE(fs::exists(path / "unfinished/site.toml"));
}

/* maps cannot be moved out of the way, after site.toml was. */
TEST_F(OutFolderTest, WhatCannotBeReplacedStaysAndSoDoTheNewOnes)
{
    const OutFolder out(path);
    {
        UnfinishedRun run(out);
        put_new(run.path());
        put(path / "replaced/maps/in the way", "");
        EXPECT_REFUSED(run.complete(), "could not be replaced");
    }
    EXPECT_TRUE(is(path / "site.toml", "old") && is(path / "maps/1.pfm", "old"));
    EXPECT_TRUE(is(path / "unfinished/site.toml", "new") && is(path / "unfinished/maps/2.pfm", "new"));
}

TEST_F(OutFolderTest, ACutWhileOldOnesGoBringsThemBack)
{
    put_new(path / "unfinished");
    fs::create_directory(path / "replaced");
    fs::rename(path / "site.toml", path / "replaced/site.toml");
    {
        const OutFolder out(path);
        EXPECT_TRUE(has_old());
        const UnfinishedRun run(out);
    }
    EXPECT_TRUE(has_old() && is_tidy());
}

TEST_F(OutFolderTest, ACutWhileNewOnesComeBringsTheOthersToo)
{
    put_new(path / "placing");
    fs::create_directory(path / "replaced");
    for (const char *name : {"site.toml", "maps", "sweep.csv"}) {
        fs::rename(path / name, path / "replaced" / name);
    }
    fs::rename(path / "placing/site.toml", path / "site.toml");
    const OutFolder out(path);
    EXPECT_TRUE(has_new() && is_tidy());
}

TEST_F(OutFolderTest, ACutBehindAllThatLeavesOnlyTheNewOnes)
{
    put_new(path / "placing");
    for (const char *name : {"site.toml", "maps", "sweep.csv"}) {
        fs::create_directories(path / "replaced");
        fs::rename(path / name, path / "replaced" / name);
    }
    fs::rename(path / "placing/site.toml", path / "site.toml");
    fs::rename(path / "placing/maps", path / "maps");
    fs::remove(path / "placing");
    const OutFolder out(path);
    EXPECT_TRUE(has_new() && is_tidy());
}

TEST_F(OutFolderTest, IsClaimedOnceAndNeverWhereItIsSomebodysOwn)
{
    const OutFolder out(path);
    EXPECT_REFUSED(OutFolder{path}, "another run writes there");
    put(folder / "own/summary.json", "mine");
    EXPECT_REFUSED(OutFolder{folder / "own"}, "holds summary.json");
}

TEST_F(OutFolderTest, InputsAmongTheResultsAreRefused)
{
    const OutFolder out(path);
    EXPECT_REFUSED(out.refuse_input(path / "maps"), "among the results");
    EXPECT_REFUSED(out.refuse_input(path / "unfinished/frames"), "among the results");
    EXPECT_REFUSED(out.refuse_input(path / "runs/1/scenario.toml"), "among the results");
    out.refuse_input(path / "mine.txt");
    out.refuse_input(path);
}

} // namespace
} // namespace tsr
