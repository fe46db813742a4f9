/*
 * The results of a run until they are complete: in OUT/unfinished.
 *
 * Whatever ends a run before, an earlier run's results are still in OUT. Complete
 * ones take their place, all of them, since test keys are the same again and old
 * counters would look like replays.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_UNFINISHED_RUN_H
#define TSR_EMULATOR_UNFINISHED_RUN_H

#include <filesystem>

#include "tsr/emulator/out_folder.h"

namespace tsr
{

class UnfinishedRun
{
  public:
    /* out is kept. Throws InputError. */
    explicit UnfinishedRun(const OutFolder &out);
    /* Without complete(): all goes but what its sink had to say. What complete() could not put into OUT stays. */
    ~UnfinishedRun();
    UnfinishedRun(const UnfinishedRun &) = delete;
    UnfinishedRun &operator=(const UnfinishedRun &) = delete;

    std::filesystem::path file(const char *name) const { return folder_ / name; }
    const std::filesystem::path &path() const { return folder_; }
    /* Call last. Throws InputError. */
    void complete();

  private:
    const OutFolder &out_;
    std::filesystem::path folder_;
    bool complete_ = false;
};

} // namespace tsr

#endif
