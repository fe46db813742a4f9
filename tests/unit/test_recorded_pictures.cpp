/* What is known to have happened in a recording. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "tsr/emulator/recorded_pictures.h"

namespace tsr
{
namespace
{

using test::Folder;

Site site_in(const Folder &folder)
{
    Site site = test::small_site();
    site.file = folder / "site.toml";
    return site;
}

TEST(RecordedPictures, EventsBesideTheSiteAreInOrderOfTime)
{
    const Folder folder;
    folder.put("events.csv", "time_s,what\r\n12.000,the person leaves\r\n0.25,the person comes in, \"late\"\n");
    const Site site = site_in(folder);
    const auto events = RecordedPictures(site).events();
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].time_us, 250'000u);
    EXPECT_EQ(events[0].what, "the person comes in, \"late\"");
    EXPECT_EQ(events[1].time_us, 12'000'000u);
    EXPECT_EQ(events[1].what, "the person leaves");
}

TEST(RecordedPictures, NoFileOrAnotherOneOfThatNameTellsNothing)
{
    const Folder folder;
    const Site site = site_in(folder);
    EXPECT_TRUE(RecordedPictures(site).events().empty());
    folder.put("events.csv", "node,pair,counter\n1,2,3\n");
    EXPECT_TRUE(RecordedPictures(site).events().empty());
    folder.put("events.csv", "");
    EXPECT_TRUE(RecordedPictures(site).events().empty());
    EXPECT_TRUE(RecordedPictures(test::small_site()).events().empty()); /* of no file */
}

TEST(RecordedPictures, ALineThatIsNoEventIsRefused)
{
    for (const char *line : {"soon,the person comes in", "1.5", "-1,the person comes in", "nan,x", "1e300,x"}) {
        const Folder folder;
        folder.put("events.csv", "time_s,what\n1,x\n" + std::string(line) + "\n");
        const Site site = site_in(folder);
        const std::string error = test::refusal([&] { RecordedPictures pictures(site); });
        EXPECT_NE(error.find("events.csv:3: time_s"), std::string::npos) << line << ": " << error;
    }
}

TEST(RecordedPictures, SpreadsheetsAreUnderstood)
{
    const Folder folder;
    folder.put("events.csv", "\xef\xbb\xbftime_s,what\r\n1,\"a, \"\"b\"\"\"\r\n\r\n2,\"\"\n\n");
    const Site site = site_in(folder);
    const auto events = RecordedPictures(site).events();
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].what, "a, \"b\"");
    EXPECT_EQ(events[1].what, "");
    for (const char *what : {"\"a", "\"a\"b", "\"a\"\"", "\""}) {
        folder.put("events.csv", "time_s,what\n\n1," + std::string(what) + "\n");
        EXPECT_REFUSED(RecordedPictures(site), "events.csv:3: what: its quotation marks");
    }
}

TEST(RecordedPictures, ALongListIsRefusedAndAnotherFileIsNotRead)
{
    const Folder folder;
    const Site site = site_in(folder);
    folder.put("events.csv", "time_s,what\n" + std::string(16u << 20, '\n'));
    EXPECT_REFUSED(RecordedPictures(site), "events.csv: 16777228 bytes, at most 16777216 are read");
    folder.put("events.csv", "x,y,t,polarity\n" + std::string(16u << 20, '\n'));
    EXPECT_TRUE(RecordedPictures(site).events().empty());
}

TEST(RecordedPictures, TextThatNoPageCanShowIsRefused)
{
    const Folder folder;
    folder.put("events.csv", "time_s,what\n1,caf\xe9\n");
    const Site site = site_in(folder);
    const std::string error = test::refusal([&] { RecordedPictures pictures(site); });
    EXPECT_NE(error.find("events.csv:2: what: is not UTF-8"), std::string::npos) << error;
}

TEST(RecordedPictures, AMissingTruthFolderIsNamed)
{
    const Folder folder;
    EXPECT_REFUSED(truth_file_for(folder / "truth", "000001.png"),
                   (folder / "truth").string() + ": truth: No such file");
}

} // namespace
} // namespace tsr
