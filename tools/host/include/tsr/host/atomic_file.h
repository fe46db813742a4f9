/*
 * Files that appear complete or not at all: the bytes go to .NAME.new in the
 * same folder, reach the disk (fsync), and take the final name by rename(2). An
 * existing file stays whole until that instant. .NAME.new is locked (flock(2)),
 * so a second writer waits for the first (one thread must not have two of one
 * target), and one that was killed leaves nothing that the next does not take
 * over. Where that name cannot be locked or is somebody's own, another is made.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_ATOMIC_FILE_H
#define TSR_HOST_ATOMIC_FILE_H

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace tsr
{

/* One that is written piece by piece; gone unless it is completed. */
class AtomicFile
{
  public:
    /* mode as below. All throw InputError naming target; the temporary is gone then. */
    explicit AtomicFile(const std::filesystem::path &target, unsigned mode = 0644);
    ~AtomicFile() { discard(); }
    AtomicFile(const AtomicFile &) = delete;
    AtomicFile &operator=(const AtomicFile &) = delete;

    void write(std::span<const std::uint8_t> bytes);
    /* From now on it is there under its name. Call last. */
    void complete();

  private:
    bool open_locked();
    void open_unique();
    void discard();
    [[noreturn]] void fail(const char *step);

    std::filesystem::path target_;
    std::filesystem::path name_;
    int descriptor_ = -1;
};

/* mode is the file's permission bits, exact (umask does not apply).
 * Throws InputError naming file; the temporary is gone then. */
void write_file_atomically(const std::filesystem::path &file, std::span<const std::uint8_t> bytes,
                           unsigned mode = 0644);
void write_file_atomically(const std::filesystem::path &file, std::string_view text, unsigned mode = 0644);

} // namespace tsr

#endif
