/*
 * What the sink has received, in SQLite: a map is acknowledged only after the
 * transaction that holds it reached the disk (WAL, synchronous = FULL), so that
 * neither a kill nor a power cut loses anything acknowledged.
 *
 *   map          one row per message, unique by (node, counter)
 *   event        one row per event of a depth rule, several may share a message
 *   reservation  the sink's own sealing counter, reserved 1000 ahead: a counter
 *                is handed out only after its block was committed, and a new
 *                process begins with the next block, so no nonce comes twice
 *   site         the PAN the file belongs to
 *
 * Any number of processes may read the file meanwhile. One thread per object.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_STORE_H
#define TSR_SINK_STORE_H

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace tsr
{

/* The database failed while in use: disk full, file lost, I/O error. */
class StoreError : public std::runtime_error
{
  public:
    using std::runtime_error::runtime_error;
};

struct StoredMap {
    std::uint16_t node = 0;
    std::uint32_t counter = 0;         /* of the message, given by the node */
    std::uint64_t capture_time_us = 0; /* the node's clock */
    std::uint16_t capture_id = 0;
    bool kept = false;             /* not similar to the pair's last kept map */
    std::optional<double> mse_px2; /* against that map; nothing for a pair's first */
    std::vector<std::uint8_t> coded_map;
    std::vector<std::uint8_t> coded_reference; /* empty: none came */
};

struct StoredEvent {
    std::uint8_t rule = 0; /* of the pair's zones, in the order of site.toml */
    std::uint8_t kind = 0; /* enum tsr_event_kind */
    std::uint16_t share_q12 = 0;
    std::uint16_t disparity_q8 = 0; /* px, without d0; TSR_EVENT_NO_DISPARITY: none */
    bool operator==(const StoredEvent &) const = default;
};

struct StoredEvents { /* of one message, tsr/wire/body.h */
    std::uint16_t node = 0;
    std::uint32_t counter = 0;
    std::uint64_t capture_time_us = 0; /* the node's clock */
    std::uint16_t capture_id = 0;
    std::vector<StoredEvent> events;
    bool operator==(const StoredEvents &) const = default;
};

enum class Insertion {
    stored,
    already_stored, /* the same message came before */
    counter_reused  /* another message has this node and counter; nothing stored */
};

class Store
{
  public:
    static constexpr int kSchemaVersion = 2; /* 1 had no events; such a file is brought up to date */
    static constexpr std::uint32_t kReservedAhead = 1000;

    enum class Open {
        create,  /* make the file if there is none */
        existing /* refuse if there is none */
    };

    /* Throws InputError: not a database, another schema version, another PAN,
     * not writable. vfs names an SQLite VFS (tests), null = the system's. */
    Store(const std::filesystem::path &file, std::uint16_t pan_id, Open open = Open::create, const char *vfs = nullptr);
    Store(const Store &) = delete;
    Store &operator=(const Store &) = delete;
    ~Store();

    /* One transaction for many maps. Everything below throws StoreError. */
    void begin();
    void commit();   /* returned: the maps are on disk */
    void rollback(); /* nothing since begin() stays; never throws */

    Insertion insert(const StoredMap &map);
    Insertion insert(const StoredEvents &message);
    std::optional<StoredMap> find(std::uint16_t node, std::uint32_t counter) const;
    std::optional<StoredEvents> find_events(std::uint16_t node, std::uint32_t counter) const;
    /* The newest kept map of a node, by arrival. */
    std::optional<StoredMap> last_kept(std::uint16_t node) const;
    /* Counters of a node's newest maps and of its newest event messages, so many of each, highest first. */
    std::vector<std::uint32_t> newest_counters(std::uint16_t node, int count) const;
    /* Every message of events, in the order of arrival. */
    void for_each_events(const std::function<void(const StoredEvents &)> &visit) const;
    /* Every map, ordered by node and counter. */
    void for_each(const std::function<void(const StoredMap &)> &visit) const;

    /* The next counter to seal with, used by nobody before or after. Not inside a transaction. */
    std::uint32_t take_sealing_counter();

  private:
    struct Database;
    std::unique_ptr<Database> database_;
    std::uint32_t next_counter_ = 0;
    std::uint32_t counters_left_ = 0;
};

} // namespace tsr

#endif
