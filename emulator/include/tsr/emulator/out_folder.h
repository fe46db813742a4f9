/*
 * The folder of the results of a run, or of a sweep with its runs below, claimed
 * for it alone.
 *
 * A file tarsier-run marks a folder as ours and is locked while a run writes
 * there or a process that it has started. A folder that holds files of the names we write but no mark is
 * somebody's own and is refused.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_OUT_FOLDER_H
#define TSR_EMULATOR_OUT_FOLDER_H

#include <filesystem>
#include <vector>

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
    /* Remove an earlier run's results, and what an unfinished one left. Throws InputError. */
    void clear() const;
    /* The results are now those in unfinished(), which is gone then. Throws InputError: those of before and
     * unfinished() are as they were. Whatever ends the program meanwhile, the next claim brings it to an end, or back.
     */
    void replace() const;

  private:
    void refuse_foreign() const;
    void recover() const;
    std::vector<std::filesystem::path> cleared() const;
    void bring_back() const;
    void place() const;
    static bool is_there(const std::filesystem::path &path);
    static void move_results(const std::filesystem::path &from, const std::filesystem::path &to);

    std::filesystem::path folder_;
    int lock_ = -1;
};

} // namespace tsr

#endif
