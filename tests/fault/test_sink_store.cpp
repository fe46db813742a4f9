/*
 * Power cuts under the store: SQLite runs on a file system in memory that
 * forgets, or keeps a random half of, everything that was not synced. The power
 * fails at every single operation of a run; whatever was acknowledged before
 * must be there after it, and no sealing counter may come twice.
 *
 * Replay one case: --gtest_filter=... prints "operation N, seed S" on failure.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <set>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "test_sink_messages.h"
#include "test_sink_power_vfs.h"
#include "tsr/sink/receiver.h"

namespace tsr
{
namespace
{

using test::Bytes;
using test::PowerVfs;

constexpr std::uint16_t kPan = 0xbeef;
constexpr int kBatches = 6;

/* What a run has promised before the power failed. */
struct Promises {
    std::vector<std::uint32_t> acknowledged;
    std::set<std::uint32_t> sealed;
    bool finished = false;
};

StoredMap map_of(std::uint32_t counter)
{
    StoredMap map;
    map.node = 3;
    map.counter = counter;
    map.coded_map.assign(3000, static_cast<std::uint8_t>(counter)); /* more than one page */
    return map;
}

/* Batches of maps, each acknowledged after its commit; counters taken in between. */
void run_store(const PowerVfs &vfs, std::uint32_t first_counter, Promises &promises)
{
    try {
        Store store("sink.db", kPan, Store::Open::create, vfs.name());
        for (std::uint32_t batch = 0; batch < kBatches; batch++) {
            store.begin();
            store.insert(map_of(first_counter + 2 * batch));
            store.insert(map_of(first_counter + 2 * batch + 1));
            store.commit();
            promises.acknowledged.push_back(first_counter + 2 * batch);
            promises.acknowledged.push_back(first_counter + 2 * batch + 1);
            const std::uint32_t counter = store.take_sealing_counter();
            EXPECT_TRUE(promises.sealed.insert(counter).second) << "sealing counter " << counter << " came twice";
        }
        promises.finished = true;
    } catch (const StoreError &) {
    } catch (const InputError &) {
    }
}

/* Maps acknowledged and gone; the store must open. */
std::size_t count_lost(const PowerVfs &vfs, const Promises &promises)
{
    const Store store("sink.db", kPan, Store::Open::create, vfs.name());
    std::size_t lost = 0;
    for (const std::uint32_t counter : promises.acknowledged) {
        const auto map = store.find(3, counter);
        lost += !map || map->coded_map != map_of(counter).coded_map ? 1 : 0;
    }
    return lost;
}

TEST(SinkStorePower, NothingAcknowledgedIsLostAtAnyOperation)
{
    bool finished = false;
    int operation = 0;
    for (; !finished; operation++) {
        for (unsigned seed = 0; seed < 4; seed++) {
            PowerVfs vfs;
            Promises promises;
            vfs.fail_after(operation);
            run_store(vfs, 1, promises);
            vfs.cut_power(seed); /* seed 0 keeps nothing unsynced, others a random part */
            ASSERT_EQ(count_lost(vfs, promises), 0u) << "operation " << operation << ", seed " << seed;
            finished = promises.finished;
            promises.finished = false;
            run_store(vfs, 1000, promises); /* goes on with the same file */
            ASSERT_TRUE(promises.finished) << "operation " << operation << ", seed " << seed;
        }
    }
    EXPECT_GT(operation, 30);
}

/* The test itself: on a disk that ignores fsync, acknowledged maps are lost. */
TEST(SinkStorePower, ADiskThatLiesIsNoticed)
{
    PowerVfs vfs;
    Promises promises;
    vfs.ignore_sync();
    run_store(vfs, 1, promises);
    ASSERT_TRUE(promises.finished);
    vfs.cut_power(0);
    EXPECT_EQ(count_lost(vfs, promises), promises.acknowledged.size());
}

/* A COMMITTED status leaves the receiver only for what survives a power cut. */
TEST(SinkStorePower, TheReceiverAcknowledgesOnlyWhatIsOnDisk)
{
    const Site site = test::small_site();
    const KeyRing keys = derive_test_keys(1, site);
    const Bytes body = test::map_body(test::code_map(test::flat_map(site.pairs[0], 64)),
                                      test::code_reference(test::textured_image(site.pairs[0])));
    int committed_in_all = 0;
    int failed_in_all = 0;
    for (int operation = 0; operation < 60; operation++) {
        PowerVfs vfs;
        std::vector<std::uint32_t> committed;
        {
            Store store("sink.db", site.pan_id, Store::Open::create, vfs.name());
            Receiver receiver(site, keys, store);
            vfs.fail_after(operation);
            for (std::uint32_t counter = 1; counter <= 5; counter++) {
                const auto answers = receiver.receive(test::map_fragments(keys, 3, counter, body));
                const Bytes &last = answers.back();
                if (!last.empty() && test::open_status(keys, 3, last).state == TSR_DELIVERY_COMMITTED) {
                    committed.push_back(counter);
                }
            }
            failed_in_all += receiver.tally().count(Cause::store_failed) > 0 ? 1 : 0;
        }
        vfs.cut_power(0);
        const Store store("sink.db", site.pan_id, Store::Open::create, vfs.name());
        for (const std::uint32_t counter : committed) {
            EXPECT_TRUE(store.find(3, counter).has_value()) << "operation " << operation << ", counter " << counter;
        }
        committed_in_all += static_cast<int>(committed.size());
    }
    EXPECT_GT(committed_in_all, 0);
    EXPECT_GT(failed_in_all, 0);
}

/* The disk fails for a while (it is full, say); later the node asks again and gets its answer. */
TEST(SinkStorePower, TheReceiverRecoversWhenTheDiskDoes)
{
    const Site site = test::small_site();
    const KeyRing keys = derive_test_keys(1, site);
    const Bytes body = test::map_body(test::code_map(test::flat_map(site.pairs[0], 64)), {});
    PowerVfs vfs;
    Store store("sink.db", site.pan_id, Store::Open::create, vfs.name());
    Receiver receiver(site, keys, store);
    const auto fragments = test::map_fragments(keys, 3, 1, body);
    vfs.fail_after(0);
    EXPECT_TRUE(receiver.receive(fragments).back().empty());
    EXPECT_GT(receiver.tally().count(Cause::store_failed), 0u);
    vfs.repair();
    const auto answers = receiver.receive(fragments);
    ASSERT_FALSE(answers.back().empty());
    EXPECT_EQ(test::open_status(keys, 3, answers.back()).state, TSR_DELIVERY_COMMITTED);
    EXPECT_TRUE(store.find(3, 1)->kept);
}

} // namespace
} // namespace tsr
