/*
 * Which path lies below which, through links, "..", slashes and what does not exist.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/host/paths.h"

using namespace tsr;
using namespace tsr::test;

namespace
{

namespace fs = std::filesystem;

/* The working folder, as long as a test. */
class WorkingFolder
{
  public:
    explicit WorkingFolder(const fs::path &folder) : before_(fs::current_path()) { fs::current_path(folder); }
    ~WorkingFolder()
    {
        std::error_code ignored;
        fs::current_path(before_, ignored);
    }
    WorkingFolder(const WorkingFolder &) = delete;
    WorkingFolder &operator=(const WorkingFolder &) = delete;

  private:
    fs::path before_;
};

TEST(HostPaths, AFolderItselfAndWhatIsBelowLieWithin)
{
    const Folder folder;
    const fs::path file = folder.put("out/runs/0001/site.toml", "");
    EXPECT_TRUE(lies_within(folder / "out", folder / "out"));
    EXPECT_TRUE(lies_within(file, folder / "out"));
    EXPECT_TRUE(lies_within(file, folder / "out/"));
    EXPECT_TRUE(lies_within(folder / "out/", folder / "out"));
    EXPECT_TRUE(lies_within(file, "/"));
    EXPECT_TRUE(lies_within("/", "/"));
}

TEST(HostPaths, WhatIsAboveOrBesideDoesNot)
{
    const Folder folder;
    folder.put("out/site.toml", "");
    folder.put("output/site.toml", "");
    EXPECT_FALSE(lies_within(folder.path(), folder / "out"));
    EXPECT_FALSE(lies_within(folder / "output/site.toml", folder / "out"));
    EXPECT_FALSE(lies_within(folder / "out", folder / "output"));
    EXPECT_FALSE(lies_within(folder / "out/../output/site.toml", folder / "out"));
    EXPECT_FALSE(lies_within("/", folder / "out"));
}

TEST(HostPaths, LinksAreFollowedOnBothSides)
{
    const Folder folder;
    const fs::path file = folder.put("out/pictures/a.png", "");
    fs::create_directory_symlink(folder / "out/pictures", folder / "elsewhere");
    fs::create_directory_symlink(folder / "out", folder / "other_name");
    fs::create_symlink(folder.put("kept/site.toml", ""), folder / "out/link.toml");
    EXPECT_TRUE(lies_within(folder / "elsewhere/a.png", folder / "out"));
    EXPECT_TRUE(lies_within(file, folder / "other_name"));
    /* Removing the link leaves the file. */
    EXPECT_FALSE(lies_within(folder / "out/link.toml", folder / "out"));
}

TEST(HostPaths, WhatDoesNotExistIsTakenAsWritten)
{
    const Folder folder;
    fs::create_directory(folder / "real");
    fs::create_directory_symlink(folder / "real", folder / "link");
    EXPECT_TRUE(lies_within(folder / "link/new/site.toml", folder / "real/new"));
    EXPECT_TRUE(lies_within(folder / "real/a/./b/..", folder / "link/a"));
    EXPECT_FALSE(lies_within(folder / "real/news", folder / "link/new"));
}

TEST(HostPaths, RelativePathsStartFromTheWorkingFolder)
{
    const Folder folder;
    folder.put("out/site.toml", "");
    const WorkingFolder here(folder / "out");
    EXPECT_TRUE(lies_within("site.toml", folder / "out"));
    EXPECT_TRUE(lies_within(folder / "out/site.toml", "."));
    EXPECT_TRUE(lies_within("new", "."));
    EXPECT_FALSE(lies_within("../new", "."));
    EXPECT_EQ(real_path("."), real_path(folder / "out/"));
    EXPECT_EQ(real_path("new/").filename(), "new");
}

TEST(HostPaths, APathThatLeadsNowhereIsRefused)
{
    const Folder folder;
    fs::create_symlink(folder / "b", folder / "a");
    fs::create_symlink(folder / "a", folder / "b");
    EXPECT_REFUSED(lies_within(folder / "a", folder.path()), (folder / "a").string() + ": path: ");
    EXPECT_REFUSED(lies_within(folder.path(), folder / "b"), (folder / "b").string() + ": path: ");
    EXPECT_REFUSED(real_path(folder / std::string(300, 'n')), "path: File name too long");
}

} // namespace
