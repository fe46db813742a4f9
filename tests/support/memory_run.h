/*
 * A run of the emulator without files or processes: nodes of a small site as
 * the emulator runs them, the sink in memory behind the gateway.
 *
 * The scene changes once, at kSceneChangeUs: each pair owes the sink a map of
 * before and one of after.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_MEMORY_RUN_H
#define TSR_TEST_MEMORY_RUN_H

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "test_host_site.h"
#include "tiny_site_parts.h"
#include "tsr/emulator/simulation.h"
#include "tsr/sink/link_session.h"

extern "C" {
#include "tsr/wire/link.h"
}

namespace tsr::test
{

inline constexpr std::uint16_t kGateway = 1;
inline constexpr std::uint16_t kRelay = 2;
inline constexpr std::uint16_t kLead = 3;
inline constexpr std::uint16_t kWing = 4;
inline constexpr std::uint16_t kBinocular = 5;
inline constexpr std::uint32_t kPeriodMs = 100;
inline constexpr std::uint64_t kSceneChangeUs = 1'000'000; /* after the first maps */
inline constexpr std::uint64_t kSceneEndUs = 1'200'000;

/* gateway 1, relay 2 with lead 3 (wing 4) and binocular 5 below; or, flat, binocular 5 at the gateway. */
inline Site short_site(bool flat = false)
{
    Site site = small_site();
    for (SiteNode &node : site.nodes) {
        node.watch_period_ms = kPeriodMs;
        if (flat && node.id == 5) {
            node.parent = 1;
        }
    }
    return site;
}

class TinyPictures : public Pictures
{
  public:
    TinyPictures(const Site &site, std::uint64_t end_us) : site_(site), end_us_(end_us) {}

    std::unique_ptr<FrameSource> source(const SiteNode &node, bool right) override
    {
        const SitePair *pair = site_.pair_of(node.id);
        if (pair == nullptr || (right && node.role != Role::binocular)) {
            return nullptr;
        }
        return std::make_unique<Source>(ImageSize{pair->width, pair->height}, right || node.role == Role::wing);
    }
    std::uint64_t end_us() const override { return end_us_; }
    std::optional<PairTruth> truth(const SitePair &, std::uint64_t) override { return std::nullopt; }

  private:
    class Source : public FrameSource
    {
      public:
        Source(ImageSize size, bool right) : size_(size), right_(right) {}
        ImageSize size() const override { return size_; }
        void prepare(std::uint64_t) override {}
        void show(std::uint64_t time_us, const tsr_gray &image) override
        {
            for (unsigned y = 0; y < image.height; ++y) {
                for (unsigned x = 0; x < image.width; ++x) {
                    image.pixels[y * image.stride + x] =
                        TinyScene::pixel(right_, x, y, time_us < kSceneChangeUs ? 0 : 1);
                }
            }
        }

      private:
        ImageSize size_;
        bool right_;
    };

    const Site &site_;
    std::uint64_t end_us_;
};

class MemorySink : public SinkLink
{
  public:
    MemorySink(const Site &site, const KeyRing &keys)
        : store(fresh_database(), site.pan_id, Store::Open::create, "memdb"), site_(site), keys_(keys)
    {
        start();
    }

    std::vector<std::uint8_t> exchange(const std::uint8_t *frame, std::size_t len) override
    {
        std::vector<std::uint8_t> bytes(frame, frame + len);
        if (frame_type(bytes) == TSR_LINK_HELLO) {
            hello_ = bytes;
        }
        return ask(bytes);
    }
    void restart() override
    {
        start();
        ++restarts;
        if (!hello_.empty()) {
            ask(hello_); /* whoever reconnects says so */
        }
    }

    Store store;
    unsigned restarts = 0;

  private:
    static std::string fresh_database()
    {
        static int count = 0;
        return "/run" + std::to_string(count++);
    }
    static std::uint8_t frame_type(const std::vector<std::uint8_t> &bytes)
    {
        tsr_link_decoder decoder;
        tsr_link_decoder_init(&decoder);
        tsr_link_frame frame{};
        for (const std::uint8_t byte : bytes) {
            if (tsr_link_decode(&decoder, byte, &frame) == TSR_OK) {
                return frame.type;
            }
        }
        return 0;
    }
    /* What was not committed is forgotten. */
    void start()
    {
        server_.reset();
        receiver_.emplace(site_, keys_, store);
        server_.emplace(*receiver_, site_.pan_id);
        session_ = std::make_unique<LinkSession>();
    }
    std::vector<std::uint8_t> ask(std::vector<std::uint8_t> bytes)
    {
        const LinkServer::Input input{session_.get(), std::move(bytes)};
        server_->process({&input, 1});
        return std::exchange(session_->outgoing(), {});
    }

    const Site &site_;
    const KeyRing &keys_;
    std::optional<Receiver> receiver_;
    std::optional<LinkServer> server_;
    std::unique_ptr<LinkSession> session_;
    std::vector<std::uint8_t> hello_;
};

class MemoryRun
{
  public:
    explicit MemoryRun(Site with, std::uint64_t seed = 1, std::uint64_t end_us = kSceneEndUs)
        : site(seeded(std::move(with), seed)), keys(derive_test_keys(7, site)), pictures(site, end_us),
          sink(site, keys), simulation(site, keys, pictures, sink)
    {
    }

    /* Until all is quiet or until_us. After event number strike_at, counted from 0, fault strikes. */
    void run(std::uint64_t until_us = UINT64_MAX, std::uint64_t strike_at = UINT64_MAX, const SiteFault &fault = {})
    {
        simulation.run([&](std::uint64_t now_us, std::uint64_t) {
            if (events++ == strike_at) {
                simulation.faults().strike(fault);
            }
            return now_us < until_us;
        });
    }
    const EmulatedNode &node(std::uint16_t id) const
    {
        return **std::find_if(simulation.nodes().begin(), simulation.nodes().end(),
                              [id](const auto &one) { return one->id() == id; });
    }
    std::vector<StoredMap> maps_of(std::uint16_t id)
    {
        std::vector<StoredMap> maps;
        sink.store.for_each([&](const StoredMap &map) {
            if (map.node == id) {
                maps.push_back(map);
            }
        });
        return maps;
    }
    /* The latest map shows the scene after its change. */
    bool is_up_to_date(std::uint16_t id)
    {
        const auto maps = maps_of(id);
        return !maps.empty() && simulation.virtual_us(id, maps.back().capture_time_us) >= kSceneChangeUs;
    }

    Site site;
    KeyRing keys;
    TinyPictures pictures;
    MemorySink sink;
    Simulation simulation;
    std::uint64_t events = 0;

  private:
    static Site seeded(Site site, std::uint64_t seed)
    {
        site.seed = seed;
        check_site(site);
        return site;
    }
};

/* Nothing that a node counts as acknowledged is lost, and nothing is stored twice. */
inline void expect_kept(MemoryRun &run, std::uint16_t but_for = kNodeNone)
{
    for (const std::uint16_t id : {kLead, kBinocular}) {
        const auto maps = run.maps_of(id);
        EXPECT_TRUE(id == but_for || run.node(id).counters().maps_sent <= maps.size())
            << "acknowledged but not stored: node " << id;
        std::set<std::uint64_t> captures;
        for (const StoredMap &map : maps) {
            EXPECT_TRUE(captures.insert(map.capture_time_us).second) << "stored twice: node " << id;
        }
    }
}

} // namespace tsr::test

#endif
