/* The store: idempotence, reservations, refusals. SPDX-License-Identifier: Apache-2.0 */
#include <set>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "test_host_folder.h"
#include "tsr/sink/store.h"

namespace tsr
{
namespace
{

using test::Folder;

StoredMap map_of(std::uint16_t node, std::uint32_t counter, std::uint8_t fill)
{
    StoredMap map;
    map.node = node;
    map.counter = counter;
    map.capture_time_us = ~std::uint64_t{0} - counter;
    map.capture_id = 65535;
    map.kept = fill % 2 == 1;
    map.mse_px2 = 0.125 * fill;
    map.coded_map.assign(100, fill);
    return map;
}

void execute(const std::filesystem::path &file, const char *sql)
{
    sqlite3 *handle = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &handle), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(handle);
    sqlite3_close(handle);
}

TEST(SinkStore, KeepsEveryFieldAcrossReopen)
{
    const Folder folder;
    StoredMap first = map_of(3, 0xffffffff, 1);
    first.coded_reference = {1, 2, 3};
    first.mse_px2.reset();
    {
        Store store(folder / "a.db", 0xbeef);
        store.begin();
        EXPECT_EQ(store.insert(first), Insertion::stored);
        store.commit();
    }
    const Store store(folder / "a.db", 0xbeef);
    const auto read = store.find(3, 0xffffffff);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->capture_time_us, first.capture_time_us);
    EXPECT_EQ(read->capture_id, 65535);
    EXPECT_TRUE(read->kept);
    EXPECT_FALSE(read->mse_px2.has_value());
    EXPECT_EQ(read->coded_map, first.coded_map);
    EXPECT_EQ(read->coded_reference, first.coded_reference);
    EXPECT_FALSE(store.find(3, 1).has_value());
}

TEST(SinkStore, InsertingTwiceChangesNothing)
{
    const Folder folder;
    Store store(folder / "a.db", 1);
    EXPECT_EQ(store.insert(map_of(3, 1, 1)), Insertion::stored);
    EXPECT_EQ(store.insert(map_of(3, 1, 1)), Insertion::already_stored);
    EXPECT_EQ(store.insert(map_of(3, 1, 2)), Insertion::counter_reused);
    EXPECT_EQ(store.find(3, 1)->coded_map[0], 1);
    EXPECT_EQ(store.insert(map_of(4, 1, 2)), Insertion::stored);
}

TEST(SinkStore, OrdersByArrivalAndByKey)
{
    const Folder folder;
    Store store(folder / "a.db", 1);
    store.insert(map_of(5, 9, 1));
    store.insert(map_of(3, 7, 3));
    store.insert(map_of(3, 2, 5));
    store.insert(map_of(3, 8, 4));
    EXPECT_EQ(store.last_kept(3)->counter, 2u);
    EXPECT_EQ(store.newest_counters(3, 2), (std::vector<std::uint32_t>{8, 2}));
    std::vector<std::uint32_t> order;
    store.for_each([&](const StoredMap &map) { order.push_back(map.counter); });
    EXPECT_EQ(order, (std::vector<std::uint32_t>{2, 7, 8, 9}));
    EXPECT_FALSE(store.last_kept(9).has_value());
}

StoredEvents events_of(std::uint16_t node, std::uint32_t counter, std::uint8_t count)
{
    StoredEvents message;
    message.node = node;
    message.counter = counter;
    message.capture_time_us = ~std::uint64_t{0} - counter;
    message.capture_id = 65535;
    for (std::uint8_t i = 0; i < count; i++) {
        message.events.push_back({i, 2, 4096, static_cast<std::uint16_t>(65535 - i)});
    }
    return message;
}

std::vector<StoredEvents> events_in(const Store &store)
{
    std::vector<StoredEvents> all;
    store.for_each_events([&](const StoredEvents &message) { all.push_back(message); });
    return all;
}

TEST(SinkStore, KeepsEventsInTheOrderOfArrival)
{
    const Folder folder;
    const std::vector<StoredEvents> wanted = {events_of(5, 0xffffffff, 8), events_of(3, 9, 1), events_of(3, 4, 2)};
    {
        Store store(folder / "a.db", 1);
        store.begin();
        for (const StoredEvents &message : wanted) {
            EXPECT_EQ(store.insert(message), Insertion::stored);
        }
        store.commit();
        EXPECT_EQ(store.insert(wanted[0]), Insertion::already_stored);
        EXPECT_EQ(store.insert(events_of(5, 0xffffffff, 7)), Insertion::counter_reused);
    }
    const Store store(folder / "a.db", 1);
    EXPECT_EQ(events_in(store), wanted);
    EXPECT_EQ(store.find_events(3, 4), wanted[2]);
    EXPECT_FALSE(store.find_events(3, 5).has_value());
}

/* A counter is one message's, whatever its kind. */
TEST(SinkStore, MapsAndEventsShareTheirCounters)
{
    const Folder folder;
    Store store(folder / "a.db", 1);
    store.insert(map_of(3, 7, 1));
    store.insert(events_of(3, 8, 8));
    store.insert(map_of(3, 9, 2));
    store.insert(events_of(4, 20, 1));
    EXPECT_EQ(store.insert(events_of(3, 7, 1)), Insertion::counter_reused);
    EXPECT_EQ(store.insert(map_of(3, 8, 1)), Insertion::counter_reused);
    EXPECT_EQ(store.newest_counters(3, 2), (std::vector<std::uint32_t>{9, 8, 7}));
    EXPECT_EQ(store.newest_counters(3, 1), (std::vector<std::uint32_t>{9, 8}));
}

/* A file that an earlier build wrote loses nothing and can hold events. */
TEST(SinkStore, AFileWithoutEventsIsBroughtUpToDate)
{
    const Folder folder;
    {
        Store store(folder / "a.db", 1);
        store.insert(map_of(3, 7, 1));
    }
    execute(folder / "a.db", "DROP TABLE event; PRAGMA user_version = 1");
    Store store(folder / "a.db", 1);
    EXPECT_TRUE(store.find(3, 7).has_value());
    EXPECT_EQ(store.insert(events_of(3, 8, 2)), Insertion::stored);
    EXPECT_EQ(events_in(store).size(), 1u);
}

TEST(SinkStore, RollbackForgets)
{
    const Folder folder;
    Store store(folder / "a.db", 1);
    store.begin();
    store.insert(map_of(3, 1, 1));
    store.rollback();
    EXPECT_FALSE(store.find(3, 1).has_value());
    store.begin();
    store.insert(map_of(3, 1, 1));
    store.commit();
    EXPECT_TRUE(store.find(3, 1).has_value());
}

TEST(SinkStore, SealingCountersNeverComeTwice)
{
    const Folder folder;
    std::set<std::uint32_t> taken;
    for (int run = 0; run < 3; run++) {
        Store store(folder / "a.db", 1);
        for (std::uint32_t i = 0; i < 1500; i++) {
            EXPECT_TRUE(taken.insert(store.take_sealing_counter()).second);
        }
        Store second(folder / "a.db", 1); /* even if two sinks run by mistake */
        EXPECT_TRUE(taken.insert(second.take_sealing_counter()).second);
    }
    EXPECT_EQ(*taken.begin(), 1u);
    Store store(folder / "a.db", 1);
    store.begin();
    EXPECT_THROW(store.take_sealing_counter(), std::logic_error);
}

TEST(SinkStore, AWornOutCounterIsAnError)
{
    const Folder folder;
    {
        Store store(folder / "a.db", 1);
    }
    execute(folder / "a.db", "UPDATE reservation SET sealing_counter = 4294966800");
    Store store(folder / "a.db", 1);
    EXPECT_THROW(store.take_sealing_counter(), StoreError);
    EXPECT_THROW(store.take_sealing_counter(), StoreError);
}

TEST(SinkStore, RefusesOtherFiles)
{
    const Folder folder;
    const auto text = folder.put("text.db", std::string(5000, 'x'));
    EXPECT_REFUSED(Store(text, 1), "text.db: SQLite: file is not a database");
    EXPECT_REFUSED(Store(folder / "absent.db", 1, Store::Open::existing), "absent.db: SQLite: unable to open");
    EXPECT_FALSE(std::filesystem::exists(folder / "absent.db"));
    EXPECT_REFUSED(Store(folder / "no/folder.db", 1), "folder.db: SQLite: unable to open");
    execute(folder / "other.db", "CREATE TABLE a (b)");
    EXPECT_REFUSED(Store(folder / "other.db", 1), "application_id: a database, but not a Tarsier sink's");
    {
        Store store(folder / "a.db", 0xbeef);
    }
    EXPECT_REFUSED(Store(folder / "a.db", 0xcafe), "pan_id: holds the maps of PAN 48879, the site's is 51966");
    execute(folder / "a.db", "PRAGMA user_version = 3");
    EXPECT_REFUSED(Store(folder / "a.db", 0xbeef), "schema version 3, this build knows 2");
}

} // namespace
} // namespace tsr
