/*
 * Claiming, clearing and cleaning up a folder of results.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/out_folder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "tsr/host/input_error.h"
#include "tsr/host/paths.h"

namespace tsr
{

namespace
{

constexpr const char *kMark = "tarsier-run";
constexpr const char *kUnfinished = "unfinished";
constexpr const char *kReplaced = "replaced"; /* results of before, while others take their place */
constexpr const char *kPlacing = "placing";   /* those others, once nothing of before is in their way */
constexpr std::array kNames = {"site.toml",  "keys.toml", "sink.db",      "sink.db-wal",    "sink.db-shm",
                               "sink.log",   "sink.json", "summary.json", "capture.pcapng", "index.html",
                               "cloud.ply",  "maps",      "nodes.csv",    "links.csv",      "maps.csv",
                               "events.csv", "sweep.csv", "runs",         "pictures",       "scenario.toml"};

} // namespace

OutFolder::OutFolder(std::filesystem::path folder) : folder_(std::move(folder))
{
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
        throw InputError(folder_.string(), "--out", error.message());
    }
    refuse_foreign();
    /* A process that this one starts inherits it: the folder stays claimed while that lives and may write. */
    lock_ = open(file(kMark).c_str(), O_RDWR | O_CREAT, 0644);
    if (lock_ < 0) {
        throw InputError(file(kMark).string(), "open", std::strerror(errno));
    }
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        close(lock_);
        throw InputError(folder_.string(), "--out", "another run writes there");
    }
    try {
        recover();
    } catch (...) {
        close(lock_);
        throw;
    }
}

OutFolder::~OutFolder()
{
    close(lock_);
}

void OutFolder::refuse_foreign() const
{
    std::error_code ignored;
    if (std::filesystem::exists(file(kMark), ignored)) {
        return;
    }
    std::vector<const char *> names(kNames.begin(), kNames.end());
    names.insert(names.end(), {kUnfinished, kReplaced, kPlacing});
    for (const char *name : names) {
        if (std::filesystem::exists(file(name), ignored)) {
            throw InputError(folder_.string(), "--out",
                             std::string("holds ") + name + " that no run of the emulator made; choose another folder");
        }
    }
}

void OutFolder::refuse_input(const std::filesystem::path &input) const
{
    for (const std::filesystem::path &path : cleared()) {
        if (lies_within(input, path)) {
            throw InputError(input.string(), "--out",
                             "is among the results of an earlier run in " + folder_.string() +
                                 ", which this run would replace; choose another folder");
        }
    }
}

std::filesystem::path OutFolder::unfinished() const
{
    return file(kUnfinished);
}

std::vector<std::filesystem::path> OutFolder::cleared() const
{
    std::vector<std::filesystem::path> paths{unfinished()};
    std::transform(kNames.begin(), kNames.end(), std::back_inserter(paths),
                   [this](const char *name) { return file(name); });
    return paths;
}

void OutFolder::clear() const
{
    for (const std::filesystem::path &path : cleared()) {
        std::error_code error;
        std::filesystem::remove_all(path, error);
        if (error) {
            throw InputError(path.string(), "remove", error.message());
        }
    }
}

bool OutFolder::is_there(const std::filesystem::path &path)
{
    std::error_code ignored;
    return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
}

void OutFolder::move_results(const std::filesystem::path &from, const std::filesystem::path &to)
{
    for (const char *name : kNames) {
        std::error_code error;
        if (is_there(from / name)) {
            std::filesystem::rename(from / name, to / name, error);
        }
        if (error) {
            throw InputError((from / name).string(), "rename", error.message());
        }
    }
}

/* Those that were moved out of the way; what has its name again is another one. */
void OutFolder::bring_back() const
{
    const auto replaced = file(kReplaced);
    std::error_code error;
    for (const char *name : kNames) {
        if (is_there(replaced / name) && !is_there(file(name))) {
            std::filesystem::rename(replaced / name, file(name), error);
        }
        if (error) {
            throw InputError((replaced / name).string(), "rename", error.message());
        }
    }
    std::filesystem::remove_all(replaced, error);
}

/* What lies in "replaced" and "placing" tells how far it has come: recover() goes on from there. */
void OutFolder::replace() const
{
    const auto replaced = file(kReplaced);
    std::error_code error;
    std::filesystem::create_directory(replaced, error);
    if (error) {
        throw InputError(replaced.string(), "create", error.message());
    }
    try {
        move_results(folder_, replaced);
        std::filesystem::rename(unfinished(), file(kPlacing));
    } catch (const std::exception &failure) {
        bring_back();
        throw InputError(folder_.string(), "results",
                         std::string("could not be replaced: ") + failure.what() + "; the new ones are in " +
                             unfinished().string());
    }
    place();
}

void OutFolder::place() const
{
    move_results(file(kPlacing), folder_);
    std::error_code ignored;
    std::filesystem::remove_all(file(kPlacing), ignored);
    std::filesystem::remove_all(file(kReplaced), ignored);
}

void OutFolder::recover() const
{
    std::error_code error;
    if (is_there(file(kPlacing))) {
        place();
    } else if (is_there(file(kReplaced))) {
        if (is_there(unfinished())) {
            bring_back();
        }
        std::filesystem::remove_all(file(kReplaced), error);
    }
    if (error) {
        throw InputError(folder_.string(), "--out", error.message());
    }
}

} // namespace tsr
