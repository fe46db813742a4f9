/* Write, fsync, rename. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr int kTriesMax = 100; /* writers of one file that wait for each other */

} // namespace

AtomicFile::AtomicFile(const std::filesystem::path &target, unsigned mode)
    : target_(target), name_(target.parent_path() / ("." + target.filename().string() + ".new"))
{
    bool opened = false;
    for (int tries = 0; !opened && tries < kTriesMax; ++tries) {
        opened = open_locked();
    }
    if (!opened) {
        open_unique();
    }
    if (::ftruncate(descriptor_, 0) != 0) { /* of a writer that was killed */
        fail("create");
    }
    if (::fchmod(descriptor_, mode) != 0) {
        fail("mode");
    }
}

/* The lock is of the file, and the name may have gone to another while it was waited for. Only a plain file of ours is
 * one that an earlier writer left. */
bool AtomicFile::open_locked()
{
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (descriptor_ < 0) {
        return false;
    }
    int locked = ::flock(descriptor_, LOCK_EX);
    while (locked != 0 && errno == EINTR) {
        locked = ::flock(descriptor_, LOCK_EX);
    }
    struct stat opened {
    };
    struct stat named {
    };
    const bool ours = locked == 0 && ::fstat(descriptor_, &opened) == 0 && ::lstat(name_.c_str(), &named) == 0 &&
                      opened.st_dev == named.st_dev && opened.st_ino == named.st_ino && S_ISREG(opened.st_mode) &&
                      opened.st_nlink == 1 && opened.st_uid == ::geteuid();
    if (!ours) {
        ::close(descriptor_);
        descriptor_ = -1;
    }
    return ours;
}

/* Where there are no locks, or something else has the name. */
void AtomicFile::open_unique()
{
    std::string pattern = name_.string() + ".XXXXXX";
    name_.clear();
    descriptor_ = ::mkostemp(pattern.data(), O_CLOEXEC);
    if (descriptor_ < 0) {
        fail("create");
    }
    name_ = pattern;
}

void AtomicFile::write(std::span<const std::uint8_t> bytes)
{
    while (!bytes.empty()) {
        const ssize_t sent = ::write(descriptor_, bytes.data(), bytes.size());
        if (sent < 0 && errno == EINTR) {
            continue;
        }
        if (sent < 0) {
            fail("write");
        }
        bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
}

void AtomicFile::complete()
{
    if (::fsync(descriptor_) != 0) {
        fail("fsync");
    }
    if (::rename(name_.c_str(), target_.c_str()) != 0) {
        fail("rename");
    }
    name_.clear();
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) {
        fail("close");
    }
}

void AtomicFile::discard()
{
    if (!name_.empty()) {
        ::unlink(name_.c_str()); /* while it is locked, so it is ours */
        name_.clear();
    }
    if (descriptor_ >= 0) {
        ::close(descriptor_);
        descriptor_ = -1;
    }
}

/* A constructor that throws runs no destructor, so the file goes here. */
void AtomicFile::fail(const char *step)
{
    const std::string reason = std::strerror(errno);
    discard();
    throw InputError(target_.string(), step, reason);
}

void write_file_atomically(const std::filesystem::path &file, std::span<const std::uint8_t> bytes, unsigned mode)
{
    AtomicFile out(file, mode);
    out.write(bytes);
    out.complete();
}

void write_file_atomically(const std::filesystem::path &file, std::string_view text, unsigned mode)
{
    write_file_atomically(file, {reinterpret_cast<const std::uint8_t *>(text.data()), text.size()}, mode);
}

} // namespace tsr
