/*
 * The folder of the results of a run, or of a sweep with its runs below, claimed
 * for it alone.
 *
 * A file tarsier-run marks a folder as ours and is locked while a run writes
 * there. A folder that holds files of the names we write but no mark is
 * somebody's own and is refused.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_OUT_FOLDER_H
#define TSR_EMULATOR_OUT_FOLDER_H

#include <filesystem>

namespace tsr
{

class OutFolder
{
  public:
    /* Throws InputError: cannot be made or written, somebody's own, in use. */
    explicit OutFolder(std::filesystem::path folder);
    ~OutFolder();
    OutFolder(const OutFolder &) = delete;
    OutFolder &operator=(const OutFolder &) = delete;

    std::filesystem::path file(const char *name) const { return folder_ / name; }
    const std::filesystem::path &path() const { return folder_; }
    /* Where a run keeps its results until they are complete. */
    std::filesystem::path unfinished() const;
    /* Throws InputError if input lies in what clear() or an UnfinishedRun takes away. */
    void refuse_input(const std::filesystem::path &input) const;
    /* Remove an earlier run's results. Throws InputError. */
    void clear() const;
    /* Its results are now those of the folder from, which go from there. Throws InputError. */
    void replace_by(const std::filesystem::path &from) const;
    /* A process that inherits it keeps the folder claimed while it lives. */
    int lock() const { return lock_; }

  private:
    void refuse_foreign() const;

    std::filesystem::path folder_;
    int lock_ = -1;
};

} // namespace tsr

#endif
