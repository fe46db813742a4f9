/*
 * A whole site in memory and in virtual time, small enough to be run thousands
 * of times: gateway 1, relay 2, lead 3 with wing 4 ("porch"), binocular 5
 * ("yard"), the sink behind the gateway. Every call that can fail is counted;
 * a Fault lets call number n of one kind fail.
 *
 * The scene changes once, at kChangeUs: each pair owes the sink a map of before
 * and one of after.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_TINY_SITE_H
#define TSR_TEST_TINY_SITE_H

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "tsr/node/node_state.h"
}
#include "test_host_site.h"
#include "tiny_site_parts.h"
#include "tsr/emulator/event_queue.h"
#include "tsr/emulator/node_setup.h"
#include "tsr/hal/air.h"
#include "tsr/host/aes.h"
#include "tsr/sink/link_session.h"

namespace tsr::test
{

inline constexpr std::uint64_t kChangeUs = 2'000'000;
inline constexpr std::uint64_t kExposureUs = 30'000; /* of a fake camera, with readout */
inline constexpr std::uint64_t kStepUs = 20;         /* what a step with work takes, if the test says no more */
inline constexpr std::uint64_t kFrameStepUs = 500;   /* the longest that a frame or 256 sealed bytes take */
inline constexpr std::uint64_t kPortUs = 1'500;      /* gateway to sink or back */

class TinySite;

class TinyCamera
{
  public:
    using Done = std::function<void(tsr_status, std::uint64_t)>;
    TinyCamera(TinySite &site, bool right, Done done) : site_(site), right_(right), done_(std::move(done)) {}
    tsr_camera camera() { return {&kOps, this}; }
    const std::vector<std::uint64_t> &captures() const { return captures_; } /* start of each exposure */

  private:
    static tsr_status capture(void *self, tsr_gray image, std::uint64_t at_us);
    static constexpr tsr_camera_ops kOps = {&TinyCamera::capture};

    TinySite &site_;
    bool right_;
    Done done_;
    bool busy_ = false;
    std::vector<std::uint64_t> captures_;
};

/* One node with its processor, as the emulator runs it. */
class TinyNode
{
  public:
    TinyNode(TinySite &site, const SiteNode &site_node);
    void start(std::uint32_t counter_start);
    void receive_from_port(const std::uint8_t *bytes, std::size_t len);
    bool at_rest() const { return tsr_node_get_phase(&node) <= TSR_PHASE_WATCHING && tsr_node_is_quiet(&node); }
    std::uint16_t id() const { return config().address; }
    const tsr_node_config &config() const { return setup_->config; }
    const TinyCamera &left() const { return left_; }
    /* After a time without power: what was due meanwhile is done now. */
    void restart_timers();

    tsr_node node{};
    bool powered = false; /* without power it hears nothing and does nothing */

  private:
    void on_radio(const tsr_radio_event &event);
    void serve_mac();
    void schedule_step(std::uint64_t time_us);
    void step();
    static tsr_status configure(void *self, std::uint8_t channel, std::uint16_t pan_id, std::uint16_t address);
    static tsr_status set_receiving(void *self, bool receiving);
    static tsr_status transmit(void *self, const std::uint8_t *psdu, std::size_t psdu_len);
    static tsr_status write(void *self, const std::uint8_t *bytes, std::size_t len);
    static void fill(void *self, std::uint8_t *bytes, std::size_t len);
    static constexpr tsr_radio_ops kRadio = {&TinyNode::configure, &TinyNode::set_receiving, &TinyNode::transmit};
    static constexpr tsr_port_ops kPort = {&TinyNode::write};
    static constexpr tsr_entropy_ops kEntropy = {&TinyNode::fill};

    TinySite &site_;
    std::unique_ptr<NodeSetup> setup_;
    std::vector<std::uint64_t> arena_;
    std::size_t radio_ = 0;
    TinyCamera left_;
    TinyCamera right_;
    std::uint64_t random_;
    std::uint64_t busy_until_us_ = 0;
    std::uint64_t step_at_us_ = UINT64_MAX;
    std::uint64_t timer_at_us_ = UINT64_MAX;
};

class TinySite
{
  public:
    explicit TinySite(std::vector<Fault> faults = {}, std::uint64_t seed = 1)
        : site(small_site()), seed(seed), keys(derive_test_keys(7, site)),
          store(fresh_database(), site.pan_id, Store::Open::create, "memdb"), receiver(site, keys, store),
          server(receiver, site.pan_id),
          air(AirModel{},
              {[this] { return queue.now_us(); },
               [this](std::uint64_t at_us, std::function<void()> action) { queue.at(at_us, std::move(action)); }}),
          faults_(std::move(faults))
    {
        for (SiteNode &node : site.nodes) {
            node.watch_period_ms = 250;
        }
        for (const SiteNode &node : site.nodes) {
            nodes.push_back(std::make_unique<TinyNode>(*this, node));
        }
        air.set_judge([this](std::uint64_t, const AirFrame &frame) { return judge(frame); });
    }

    void start()
    {
        for (const auto &node : nodes) {
            node->start(1000);
        }
    }
    TinyNode &node(std::uint16_t id) { return *nodes.at(id - 1u); }

    void run_until(std::uint64_t time_us)
    {
        while (!queue.empty() && queue.next_us() <= time_us) {
            queue.run_next();
        }
    }
    bool at_rest() const
    {
        return std::all_of(nodes.begin(), nodes.end(),
                           [](const auto &node) { return !node->powered || node->at_rest(); });
    }
    /* Maps of a lead or binocular node, in the order they were made. */
    std::vector<StoredMap> maps_of(std::uint16_t id)
    {
        std::vector<StoredMap> maps;
        store.for_each([&](const StoredMap &map) {
            if (map.node == id) {
                maps.push_back(map);
            }
        });
        return maps;
    }
    /* Counts a call of this kind; true if it is the one to fail. */
    bool hit(FaultKind kind)
    {
        const std::uint64_t n = calls[kind]++;
        return std::any_of(faults_.begin(), faults_.end(),
                           [&](const Fault &fault) { return fault.kind == kind && fault.n == n; });
    }
    /* Bytes a gateway wrote reach the sink, and its answer the gateway. */
    void carry(std::vector<std::uint8_t> bytes);

    Site site;
    std::uint64_t seed;
    KeyRing keys;
    EventQueue queue;
    Store store;
    Receiver receiver;
    LinkServer server;
    LinkSession session;
    Air air;
    std::vector<std::unique_ptr<TinyNode>> nodes;
    std::map<FaultKind, std::uint64_t> calls;
    bool sink_silent = false;
    std::uint64_t step_us = kStepUs;
    std::function<bool(const AirFrame &)> also_lost; /* may be empty */

  private:
    /* A name of its own for SQLite's VFS in memory, which shares a file among those who name it. */
    static std::string fresh_database()
    {
        static int count = 0;
        return "/tiny" + std::to_string(count++);
    }
    AirFate judge(const AirFrame &frame)
    {
        if (frame.psdu_len == TSR_FRAME_ACK_LEN) {
            return hit(FaultKind::lose_ack) ? AirFate::lost : AirFate::natural;
        }
        const bool doubled = hit(FaultKind::double_frame);
        if (hit(FaultKind::lose_frame) || (also_lost && also_lost(frame))) {
            return AirFate::lost;
        }
        return doubled ? AirFate::twice : AirFate::natural;
    }

    std::vector<Fault> faults_;
};

inline tsr_status TinyCamera::capture(void *self, tsr_gray image, std::uint64_t at_us)
{
    auto &camera = *static_cast<TinyCamera *>(self);
    TinySite &site = camera.site_;
    if (camera.busy_) {
        return TSR_ERR_BUSY;
    }
    if (site.hit(FaultKind::camera_call)) {
        return TSR_ERR_IO;
    }
    camera.busy_ = true;
    const std::uint64_t start_us = std::max(at_us, site.queue.now_us());
    site.queue.at(start_us + kExposureUs, [&camera, &site, image, start_us] {
        const bool fails = site.hit(FaultKind::camera_done);
        for (unsigned y = 0; y < image.height; ++y) {
            for (unsigned x = 0; x < image.width; ++x) {
                image.pixels[y * image.stride + x] =
                    fails ? 0 : TinyScene::pixel(camera.right_, x, y, start_us < kChangeUs ? 0 : 1);
            }
        }
        camera.busy_ = false;
        camera.captures_.push_back(start_us);
        camera.done_(fails ? TSR_ERR_IO : TSR_OK, start_us);
    });
    return TSR_OK;
}

inline TinyNode::TinyNode(TinySite &site, const SiteNode &site_node)
    : site_(site), setup_(set_up_node(site.site, site_node, site.keys)),
      left_(site, site_node.role == Role::wing,
            [this](tsr_status status, std::uint64_t time_us) {
                tsr_node_on_camera(&node, false, status, time_us);
                schedule_step(site_.queue.now_us());
            }),
      right_(site, true,
             [this](tsr_status status, std::uint64_t time_us) {
                 tsr_node_on_camera(&node, true, status, time_us);
                 schedule_step(site_.queue.now_us());
             }),
      random_(site.seed * 0x9e3779b97f4a7c15u + site_node.id)
{
    radio_ = site.air.add_radio(site_node.position_m, [this](const tsr_radio_event &event) { on_radio(event); });
    setup_->config.match.window = 5;
    setup_->config.change.settle_frames = 1;
}

inline void TinyNode::start(std::uint32_t counter_start)
{
    setup_->config.counter_start = counter_start;
    tsr_memory_plan plan{};
    tsr_node_plan_memory(&setup_->config, &plan);
    arena_.assign(plan.total / sizeof(arena_[0]) + 1, 0);
    const tsr_node_hal hal{&mbedtls_aes_ops(), {&kRadio, this}, {&kEntropy, this},
                           left_.camera(),     right_.camera(), {&kPort, this}};
    const tsr_status status = tsr_node_init(&node, &setup_->config, &hal, reinterpret_cast<std::uint8_t *>(&arena_[0]),
                                            plan.total, site_.queue.now_us());
    if (status != TSR_OK) {
        throw std::runtime_error(std::string("node does not start: ") + tsr_status_name(status));
    }
    powered = true;
    busy_until_us_ = 0;
    restart_timers();
}

inline void TinyNode::restart_timers()
{
    step_at_us_ = timer_at_us_ = UINT64_MAX;
    serve_mac();
    schedule_step(site_.queue.now_us());
}

inline void TinyNode::on_radio(const tsr_radio_event &event)
{
    if (powered) {
        tsr_node_on_radio(&node, &event, site_.queue.now_us());
        serve_mac();
        schedule_step(site_.queue.now_us());
    }
}

inline void TinyNode::receive_from_port(const std::uint8_t *bytes, std::size_t len)
{
    tsr_node_on_port(&node, bytes, len, site_.queue.now_us());
    serve_mac();
    schedule_step(site_.queue.now_us());
}

inline void TinyNode::serve_mac()
{
    tsr_node_on_timer(&node, site_.queue.now_us());
    const std::uint64_t timer_us = tsr_node_timer_us(&node);
    if (timer_us == timer_at_us_ || timer_us == UINT64_MAX) {
        timer_at_us_ = timer_us;
        return;
    }
    timer_at_us_ = timer_us;
    site_.queue.at(timer_us, [this, timer_us] {
        if (timer_at_us_ == timer_us && powered) {
            timer_at_us_ = UINT64_MAX;
            serve_mac();
            schedule_step(site_.queue.now_us()); /* the MAC may have ended a frame */
        }
    });
}

inline void TinyNode::schedule_step(std::uint64_t time_us)
{
    time_us = std::max(time_us, busy_until_us_);
    if (time_us >= step_at_us_) {
        return;
    }
    step_at_us_ = time_us;
    site_.queue.at(time_us, [this, time_us] {
        if (step_at_us_ == time_us && powered) {
            step_at_us_ = UINT64_MAX;
            step();
        }
    });
}

inline void TinyNode::step()
{
    const std::uint64_t now_us = site_.queue.now_us();
    const tsr_node_outcome outcome = tsr_node_step(&node, now_us);
    const bool short_work = outcome.work == TSR_WORK_SEAL || outcome.work == TSR_WORK_COPY;
    const std::uint64_t took_us = short_work ? std::min(site_.step_us, kFrameStepUs) : site_.step_us;
    busy_until_us_ = outcome.work != TSR_WORK_NONE ? now_us + took_us : now_us;
    serve_mac();
    if (outcome.wake_us != UINT64_MAX) {
        schedule_step(outcome.wake_us);
    }
}

inline tsr_status TinyNode::configure(void *self, std::uint8_t channel, std::uint16_t pan_id, std::uint16_t address)
{
    auto &node = *static_cast<TinyNode *>(self);
    const tsr_radio radio = node.site_.air.radio(node.radio_);
    return radio.ops->configure(radio.self, channel, pan_id, address);
}

inline tsr_status TinyNode::set_receiving(void *self, bool receiving)
{
    auto &node = *static_cast<TinyNode *>(self);
    const tsr_radio radio = node.site_.air.radio(node.radio_);
    return radio.ops->set_receiving(radio.self, receiving);
}

inline tsr_status TinyNode::transmit(void *self, const std::uint8_t *psdu, std::size_t psdu_len)
{
    auto &node = *static_cast<TinyNode *>(self);
    const tsr_radio radio = node.site_.air.radio(node.radio_);
    return node.site_.hit(FaultKind::transmit) ? TSR_ERR_IO : radio.ops->transmit(radio.self, psdu, psdu_len);
}

inline tsr_status TinyNode::write(void *self, const std::uint8_t *bytes, std::size_t len)
{
    TinySite &site = static_cast<TinyNode *>(self)->site_;
    const bool damaged = site.hit(FaultKind::port_damage);
    if (site.hit(FaultKind::port_write)) {
        return TSR_ERR_BUSY;
    }
    std::vector<std::uint8_t> taken(bytes, bytes + len);
    if (damaged) {
        taken[len / 2] ^= 0x55;
    }
    site.queue.at(site.queue.now_us() + kPortUs, [&site, taken] { site.carry(taken); });
    return TSR_OK;
}

inline void TinyNode::fill(void *self, std::uint8_t *bytes, std::size_t len)
{
    std::uint64_t &state = static_cast<TinyNode *>(self)->random_;
    for (std::size_t i = 0; i < len; ++i) { /* xorshift64* (Vigna, 2016) */
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        bytes[i] = static_cast<std::uint8_t>(state * 0x2545f4914f6cdd1du >> 56);
    }
}

inline void TinySite::carry(std::vector<std::uint8_t> bytes)
{
    if (sink_silent) {
        return;
    }
    const LinkServer::Input input{&session, std::move(bytes)};
    server.process({&input, 1});
    const std::vector<std::uint8_t> answer = std::exchange(session.outgoing(), {});
    if (answer.empty()) {
        return;
    }
    const bool doubled = hit(FaultKind::double_answer);
    if (hit(FaultKind::lose_answer)) {
        return;
    }
    for (int copy = 0; copy < (doubled ? 2 : 1); ++copy) {
        queue.at(queue.now_us() + kPortUs, [this, answer] {
            TinyNode &gateway = node(1);
            if (gateway.powered) {
                gateway.receive_from_port(answer.data(), answer.size());
            }
        });
    }
}

} // namespace tsr::test

#endif
