/*
 * An SQLite VFS in memory whose power can fail.
 *
 * Each file is what was synced plus a list of writes and truncations since.
 * fail_after(n) lets n more writing operations pass, then everything fails with
 * an I/O error. cut_power() ends all use of the files and replays, per file and
 * in order, a random choice of the unsynced operations (seed 0: none), some of
 * them torn at a 512-byte sector; a later write may survive where an earlier
 * is lost. Creation and deletion of files is durable at once.
 *
 * sqlite.org/c3ref/vfs.html, sqlite.org/atomiccommit.html.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_SINK_POWER_VFS_H
#define TSR_TEST_SINK_POWER_VFS_H

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <sqlite3.h>

namespace tsr::test
{

class PowerVfs
{
  public:
    PowerVfs()
    {
        static int count = 0;
        name_ = "power" + std::to_string(count++);
        vfs_ = *sqlite3_vfs_find(nullptr); /* time, randomness, sleep */
        vfs_.iVersion = 1;
        vfs_.szOsFile = sizeof(Handle);
        vfs_.zName = name_.c_str();
        vfs_.pAppData = this;
        vfs_.pNext = nullptr;
        vfs_.xOpen = open_file;
        vfs_.xDelete = delete_file;
        vfs_.xAccess = access_file;
        vfs_.xFullPathname = full_pathname;
        sqlite3_vfs_register(&vfs_, 0);
    }
    PowerVfs(const PowerVfs &) = delete;
    PowerVfs &operator=(const PowerVfs &) = delete;
    ~PowerVfs() { sqlite3_vfs_unregister(&vfs_); }

    const char *name() const { return name_.c_str(); }
    void fail_after(int operations) { operations_left_ = operations; }
    void repair() { operations_left_ = -1; }
    void ignore_sync() { sync_ignored_ = true; }

    void cut_power(unsigned seed)
    {
        std::mt19937 random(seed);
        for (auto &[name, file] : files_) {
            for (const Operation &operation : file->unsynced) {
                if (seed != 0 && random() % 2 == 0) {
                    Operation kept = operation;
                    if (random() % 4 == 0 && kept.bytes.size() > kSector) {
                        kept.bytes.resize(random() % (kept.bytes.size() / kSector) * kSector);
                    }
                    apply(file->synced, kept);
                }
            }
            file->unsynced.clear();
            file->current = file->synced;
        }
        shared_memory_.clear();
        repair();
    }

  private:
    static constexpr std::size_t kSector = 512;

    using Bytes = std::vector<std::uint8_t>;
    struct Operation {
        bool truncation = false;
        std::size_t at = 0; /* or the new length */
        Bytes bytes;
    };
    struct File {
        Bytes synced;
        Bytes current;
        std::vector<Operation> unsynced;
    };
    struct Handle { /* what SQLite allocates; starts as an sqlite3_file */
        sqlite3_file base;
        PowerVfs *vfs;
        File *file;
    };

    static void apply(Bytes &bytes, const Operation &operation)
    {
        if (operation.truncation) {
            bytes.resize(operation.at);
            return;
        }
        if (bytes.size() < operation.at + operation.bytes.size()) {
            bytes.resize(operation.at + operation.bytes.size());
        }
        std::copy(operation.bytes.begin(), operation.bytes.end(),
                  bytes.begin() + static_cast<std::ptrdiff_t>(operation.at));
    }

    bool fails()
    {
        if (operations_left_ > 0) {
            operations_left_--;
            return false;
        }
        return operations_left_ == 0;
    }

    static Handle &handle(sqlite3_file *file) { return *reinterpret_cast<Handle *>(file); }

    int change(File &file, Operation operation)
    {
        if (fails()) {
            return SQLITE_IOERR_WRITE;
        }
        apply(file.current, operation);
        file.unsynced.push_back(std::move(operation));
        return SQLITE_OK;
    }

    static int read_file(sqlite3_file *file, void *out, int len, sqlite3_int64 offset)
    {
        const Bytes &bytes = handle(file).file->current;
        const auto at = std::min(static_cast<std::size_t>(offset), bytes.size());
        const std::size_t got = std::min(static_cast<std::size_t>(len), bytes.size() - at);
        std::memset(out, 0, static_cast<std::size_t>(len));
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), got, static_cast<std::uint8_t *>(out));
        return got == static_cast<std::size_t>(len) ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
    }
    static int write_file(sqlite3_file *file, const void *in, int len, sqlite3_int64 offset)
    {
        const auto *bytes = static_cast<const std::uint8_t *>(in);
        return handle(file).vfs->change(*handle(file).file,
                                        {false, static_cast<std::size_t>(offset), {bytes, bytes + len}});
    }
    static int truncate_file(sqlite3_file *file, sqlite3_int64 len)
    {
        return handle(file).vfs->change(*handle(file).file, {true, static_cast<std::size_t>(len), {}});
    }
    static int sync_file(sqlite3_file *file, int)
    {
        PowerVfs &vfs = *handle(file).vfs;
        if (vfs.fails()) {
            return SQLITE_IOERR_FSYNC;
        }
        if (!vfs.sync_ignored_) {
            handle(file).file->synced = handle(file).file->current;
            handle(file).file->unsynced.clear();
        }
        return SQLITE_OK;
    }
    static int file_size(sqlite3_file *file, sqlite3_int64 *len)
    {
        *len = static_cast<sqlite3_int64>(handle(file).file->current.size());
        return SQLITE_OK;
    }
    static int close_file(sqlite3_file *) { return SQLITE_OK; }
    static int lock(sqlite3_file *, int) { return SQLITE_OK; }
    static int check_lock(sqlite3_file *, int *locked)
    {
        *locked = 0;
        return SQLITE_OK;
    }
    static int control(sqlite3_file *, int, void *) { return SQLITE_NOTFOUND; }
    static int sector_size(sqlite3_file *) { return kSector; }
    static int characteristics(sqlite3_file *) { return 0; }

    /* One process and one connection at a time: the WAL index is plain memory. */
    static int shm_map(sqlite3_file *file, int page, int len, int, void volatile **out)
    {
        auto &pages = handle(file).vfs->shared_memory_;
        while (pages.size() <= static_cast<std::size_t>(page)) {
            pages.push_back(std::make_unique<Bytes>(static_cast<std::size_t>(len), 0));
        }
        *out = pages[static_cast<std::size_t>(page)]->data();
        return SQLITE_OK;
    }
    static int shm_lock(sqlite3_file *, int, int, int) { return SQLITE_OK; }
    static void shm_barrier(sqlite3_file *) {}
    static int shm_unmap(sqlite3_file *file, int remove)
    {
        if (remove != 0) {
            handle(file).vfs->shared_memory_.clear();
        }
        return SQLITE_OK;
    }

    static int open_file(sqlite3_vfs *vfs, const char *name, sqlite3_file *file, int flags, int *out_flags)
    {
        static constexpr sqlite3_io_methods kMethods{
            2,        close_file,  read_file,  write_file, truncate_file, sync_file,       file_size,
            lock,     lock,        check_lock, control,    sector_size,   characteristics, shm_map,
            shm_lock, shm_barrier, shm_unmap,  nullptr,    nullptr};
        auto *self = static_cast<PowerVfs *>(vfs->pAppData);
        auto &files = self->files_;
        const std::string key = name == nullptr ? "temporary" + std::to_string(files.size()) : name;
        file->pMethods = nullptr;
        if (!files.contains(key)) {
            if ((flags & SQLITE_OPEN_CREATE) == 0 || self->operations_left_ == 0) {
                return SQLITE_CANTOPEN;
            }
            files[key] = std::make_unique<File>();
        }
        handle(file) = {{&kMethods}, self, files[key].get()};
        if (out_flags != nullptr) {
            *out_flags = flags;
        }
        return SQLITE_OK;
    }
    static int delete_file(sqlite3_vfs *vfs, const char *name, int)
    {
        auto *self = static_cast<PowerVfs *>(vfs->pAppData);
        if (self->fails()) {
            return SQLITE_IOERR_DELETE;
        }
        return self->files_.erase(name) > 0 ? SQLITE_OK : SQLITE_IOERR_DELETE_NOENT;
    }
    static int access_file(sqlite3_vfs *vfs, const char *name, int, int *found)
    {
        *found = static_cast<PowerVfs *>(vfs->pAppData)->files_.contains(name) ? 1 : 0;
        return SQLITE_OK;
    }
    static int full_pathname(sqlite3_vfs *, const char *name, int len, char *out)
    {
        sqlite3_snprintf(len, out, "%s", name);
        return SQLITE_OK;
    }

    std::string name_;
    sqlite3_vfs vfs_{};
    std::map<std::string, std::unique_ptr<File>> files_;
    std::vector<std::unique_ptr<Bytes>> shared_memory_;
    int operations_left_ = -1; /* negative: never fails */
    bool sync_ignored_ = false;
};

} // namespace tsr::test

#endif
