/* Write, fsync, rename. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tsr/host/input_error.h"

namespace tsr
{

AtomicFile::AtomicFile(const std::filesystem::path &target, unsigned mode)
    : target_(target), name_(target.parent_path() / ("." + target.filename().string() + ".XXXXXX"))
{
    std::string pattern = name_.string();
    descriptor_ = ::mkostemp(pattern.data(), O_CLOEXEC);
    if (descriptor_ < 0) {
        fail("create");
    }
    name_ = pattern;
    if (::fchmod(descriptor_, mode) != 0) {
        fail("mode");
    }
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
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) {
        fail("close");
    }
    if (::rename(name_.c_str(), target_.c_str()) != 0) {
        fail("rename");
    }
    name_.clear();
}

void AtomicFile::discard()
{
    if (descriptor_ >= 0) {
        ::close(descriptor_);
        descriptor_ = -1;
    }
    if (!name_.empty()) {
        ::unlink(name_.c_str());
        name_.clear();
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
