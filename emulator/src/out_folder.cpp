/*
 * Claiming, clearing and cleaning up a folder of results.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/out_folder.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr const char *kMark = "tarsier-run";
constexpr std::array kNames = {"site.toml", "keys.toml", "sink.db",      "sink.db-wal",    "sink.db-shm", "sink.socket",
                               "sink.log",  "sink.json", "summary.json", "capture.pcapng", "index.html",  "cloud.ply",
                               "maps",      "nodes.csv", "links.csv",    "maps.csv",       "events.csv",  "sweep.csv",
                               "runs",      "pictures",  "scenario.toml"};

} // namespace

OutFolder::OutFolder(std::filesystem::path folder) : folder_(std::move(folder))
{
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
        throw InputError(folder_.string(), "--out", error.message());
    }
    refuse_foreign();
    lock_ = open(file(kMark).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock_ < 0) {
        throw InputError(file(kMark).string(), "open", std::strerror(errno));
    }
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        close(lock_);
        throw InputError(folder_.string(), "--out", "another run writes there");
    }
    try {
        clear();
    } catch (...) {
        close(lock_);
        throw;
    }
}

void OutFolder::refuse_foreign() const
{
    std::error_code ignored;
    if (std::filesystem::exists(file(kMark), ignored)) {
        return;
    }
    for (const char *name : kNames) {
        if (std::filesystem::exists(file(name), ignored)) {
            throw InputError(folder_.string(), "--out",
                             std::string("holds a ") + name +
                                 " that no run of the emulator made; choose another folder");
        }
    }
}

void OutFolder::clear() const
{
    for (const char *name : kNames) {
        std::error_code error;
        std::filesystem::remove_all(file(name), error);
        if (error) {
            throw InputError(file(name).string(), "remove", error.message());
        }
    }
}

OutFolder::~OutFolder()
{
    if (!kept_) {
        std::error_code ignored;
        for (const char *name : kNames) {
            const bool says_why = std::strcmp(name, "sink.log") == 0 && std::filesystem::exists(file(name), ignored) &&
                                  std::filesystem::file_size(file(name), ignored) > 0;
            if (!says_why) {
                std::filesystem::remove_all(file(name), ignored);
            }
        }
    }
    close(lock_);
}

} // namespace tsr
