/* The sink's database. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/store.h"

#include <bit>
#include <limits>
#include <string>

#include "statement.h"
#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr std::int64_t kApplicationId = 0x54535231; /* "TSR1", in the file's header: sqlite.org/fileformat.html */
constexpr int kBusyTimeoutMs = 5000;

/* 64-bit times are stored bit by bit in SQLite's signed integers. */
constexpr const char *kSchema = "CREATE TABLE map ("
                                " arrival INTEGER PRIMARY KEY AUTOINCREMENT,"
                                " node INTEGER NOT NULL, counter INTEGER NOT NULL,"
                                " capture_time_us INTEGER NOT NULL, capture_id INTEGER NOT NULL,"
                                " kept INTEGER NOT NULL, mse_px2 REAL,"
                                " coded_map BLOB NOT NULL, coded_reference BLOB NOT NULL,"
                                " UNIQUE (node, counter));"
                                "CREATE INDEX map_by_arrival ON map (node, kept, arrival);"
                                "CREATE TABLE reservation (sealing_counter INTEGER NOT NULL);"
                                "INSERT INTO reservation VALUES (1);"
                                "CREATE TABLE site (pan_id INTEGER NOT NULL);";

/* Since version 2. */
constexpr const char *kEventSchema = "CREATE TABLE event ("
                                     " arrival INTEGER PRIMARY KEY AUTOINCREMENT,"
                                     " node INTEGER NOT NULL, counter INTEGER NOT NULL,"
                                     " capture_time_us INTEGER NOT NULL, capture_id INTEGER NOT NULL,"
                                     " rule INTEGER NOT NULL, kind INTEGER NOT NULL,"
                                     " share_q12 INTEGER NOT NULL, disparity_q8 INTEGER NOT NULL,"
                                     " UNIQUE (node, counter, rule));";
constexpr std::int64_t kVersionWithoutEvents = 1;

constexpr const char *kEventColumns =
    "SELECT node, counter, capture_time_us, capture_id, rule, kind, share_q12, disparity_q8 FROM event ";

constexpr const char *kMapColumns =
    "SELECT node, counter, capture_time_us, capture_id, kept, mse_px2, coded_map, coded_reference FROM map ";

StoredMap row_of(const Statement &statement)
{
    StoredMap map;
    map.node = static_cast<std::uint16_t>(statement.integer(0));
    map.counter = static_cast<std::uint32_t>(statement.integer(1));
    map.capture_time_us = std::bit_cast<std::uint64_t>(statement.integer(2));
    map.capture_id = static_cast<std::uint16_t>(statement.integer(3));
    map.kept = statement.integer(4) != 0;
    if (!statement.is_null(5)) {
        map.mse_px2 = statement.number(5);
    }
    map.coded_map = statement.bytes(6);
    map.coded_reference = statement.bytes(7);
    return map;
}

/* One more event of a message, begun if there is none. */
void add_row(const Statement &statement, std::optional<StoredEvents> &message)
{
    if (!message) {
        message.emplace();
        message->node = static_cast<std::uint16_t>(statement.integer(0));
        message->counter = static_cast<std::uint32_t>(statement.integer(1));
        message->capture_time_us = std::bit_cast<std::uint64_t>(statement.integer(2));
        message->capture_id = static_cast<std::uint16_t>(statement.integer(3));
    }
    message->events.push_back(
        {static_cast<std::uint8_t>(statement.integer(4)), static_cast<std::uint8_t>(statement.integer(5)),
         static_cast<std::uint16_t>(statement.integer(6)), static_cast<std::uint16_t>(statement.integer(7))});
}

std::int64_t single_integer(const Connection &connection, const char *sql)
{
    Statement statement(connection, sql);
    return statement.step() ? statement.integer(0) : 0;
}

void set_version(const Connection &connection)
{
    connection.execute(("PRAGMA user_version = " + std::to_string(Store::kSchemaVersion)).c_str());
}

void create_schema(const Connection &connection, std::uint16_t pan_id)
{
    connection.execute("BEGIN IMMEDIATE");
    connection.execute(kSchema);
    connection.execute(kEventSchema);
    Statement site(connection, "INSERT INTO site VALUES (?1)");
    site.bind(1, std::int64_t{pan_id}).step();
    connection.execute(("PRAGMA application_id = " + std::to_string(kApplicationId)).c_str());
    set_version(connection);
    connection.execute("COMMIT");
}

/* All of it or nothing: a power cut leaves a file of the old version. */
void bring_up_to_date(const Connection &connection)
{
    if (single_integer(connection, "PRAGMA user_version") == kVersionWithoutEvents) {
        connection.execute("BEGIN IMMEDIATE");
        connection.execute(kEventSchema);
        set_version(connection);
        connection.execute("COMMIT");
    }
}

void check_schema(const Connection &connection, const std::filesystem::path &file, std::uint16_t pan_id)
{
    if (single_integer(connection, "PRAGMA application_id") != kApplicationId) {
        throw InputError(file.string(), "application_id", "a database, but not a Tarsier sink's");
    }
    const std::int64_t version = single_integer(connection, "PRAGMA user_version");
    if (version != Store::kSchemaVersion && version != kVersionWithoutEvents) {
        throw InputError(file.string(), "user_version",
                         "schema version " + std::to_string(version) + ", this build knows " +
                             std::to_string(Store::kSchemaVersion));
    }
    const std::int64_t pan = single_integer(connection, "SELECT pan_id FROM site");
    if (pan != pan_id) {
        throw InputError(file.string(), "pan_id",
                         "holds the maps of PAN " + std::to_string(pan) + ", the site's is " + std::to_string(pan_id));
    }
}

/* Opened, checked and ready for statements. */
Connection &prepare(Connection &connection, const std::filesystem::path &file, std::uint16_t pan_id)
{
    sqlite3_busy_timeout(connection.get(), kBusyTimeoutMs);
    /* Nothing of somebody else's database is changed: it is checked first. */
    const bool is_new = single_integer(connection, "SELECT count(*) FROM sqlite_master") == 0;
    if (!is_new) {
        check_schema(connection, file, pan_id);
    }
    if (sqlite3_db_readonly(connection.get(), "main") == 1) {
        throw InputError(file.string(), "mode", "is read-only");
    }
    connection.execute("PRAGMA journal_mode = WAL");
    connection.execute("PRAGMA synchronous = FULL");
    if (is_new) {
        create_schema(connection, pan_id);
    } else {
        bring_up_to_date(connection);
    }
    return connection;
}

} // namespace

struct Store::Database {
    Database(const std::filesystem::path &file, std::uint16_t pan_id, int flags, const char *vfs)
        : connection(file, flags, vfs), ready(prepare(connection, file, pan_id)),
          insert(ready, "INSERT INTO map (node, counter, capture_time_us, capture_id, kept, mse_px2, coded_map,"
                        " coded_reference) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)"),
          find(ready, (std::string(kMapColumns) + "WHERE node = ?1 AND counter = ?2").c_str()),
          last_kept(ready,
                    (std::string(kMapColumns) + "WHERE node = ?1 AND kept = 1 ORDER BY arrival DESC LIMIT 1").c_str()),
          insert_event(ready, "INSERT INTO event (node, counter, capture_time_us, capture_id, rule, kind, share_q12,"
                              " disparity_q8) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)"),
          find_events(ready,
                      (std::string(kEventColumns) + "WHERE node = ?1 AND counter = ?2 ORDER BY arrival").c_str()),
          all_events(ready, (std::string(kEventColumns) + "ORDER BY arrival").c_str()),
          newest(ready, "SELECT counter FROM (SELECT counter FROM map WHERE node = ?1 ORDER BY arrival DESC LIMIT ?2)"
                        " UNION SELECT counter FROM"
                        " (SELECT counter FROM event WHERE node = ?1 GROUP BY counter ORDER BY max(arrival) DESC"
                        " LIMIT ?2) ORDER BY counter DESC"),
          all(ready, (std::string(kMapColumns) + "ORDER BY node, counter").c_str()),
          reserve(ready, "UPDATE reservation SET sealing_counter = sealing_counter + ?1 RETURNING sealing_counter")
    {
    }

    Connection connection;
    Connection &ready; /* the same, once the schema stands */
    Statement insert;
    Statement find;
    Statement last_kept;
    Statement insert_event;
    Statement find_events;
    Statement all_events;
    Statement newest;
    Statement all;
    Statement reserve;
};

Store::Store(const std::filesystem::path &file, std::uint16_t pan_id, Open open, const char *vfs)
{
    if (file.empty() || file.string().front() == ':') { /* SQLite's names for databases that are not on disk */
        throw InputError("--db", "file", "'" + file.string() + "' is no file");
    }
    const int flags = SQLITE_OPEN_READWRITE | (open == Open::create ? SQLITE_OPEN_CREATE : 0);
    try {
        database_ = std::make_unique<Database>(file, pan_id, flags, vfs);
    } catch (const StoreError &error) {
        throw InputError(file.string(), "SQLite", error.what());
    }
}

Store::~Store() = default;

void Store::begin()
{
    database_->connection.execute("BEGIN IMMEDIATE");
}

void Store::commit()
{
    database_->connection.execute("COMMIT");
}

void Store::rollback()
{
    /* SQLite may have rolled back by itself after an I/O error; then this fails and all is well. */
    sqlite3_exec(database_->connection.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

Insertion Store::insert(const StoredMap &map)
{
    if (const auto earlier = find(map.node, map.counter)) {
        const bool same = earlier->capture_time_us == map.capture_time_us && earlier->capture_id == map.capture_id &&
                          earlier->coded_map == map.coded_map && earlier->coded_reference == map.coded_reference;
        return same ? Insertion::already_stored : Insertion::counter_reused;
    }
    if (find_events(map.node, map.counter)) {
        return Insertion::counter_reused;
    }
    Statement &statement = database_->insert;
    statement.reset();
    statement.bind(1, std::int64_t{map.node})
        .bind(2, std::int64_t{map.counter})
        .bind(3, std::bit_cast<std::int64_t>(map.capture_time_us))
        .bind(4, std::int64_t{map.capture_id})
        .bind(5, std::int64_t{map.kept})
        .bind(7, map.coded_map)
        .bind(8, map.coded_reference);
    if (map.mse_px2) {
        statement.bind(6, *map.mse_px2);
    }
    statement.step();
    statement.reset();
    return Insertion::stored;
}

Insertion Store::insert(const StoredEvents &message)
{
    if (const auto earlier = find_events(message.node, message.counter)) {
        return *earlier == message ? Insertion::already_stored : Insertion::counter_reused;
    }
    if (find(message.node, message.counter)) {
        return Insertion::counter_reused;
    }
    Statement &statement = database_->insert_event;
    for (const StoredEvent &event : message.events) {
        statement.reset();
        statement.bind(1, std::int64_t{message.node})
            .bind(2, std::int64_t{message.counter})
            .bind(3, std::bit_cast<std::int64_t>(message.capture_time_us))
            .bind(4, std::int64_t{message.capture_id})
            .bind(5, std::int64_t{event.rule})
            .bind(6, std::int64_t{event.kind})
            .bind(7, std::int64_t{event.share_q12})
            .bind(8, std::int64_t{event.disparity_q8})
            .step();
    }
    statement.reset();
    return Insertion::stored;
}

std::optional<StoredEvents> Store::find_events(std::uint16_t node, std::uint32_t counter) const
{
    Statement &statement = database_->find_events;
    statement.reset();
    statement.bind(1, std::int64_t{node}).bind(2, std::int64_t{counter});
    std::optional<StoredEvents> message;
    while (statement.step()) {
        add_row(statement, message);
    }
    statement.reset();
    return message;
}

void Store::for_each_events(const std::function<void(const StoredEvents &)> &visit) const
{
    Statement &statement = database_->all_events;
    statement.reset();
    std::optional<StoredEvents> message;
    while (statement.step()) { /* the events of a message arrived one after the other */
        if (message && (message->node != statement.integer(0) || message->counter != statement.integer(1))) {
            visit(*message);
            message.reset();
        }
        add_row(statement, message);
    }
    statement.reset();
    if (message) {
        visit(*message);
    }
}

std::optional<StoredMap> Store::find(std::uint16_t node, std::uint32_t counter) const
{
    Statement &statement = database_->find;
    statement.reset();
    std::optional<StoredMap> map;
    if (statement.bind(1, std::int64_t{node}).bind(2, std::int64_t{counter}).step()) {
        map = row_of(statement);
    }
    statement.reset();
    return map;
}

std::optional<StoredMap> Store::last_kept(std::uint16_t node) const
{
    Statement &statement = database_->last_kept;
    statement.reset();
    std::optional<StoredMap> map;
    if (statement.bind(1, std::int64_t{node}).step()) {
        map = row_of(statement);
    }
    statement.reset();
    return map;
}

std::vector<std::uint32_t> Store::newest_counters(std::uint16_t node, int count) const
{
    Statement &statement = database_->newest;
    statement.reset();
    statement.bind(1, std::int64_t{node}).bind(2, std::int64_t{count});
    std::vector<std::uint32_t> counters;
    while (statement.step()) {
        counters.push_back(static_cast<std::uint32_t>(statement.integer(0)));
    }
    statement.reset();
    return counters;
}

void Store::for_each(const std::function<void(const StoredMap &)> &visit) const
{
    Statement &statement = database_->all;
    statement.reset();
    while (statement.step()) {
        visit(row_of(statement));
    }
    statement.reset();
}

std::uint32_t Store::take_sealing_counter()
{
    if (counters_left_ == 0) {
        if (sqlite3_get_autocommit(database_->connection.get()) == 0) {
            throw std::logic_error("Store::take_sealing_counter: inside a transaction");
        }
        Statement &statement = database_->reserve;
        statement.reset();
        const bool row = statement.bind(1, std::int64_t{kReservedAhead}).step();
        const std::int64_t end = row ? statement.integer(0) : 0;
        while (statement.step()) {
            /* The statement commits when it has run to its end. */
        }
        statement.reset();
        if (end <= kReservedAhead || end > std::numeric_limits<std::uint32_t>::max()) {
            throw StoreError("the sealing counter is exhausted; the site needs new keys");
        }
        next_counter_ = static_cast<std::uint32_t>(end) - kReservedAhead;
        counters_left_ = kReservedAhead;
    }
    counters_left_--;
    return next_counter_++;
}

} // namespace tsr
