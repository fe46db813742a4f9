/* Fragments in, statuses out, maps stored. SPDX-License-Identifier: Apache-2.0 */
#include <random>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "test_sink_messages.h"
#include "tsr/sink/receiver.h"

extern "C" {
#include "tsr/codec/gray.h"
}

namespace tsr
{
namespace
{

using test::Bytes;

class SinkReceiver : public ::testing::Test
{
  protected:
    SinkReceiver() { restart(); }

    void restart()
    {
        receiver.reset();
        store.reset();
        store = std::make_unique<Store>(folder / "a.db", site.pan_id);
        receiver = std::make_unique<Receiver>(site, keys, *store);
        receiver->on_map([this](const MapReport &report) { reports.push_back(report); });
    }

    const SitePair &porch() const { return site.pairs[0]; }

    Bytes body_of(std::uint16_t disparity_q4, bool reference = true) const
    {
        return test::map_body(test::code_map(test::flat_map(porch(), disparity_q4)),
                              reference ? test::code_reference(test::textured_image(porch())) : Bytes{});
    }

    /* The answers to fragments one by one. */
    std::vector<Bytes> feed(const std::vector<Bytes> &fragments)
    {
        std::vector<Bytes> answers;
        for (const Bytes &fragment : fragments) {
            answers.push_back(receiver->receive(std::vector<Bytes>{fragment})[0]);
        }
        return answers;
    }

    int state_of(const Bytes &answer, std::uint16_t node = 3) const
    {
        return answer.empty() ? 0 : test::open_status(keys, node, answer).state;
    }

    std::uint64_t refused(Cause cause) const { return receiver->tally().count(cause); }

    const test::Folder folder;
    const Site site = test::small_site();
    const KeyRing keys = derive_test_keys(1, site);
    std::unique_ptr<Store> store;
    std::unique_ptr<Receiver> receiver;
    std::vector<MapReport> reports;
};

TEST_F(SinkReceiver, AWholeMapIsStoredThenCommitted)
{
    const auto fragments = test::map_fragments(keys, 3, 70000, body_of(64));
    ASSERT_GE(fragments.size(), 2u);
    const auto answers = feed(fragments);
    for (std::size_t i = 0; i + 1 < answers.size(); i++) {
        EXPECT_TRUE(answers[i].empty());
    }
    const tsr_body_status status = test::open_status(keys, 3, answers.back());
    EXPECT_EQ(status.state, TSR_DELIVERY_COMMITTED);
    EXPECT_EQ(status.message_id, 70000 % 65536);
    const auto stored = store->find(3, 70000);
    ASSERT_TRUE(stored.has_value());
    EXPECT_TRUE(stored->kept);
    EXPECT_EQ(stored->capture_time_us, 1000u);
    EXPECT_EQ(decode_map(stored->coded_map)->disparity_q4[5], 64);
    EXPECT_EQ(stored->coded_reference, test::code_reference(test::textured_image(porch())));
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(reports[0].pair, "porch");
}

TEST_F(SinkReceiver, MissingFragmentsAreNamed)
{
    const auto fragments = test::map_fragments(keys, 3, 5, body_of(64));
    auto some = fragments;
    some.erase(some.begin());
    const auto answers = feed(some);
    const tsr_body_status status = test::open_status(keys, 3, answers.back());
    EXPECT_EQ(status.state, TSR_DELIVERY_MISSING);
    EXPECT_EQ(status.message_id, 5);
    EXPECT_EQ(status.first, 0);
    ASSERT_EQ(status.bitmap_len, (fragments.size() + 7) / 8);
    EXPECT_EQ(status.bitmap[0], 1);
    EXPECT_EQ(state_of(feed({fragments[0]})[0]), TSR_DELIVERY_COMMITTED); /* complete, though it does not poll */
}

TEST_F(SinkReceiver, OrderAndRepetitionDoNotMatter)
{
    auto fragments = test::map_fragments(keys, 3, 5, body_of(64));
    std::mt19937 random(1);
    fragments.insert(fragments.end(), fragments.begin(), fragments.end());
    std::shuffle(fragments.begin(), fragments.end(), random);
    feed(fragments);
    EXPECT_TRUE(store->find(3, 5).has_value());
    EXPECT_EQ(reports.size(), 1u);
}

TEST_F(SinkReceiver, ARepeatedMessageIsAcknowledgedAgainAlsoAfterARestart)
{
    const auto fragments = test::map_fragments(keys, 3, 5, body_of(64));
    feed(fragments);
    EXPECT_EQ(state_of(feed({fragments.back()})[0]), TSR_DELIVERY_COMMITTED);
    restart();
    EXPECT_EQ(state_of(feed({fragments.back()})[0]), TSR_DELIVERY_COMMITTED);
    EXPECT_EQ(receiver->repeated(), 1u);
    /* So old that only the store remembers it. */
    for (std::uint32_t counter = 6; counter < 30; counter++) {
        feed(test::map_fragments(keys, 3, counter, body_of(64, false)));
    }
    const std::size_t before = reports.size();
    EXPECT_EQ(state_of(feed(fragments).back()), TSR_DELIVERY_COMMITTED);
    EXPECT_EQ(reports.size(), before);
}

TEST_F(SinkReceiver, OneBatchOneCommit)
{
    std::vector<Bytes> batch;
    for (std::uint32_t counter = 1; counter <= 3; counter++) {
        const auto fragments = test::map_fragments(keys, 3, counter, body_of(64));
        batch.insert(batch.end(), fragments.begin(), fragments.end());
        batch.push_back(fragments.back()); /* polls again before the commit */
    }
    int committed = 0;
    for (const Bytes &answer : receiver->receive(batch)) {
        committed += state_of(answer) == TSR_DELIVERY_COMMITTED ? 1 : 0;
    }
    EXPECT_EQ(committed, 6);
    EXPECT_TRUE(store->find(3, 3).has_value());
    EXPECT_FALSE(store->find(3, 3)->kept); /* equal to the first */
    EXPECT_EQ(*store->find(3, 3)->mse_px2, 0.0);
}

TEST_F(SinkReceiver, TwoMessagesOfOneNodeMayOverlap)
{
    const auto first = test::map_fragments(keys, 3, 1, body_of(64));
    const auto second = test::map_fragments(keys, 3, 2, body_of(128));
    std::vector<Bytes> mixed;
    for (std::size_t i = 0; i < std::max(first.size(), second.size()); i++) {
        if (i < first.size()) {
            mixed.push_back(first[i]);
        }
        if (i < second.size()) {
            mixed.push_back(second[i]);
        }
    }
    feed(mixed);
    EXPECT_TRUE(store->find(3, 1).has_value());
    EXPECT_TRUE(store->find(3, 2).has_value());
    EXPECT_EQ(refused(Cause::message_abandoned), 0u);
    feed({test::map_fragments(keys, 3, 3, body_of(64))[0]});
    feed({test::map_fragments(keys, 3, 4, body_of(64))[0]});
    feed({test::map_fragments(keys, 3, 5, body_of(64))[0]});
    EXPECT_EQ(refused(Cause::message_abandoned), 1u);
}

TEST_F(SinkReceiver, AChangedFragmentIsAskedForAgain)
{
    const auto good = test::map_fragments(keys, 3, 5, body_of(64));
    auto bad = good;
    bad[0][20] ^= 1;
    EXPECT_EQ(state_of(feed(bad).back()), TSR_DELIVERY_MISSING);
    EXPECT_EQ(refused(Cause::not_authentic), 1u);
    EXPECT_EQ(state_of(feed(good).back()), TSR_DELIVERY_COMMITTED);
}

TEST_F(SinkReceiver, WrongKeyUnknownNodeAndOtherDestinationStoreNothing)
{
    const KeyRing others = derive_test_keys(2, site);
    feed(test::map_fragments(others, 3, 5, body_of(64)));
    EXPECT_EQ(refused(Cause::not_authentic), 1u);
    const Bytes message = test::seal({TSR_MESSAGE_MAP, TSR_KEY_NODE, 77, 0, 5}, *keys.node_key(3), body_of(64));
    EXPECT_EQ(state_of(feed(test::fragments_of(message, 77, 5)).back()), 0);
    EXPECT_GT(refused(Cause::unknown_node), 0u);
    feed(test::fragments_of(message, 3, 5, 2));
    EXPECT_GT(refused(Cause::other_destination), 0u);
    /* Node 4's genuine message under node 3's name. */
    const Bytes stolen = test::seal({TSR_MESSAGE_MAP, TSR_KEY_NODE, 4, 0, 6}, *keys.node_key(4), body_of(64));
    feed(test::fragments_of(stolen, 3, 6));
    EXPECT_EQ(refused(Cause::not_authentic), 2u);
    std::size_t stored = 0;
    store->for_each([&](const StoredMap &) { stored++; });
    EXPECT_EQ(stored, 0u);
}

TEST_F(SinkReceiver, AuthenticButUselessMessagesAreRefused)
{
    const auto refuse = [&](std::uint16_t node, std::uint32_t counter, const Bytes &body, Cause cause) {
        const std::uint64_t before = refused(cause);
        EXPECT_EQ(state_of(feed(test::map_fragments(keys, node, counter, body)).back(), node), TSR_DELIVERY_REFUSED)
            << cause_name(cause);
        EXPECT_EQ(refused(cause), before + 1) << cause_name(cause);
    };
    const Bytes good_map = test::code_map(test::flat_map(porch(), 64));
    refuse(4, 1, body_of(64), Cause::no_pair); /* a wing sends no maps */
    refuse(3, 1, Bytes(5, 0), Cause::body_format);
    refuse(3, 2, test::map_body(Bytes(50, 0xff), {}), Cause::map_format);
    refuse(3, 3, test::map_body(good_map, Bytes(50, 0xff)), Cause::reference_format);
    refuse(3, 4, test::map_body(good_map, test::code_reference(test::textured_image(site.pairs[1]))),
           Cause::reference_format);
    refuse(3, 8, test::map_body(good_map, test::code_reference(test::textured_image(porch()), TSR_PICTURE_PRIOR_NONE)),
           Cause::reference_format);
    const Bytes gray_image{TSR_GRAY_FORMAT_VERSION, 4, 32, 0, 24, 0}; /* of the porch's size, whole */
    refuse(3, 9, test::map_body(good_map, gray_image), Cause::reference_format);
    refuse(3, 5, test::map_body(test::code_map(test::flat_map(site.pairs[1], 64)), {}), Cause::other_settings);
    DecodedMap other_offset = test::flat_map(porch(), 64);
    other_offset.info.d0_q4 = static_cast<std::int16_t>(other_offset.info.d0_q4 + 2);
    refuse(3, 6, test::map_body(test::code_map(other_offset), {}), Cause::other_settings);
    feed(test::map_fragments(keys, 3, 7, body_of(64)));
    restart();
    for (std::uint32_t counter = 100; counter < 120; counter++) { /* push 7 out of the short memory */
        feed(test::map_fragments(keys, 3, counter, body_of(64, false)));
    }
    refuse(3, 7, body_of(128), Cause::counter_reused);
}

TEST_F(SinkReceiver, ATruncatedMapIsRefused)
{
    DecodedMap map = test::flat_map(porch(), 64);
    for (std::size_t i = 0; i < map.disparity_q4.size(); i++) {
        map.disparity_q4[i] = static_cast<std::uint16_t>(4 * (i * 7919 % 60));
    }
    Bytes coded = test::code_map(map);
    coded.resize(5); /* inside the header */
    EXPECT_EQ(state_of(feed(test::map_fragments(keys, 3, 1, test::map_body(coded, {}))).back()), TSR_DELIVERY_REFUSED);
    EXPECT_EQ(refused(Cause::map_format), 1u);
}

TEST_F(SinkReceiver, OtherKindsAndKeyUsesAreNoMaps)
{
    for (const tsr_message_header &header : {tsr_message_header{TSR_MESSAGE_VIEW, TSR_KEY_NODE, 3, 0, 5},
                                             tsr_message_header{TSR_MESSAGE_MAP, TSR_KEY_PAIR, 3, 0, 5}}) {
        feed(test::fragments_of(test::seal(header, *keys.node_key(3), body_of(64)), 3, 5));
    }
    EXPECT_EQ(refused(Cause::message_format), 2u);
    const Bytes message = test::seal({TSR_MESSAGE_MAP, TSR_KEY_NODE, 3, 0, 5}, *keys.node_key(3), body_of(64));
    feed(test::fragments_of(message, 3, 9)); /* an id that is not the counter's */
    EXPECT_EQ(refused(Cause::message_format), 3u);
}

TEST_F(SinkReceiver, NoBytesStopIt)
{
    std::mt19937 random(7);
    for (int i = 0; i < 20000; i++) {
        Bytes bytes(random() % 110);
        for (std::uint8_t &byte : bytes) {
            byte = static_cast<std::uint8_t>(random());
        }
        if (bytes.size() > 12 && i % 2 == 0) { /* a plausible header */
            const Bytes header{
                static_cast<std::uint8_t>(0x10 | (i / 2 % 2)), 9, static_cast<std::uint8_t>(1 + i % 7), 0, 0, 0};
            std::copy(header.begin(), header.end(), bytes.begin());
            bytes[11] &= 3;
            bytes[9] &= 3;
            bytes[7] = 0;
        }
        feed({bytes});
    }
    EXPECT_GT(refused(Cause::fragment_format), 0u);
    EXPECT_EQ(reports.size(), 0u);
    EXPECT_EQ(state_of(feed(test::map_fragments(keys, 3, 70000, body_of(64))).back()), TSR_DELIVERY_COMMITTED);
}

TEST_F(SinkReceiver, MessagesThatCannotBeAreRefusedAtOnce)
{
    tsr_fragment fragment{};
    const Bytes piece(TSR_FRAGMENT_PIECE_MAX, 0);
    fragment.origin = 3;
    fragment.count = TSR_FRAGMENT_COUNT_MAX;
    fragment.piece = piece.data();
    fragment.piece_len = static_cast<std::uint8_t>(piece.size());
    Bytes bytes(TSR_FRAME_PAYLOAD_MAX);
    std::size_t len = 0;
    test::require_ok(tsr_fragment_write(&fragment, bytes.data(), bytes.size(), &len));
    bytes.resize(len);
    feed({bytes});
    EXPECT_EQ(refused(Cause::message_too_long), 1u);
}

TEST_F(SinkReceiver, StatusesNeverShareANonce)
{
    const auto fragments = test::map_fragments(keys, 3, 5, body_of(64));
    std::uint32_t last = 0;
    for (int i = 0; i < 50; i++) {
        std::uint32_t counter = 0;
        const auto answers = feed(i == 0 ? fragments : std::vector<Bytes>{fragments.back()});
        test::open_status(keys, 3, answers.back(), &counter);
        EXPECT_GT(counter, last);
        last = counter;
        if (i % 10 == 9) {
            restart();
        }
    }
}

} // namespace
} // namespace tsr
