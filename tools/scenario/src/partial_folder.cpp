/*
 * Claiming, naming and removing a folder that grows.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "partial_folder.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tsr/host/input_error.h"
#include "tsr/host/paths.h"

namespace tsr
{

namespace
{

namespace fs = std::filesystem;

constexpr const char *kMark = "tarsier-render";

[[noreturn]] void refuse(const fs::path &path, const std::string &reason)
{
    throw InputError(path.string(), "--out", reason);
}

bool is_mount_point(const fs::path &folder)
{
    struct stat inside {
    }, around{};
    return ::stat(folder.c_str(), &inside) == 0 && ::stat(folder.parent_path().c_str(), &around) == 0 &&
           inside.st_dev != around.st_dev;
}

/* In the end another folder takes its place. */
void refuse_unless_replaceable(const fs::path &out)
{
    std::error_code error;
    const fs::file_status status = fs::symlink_status(out, error);
    if (status.type() == fs::file_type::not_found) {
        return;
    }
    if (!fs::is_directory(status) || !fs::is_empty(out, error) || error) {
        refuse(out, "is there already and not an empty folder");
    }
    if (lies_within(fs::current_path(), out)) {
        refuse(out, "is the working folder; name a new one");
    }
    if (is_mount_point(out)) {
        refuse(out, "is a mount point; name a folder in it");
    }
}

} // namespace

PartialFolder::PartialFolder(const fs::path &out) : out_(real_path(out)), folder_(out_.string() + ".partial")
{
    refuse_unless_replaceable(out_);
    std::error_code error;
    const fs::file_status status = fs::symlink_status(folder_, error);
    if (fs::exists(status)) {
        const bool is_folder = fs::is_directory(status);
        const bool ours = is_folder && fs::is_regular_file(fs::symlink_status(folder_ / kMark, error));
        if (!ours && !(is_folder && fs::is_empty(folder_, error) && !error)) {
            refuse(folder_, "is where the frames grow, and no render made it; remove it or choose another folder");
        }
    }
    make(folder_);
    claim();
}

void PartialFolder::claim()
{
    const fs::path mark = folder_ / kMark;
    lock_ = ::open(mark.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (lock_ < 0) {
        refuse(mark, std::strerror(errno));
    }
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        ::close(lock_);
        refuse(folder_, "another render writes there");
    }
    for (fs::directory_iterator entry(folder_); entry != fs::directory_iterator(); ++entry) {
        std::error_code error;
        if (entry->path().filename() != kMark && (fs::remove_all(entry->path(), error), error)) {
            ::close(lock_);
            refuse(entry->path(), error.message());
        }
    }
}

PartialFolder::~PartialFolder()
{
    if (!kept_) {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    ::close(lock_);
}

void PartialFolder::make(const fs::path &folder)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        refuse(folder, error.message());
    }
}

void PartialFolder::keep()
{
    std::error_code error;
    fs::rename(folder_, out_, error); /* an empty folder gives way */
    if (error) {
        refuse(out_, error.message());
    }
    kept_ = true;
    fs::remove(out_ / kMark, error);
    if (error) {
        refuse(out_ / kMark, error.message());
    }
}

} // namespace tsr
