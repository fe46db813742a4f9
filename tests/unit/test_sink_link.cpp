/* The gateway link: exactly one ANSWER each, over bytes and over sockets. SPDX-License-Identifier: Apache-2.0 */
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "test_sink_messages.h"
#include "tsr/sink/gateway.h"
#include "tsr/sink/link_session.h"

namespace tsr
{
namespace
{

using test::Bytes;

Bytes frame_of(std::uint8_t type, std::uint16_t sequence, const Bytes &body)
{
    const tsr_link_frame frame{type, sequence, body.data(), body.size()};
    Bytes bytes(TSR_LINK_FRAME_MAX);
    std::size_t len = 0;
    test::require_ok(tsr_link_encode(&frame, bytes.data(), bytes.size(), &len));
    bytes.resize(len);
    return bytes;
}

Bytes hello_of(std::uint16_t sequence, std::uint16_t pan_id, std::uint8_t version = TSR_LINK_VERSION)
{
    return frame_of(TSR_LINK_HELLO, sequence,
                    {version, static_cast<std::uint8_t>(pan_id), static_cast<std::uint8_t>(pan_id >> 8), 1, 0});
}

Bytes uplink_of(std::uint16_t sequence, const Bytes &fragment)
{
    Bytes body(TSR_LINK_UPLINK_HEADER_LEN, 0);
    body[0] = static_cast<std::uint8_t>(sequence);
    body.insert(body.end(), fragment.begin(), fragment.end());
    return frame_of(TSR_LINK_UPLINK, sequence, body);
}

struct Answer {
    std::uint16_t sequence;
    Bytes body;
    bool operator==(const Answer &) const = default;
};

std::vector<Answer> answers_in(const Bytes &bytes)
{
    std::vector<Answer> answers;
    tsr_link_decoder decoder;
    tsr_link_decoder_init(&decoder);
    for (const std::uint8_t byte : bytes) {
        tsr_link_frame frame{};
        if (tsr_link_decode(&decoder, byte, &frame) == TSR_OK) {
            EXPECT_EQ(frame.type, TSR_LINK_ANSWER);
            answers.push_back({frame.sequence, {frame.body, frame.body + frame.body_len}});
        }
    }
    EXPECT_EQ(decoder.rejected, 0u);
    return answers;
}

class SinkLink : public ::testing::Test
{
  protected:
    std::vector<Answer> exchange(LinkSession &session, const Bytes &bytes)
    {
        server.process(std::vector<LinkServer::Input>{{&session, bytes}});
        const std::vector<Answer> answers = answers_in(session.outgoing());
        session.outgoing().clear();
        return answers;
    }

    std::vector<Bytes> map_of(std::uint32_t counter) const
    {
        return test::map_fragments(keys, 3, counter,
                                   test::map_body(test::code_map(test::flat_map(site.pairs[0], 64)),
                                                  test::code_reference(test::textured_image(site.pairs[0]))));
    }

    const test::Folder folder;
    const Site site = test::small_site();
    const KeyRing keys = derive_test_keys(1, site);
    Store store{folder / "a.db", site.pan_id};
    Receiver receiver{site, keys, store};
    LinkServer server{receiver, site.pan_id};
};

TEST_F(SinkLink, EachFrameGetsOneAnswerWithItsSequence)
{
    LinkSession session;
    Bytes bytes = hello_of(0, site.pan_id);
    const auto fragments = map_of(5);
    for (std::size_t i = 0; i < fragments.size(); i++) {
        const Bytes frame = uplink_of(static_cast<std::uint16_t>(i + 1), fragments[i]);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
    }
    const auto answers = exchange(session, bytes);
    ASSERT_EQ(answers.size(), fragments.size() + 1);
    for (std::size_t i = 0; i < answers.size(); i++) {
        EXPECT_EQ(answers[i].sequence, i);
        EXPECT_EQ(answers[i].body.empty(), i + 1 < answers.size());
    }
    const Bytes &body = answers.back().body;
    ASSERT_EQ(body.size(), body[0] + 1u);
    EXPECT_EQ(test::open_status(keys, 3, Bytes(body.begin() + 1, body.end())).state, TSR_DELIVERY_COMMITTED);
    EXPECT_TRUE(store.find(3, 5).has_value());
}

TEST_F(SinkLink, BytesMayComeOneByOne)
{
    LinkSession session;
    std::size_t answered = 0;
    for (const Bytes &fragment : map_of(5)) {
        for (const std::uint8_t byte : uplink_of(9, fragment)) {
            answered += exchange(session, {byte}).size();
        }
    }
    EXPECT_EQ(answered, map_of(5).size());
    EXPECT_TRUE(store.find(3, 5).has_value());
}

TEST_F(SinkLink, ARepetitionGetsTheSameAnswerAlsoOverANewConnection)
{
    LinkSession first;
    exchange(first, hello_of(0, site.pan_id));
    const Bytes poll = uplink_of(7, map_of(5).back());
    const auto answer = exchange(first, poll);
    ASSERT_EQ(answer.size(), 1u);
    EXPECT_FALSE(answer[0].body.empty());
    EXPECT_EQ(exchange(first, poll), answer);
    LinkSession second;
    exchange(second, hello_of(8, site.pan_id));
    EXPECT_EQ(exchange(second, poll), answer);
    EXPECT_EQ(server.counts().repeated_uplinks, 2u);
    EXPECT_NE(exchange(second, uplink_of(8, map_of(5).back())), answer);
}

TEST_F(SinkLink, AnotherPanOrVersionIsAnsweredAndNothingElse)
{
    for (const Bytes &hello : {hello_of(0, 0x1234), hello_of(0, site.pan_id, 9), frame_of(TSR_LINK_HELLO, 0, {1, 2})}) {
        LinkSession session;
        const auto greeting = exchange(session, hello);
        ASSERT_EQ(greeting.size(), 1u);
        for (const Bytes &fragment : map_of(5)) {
            const auto answers = exchange(session, uplink_of(1, fragment));
            ASSERT_EQ(answers.size(), 1u);
            EXPECT_TRUE(answers[0].body.empty());
        }
    }
    EXPECT_FALSE(store.find(3, 5).has_value());
    EXPECT_EQ(receiver.tally().count(Cause::hello_refused), 3 * (1 + map_of(5).size()));
}

TEST_F(SinkLink, ShortUplinksAndForeignFramesAreCounted)
{
    LinkSession session;
    EXPECT_EQ(exchange(session, frame_of(TSR_LINK_UPLINK, 1, {})).size(), 1u);
    EXPECT_EQ(exchange(session, frame_of(TSR_LINK_UPLINK, 2, {1, 2, 3})).size(), 1u);
    EXPECT_EQ(exchange(session, frame_of(TSR_LINK_ANSWER, 3, {})).size(), 0u);
    EXPECT_EQ(receiver.tally().count(Cause::fragment_format), 2u);
    EXPECT_EQ(receiver.tally().count(Cause::link_unexpected), 1u);
}

TEST_F(SinkLink, NoBytesStopIt)
{
    std::mt19937 random(3);
    LinkSession session;
    const auto fragments = map_of(5);
    for (int i = 0; i < 3000; i++) {
        Bytes bytes = uplink_of(static_cast<std::uint16_t>(i), fragments[random() % fragments.size()]);
        for (unsigned damage = random() % 4; damage > 0; damage--) {
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        }
        bytes.resize(random() % (bytes.size() + 1));
        exchange(session, bytes);
    }
    EXPECT_GT(receiver.tally().count(Cause::link_damaged), 0u);
    exchange(session, {0x7e});
    const auto answers = exchange(session, uplink_of(9999, fragments.back()));
    EXPECT_EQ(answers.size(), 1u);
}

int connect_to(const std::filesystem::path &path)
{
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::snprintf(name.sun_path, sizeof name.sun_path, "%s", path.c_str());
    for (int tries = 0; tries < 500; tries++) {
        const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
        if (::connect(descriptor, reinterpret_cast<sockaddr *>(&name), sizeof name) == 0) {
            return descriptor;
        }
        ::close(descriptor);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return -1;
}

/* Each frame after the answer to the one before, as a gateway does. */
void send_in_lockstep(int descriptor, const std::vector<Bytes> &fragments)
{
    Bytes received;
    std::uint16_t sequence = 0;
    for (const Bytes &fragment : fragments) {
        const Bytes frame = uplink_of(++sequence, fragment);
        ASSERT_EQ(::write(descriptor, frame.data(), frame.size()), static_cast<ssize_t>(frame.size()));
        while (answers_in(received).size() < sequence) {
            Bytes buffer(4096);
            const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
            ASSERT_GT(got, 0);
            received.insert(received.end(), buffer.begin(), buffer.begin() + got);
        }
    }
}

TEST_F(SinkLink, ServesAUnixSocketOnce)
{
    const auto path = folder / "link.sock";
    const ListenAddress address = parse_listen_address("unix:" + path.string());
    GatewayOptions options;
    options.once = true;
    std::thread thread([&] { Gateways(address, options).serve(server); });
    const int descriptor = connect_to(path);
    ASSERT_GE(descriptor, 0);
    send_in_lockstep(descriptor, map_of(5));
    ::close(descriptor);
    thread.join();
    EXPECT_TRUE(store.find(3, 5).has_value());
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(SinkLink, ServesAnInheritedSocketUntilItsOtherEndCloses)
{
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    const ListenAddress address = parse_listen_address("fd:" + std::to_string(ends[0]));
    std::thread thread([&] { Gateways(address, {}).serve(server); });
    send_in_lockstep(ends[1], map_of(5));
    ::close(ends[1]);
    thread.join();
    EXPECT_TRUE(store.find(3, 5).has_value());
}

TEST_F(SinkLink, WhatIsNoConnectedSocketIsRefused)
{
    EXPECT_REFUSED(Gateways(parse_listen_address("fd:99999"), {}), "fd:99999: number: Bad file descriptor");
    const int alone = ::socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_REFUSED(Gateways(parse_listen_address("fd:" + std::to_string(alone)), {}), "is not a connected stream");
    ::close(alone);
}

TEST_F(SinkLink, ASocketInUseIsRefusedAndAStaleOneReplaced)
{
    const auto path = folder / "link.sock";
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::snprintf(name.sun_path, sizeof name.sun_path, "%s", path.c_str());
    const int other = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(other, reinterpret_cast<sockaddr *>(&name), sizeof name), 0);
    ASSERT_EQ(::listen(other, 1), 0);
    const ListenAddress address = parse_listen_address("unix:" + path.string());
    EXPECT_REFUSED(Gateways(address, {}), "link.sock: path: another sink listens here");
    ::close(other); /* the file stays behind */
    GatewayOptions options;
    options.once = true;
    std::thread thread([&] { Gateways(address, options).serve(server); });
    ::close(connect_to(path));
    thread.join();
    const auto file = folder.put("file", "x");
    EXPECT_REFUSED(Gateways(parse_listen_address("unix:" + file.string()), {}), "is not a socket");
}

TEST(SinkListenAddress, ReadsAndRefuses)
{
    EXPECT_EQ(parse_listen_address("unix:/a:b").place, "/a:b");
    const ListenAddress tcp = parse_listen_address("tcp:[::1]:7000");
    EXPECT_EQ(tcp.place, "::1");
    EXPECT_EQ(tcp.port, "7000");
    const ListenAddress serial = parse_listen_address("serial:/dev/ttyACM0:115200");
    EXPECT_EQ(serial.place, "/dev/ttyACM0");
    EXPECT_EQ(serial.baud, 115200u);
    EXPECT_EQ(parse_listen_address("fd:3").descriptor, 3);
    EXPECT_REFUSED(parse_listen_address("x"), "--listen x: is not");
    EXPECT_REFUSED(parse_listen_address("fd:-1"), "number: '-1'");
    EXPECT_REFUSED(parse_listen_address("udp:a:1"), "'udp' is not unix");
    EXPECT_REFUSED(parse_listen_address("unix:"), "path: has 0 bytes");
    EXPECT_REFUSED(parse_listen_address("unix:" + std::string(200, 'a')), "path: has 200 bytes");
    EXPECT_REFUSED(parse_listen_address("tcp:host"), "is not tcp:HOST:PORT");
    EXPECT_REFUSED(parse_listen_address("tcp:host:99999"), "port: '99999'");
    EXPECT_REFUSED(parse_listen_address("serial:/dev/x:fast"), "baud: 'fast'");
}

} // namespace
} // namespace tsr
