/*
 * The folder of the results of a run, or of a sweep with its runs below, claimed
 * for it alone.
 *
 * A file tarsier-run marks a folder as ours and is locked while a run writes
 * there. A folder that holds files of the names we write but no mark is
 * somebody's own and is refused; an earlier run's results are removed, since
 * test keys are the same again and old counters would look like replays. A run
 * that ends early leaves nothing behind but what its sink had to say.
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
    ~OutFolder(); /* without keep(): removes what was begun */
    OutFolder(const OutFolder &) = delete;
    OutFolder &operator=(const OutFolder &) = delete;

    std::filesystem::path file(const char *name) const { return folder_ / name; }
    const std::filesystem::path &path() const { return folder_; }
    /* The results are complete. */
    void keep() { kept_ = true; }

  private:
    void refuse_foreign() const;
    void clear() const;

    std::filesystem::path folder_;
    int lock_ = -1;
    bool kept_ = false;
};

} // namespace tsr

#endif
