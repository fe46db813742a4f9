/* Complete or not at all, whoever else writes or was killed. SPDX-License-Identifier: Apache-2.0 */
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "test_host_folder.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test
{
  protected:
    void write(std::string_view text) { write_file_atomically(target, text, 0640); }

    test::Folder folder;
    fs::path target = folder / "a.txt";
    fs::path temporary = folder / ".a.txt.new";
};

TEST_F(AtomicFileTest, IsThereOnlyWhenComplete)
{
    folder.put("a.txt", "before");
    {
        AtomicFile file(target);
        file.write(std::array<std::uint8_t, 3>{1, 2, 3});
        EXPECT_EQ(read_text_file(target), "before");
        EXPECT_TRUE(fs::exists(temporary));
    }
    EXPECT_EQ(read_text_file(target), "before");
    EXPECT_FALSE(fs::exists(temporary));
    write("after");
    EXPECT_EQ(read_text_file(target), "after");
    EXPECT_FALSE(fs::exists(temporary));
    struct stat status {
    };
    ASSERT_EQ(::stat(target.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(AtomicFileTest, TakesOverWhatAKilledWriterLeft)
{
    folder.put(".a.txt.new", "half of something long");
    write("all");
    EXPECT_EQ(read_text_file(target), "all");
    EXPECT_FALSE(fs::exists(temporary));
}

TEST_F(AtomicFileTest, ASecondWriterWaitsForTheFirst)
{
    std::atomic<bool> written = false;
    std::thread second;
    {
        AtomicFile first(target);
        second = std::thread([&] {
            write("second");
            written = true;
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        EXPECT_FALSE(written);
        first.write(std::array<std::uint8_t, 5>{'f', 'i', 'r', 's', 't'});
        first.complete();
    }
    second.join();
    EXPECT_EQ(read_text_file(target), "second");
    EXPECT_FALSE(fs::exists(temporary));
}

TEST_F(AtomicFileTest, SparesWhatHasTheNameAndIsNotItsOwn)
{
    const fs::path other = folder.put("other", "somebody's");
    fs::create_symlink(other, temporary);
    write("beside a link");
    EXPECT_TRUE(fs::is_symlink(temporary));
    fs::remove(temporary);
    fs::create_hard_link(other, temporary);
    write("beside a second name");
    EXPECT_TRUE(fs::exists(temporary));
    EXPECT_EQ(read_text_file(other), "somebody's");
    EXPECT_EQ(read_text_file(target), "beside a second name");
    EXPECT_EQ(std::distance(fs::directory_iterator(target.parent_path()), fs::directory_iterator()), 3);
}

TEST_F(AtomicFileTest, AFolderThatIsNotThereIsRefusedByName)
{
    EXPECT_REFUSED(write_file_atomically(folder / "no/a.txt", "x"), "no/a.txt: create: No such file");
}

} // namespace
} // namespace tsr
