/* A folder beside the results. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/unfinished_run.h"

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

namespace fs = std::filesystem;

constexpr const char *kLog = "sink.log";

} // namespace

UnfinishedRun::UnfinishedRun(const OutFolder &out) : out_(out), folder_(out.unfinished())
{
    std::error_code error;
    fs::remove_all(folder_, error); /* of a run that was killed */
    if (!error) {
        fs::create_directory(folder_, error);
    }
    if (error) {
        throw InputError(folder_.string(), "create", error.message());
    }
}

UnfinishedRun::~UnfinishedRun()
{
    if (complete_) {
        return;
    }
    std::error_code ignored;
    for (auto entry = fs::directory_iterator(folder_, ignored); entry != fs::directory_iterator();
         entry.increment(ignored)) {
        const bool says_why = entry->path().filename() == kLog && entry->file_size(ignored) > 0;
        if (!says_why) {
            fs::remove_all(entry->path(), ignored);
        }
    }
    fs::remove(folder_, ignored); /* only an empty folder goes */
}

void UnfinishedRun::complete()
{
    complete_ = true;
    out_.replace();
}

} // namespace tsr
