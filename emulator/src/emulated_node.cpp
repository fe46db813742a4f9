/*
 * A node in virtual time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/emulated_node.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

extern "C" {
#include "tsr/node/node_state.h"
#include "tsr/node/substitute.h"
}
#include "tsr/host/aes.h"
#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

const tsr_entropy_ops *entropy_ops(void (*fill)(void *, std::uint8_t *, std::size_t))
{
    static tsr_entropy_ops ops{};
    ops.fill = fill;
    return &ops;
}

constexpr std::uint64_t kCodingQuantumUs = 3'000; /* as long as four rows of matching: the radio is served in between */
constexpr std::uint64_t kUnknownRam = 0xa5a5a5a5a5a5a5a5u; /* what RAM holds at power-on is anything */

/* Counters are 32-bit fields and nothing else, so they add up as words. */
template <typename Counters> Counters sum(const Counters &a, const Counters &b)
{
    static_assert(sizeof(Counters) % sizeof(std::uint32_t) == 0);
    using Words = std::array<std::uint32_t, sizeof(Counters) / sizeof(std::uint32_t)>;
    auto words = std::bit_cast<Words>(a);
    const auto others = std::bit_cast<Words>(b);
    std::transform(words.begin(), words.end(), others.begin(), words.begin(), std::plus<>());
    return std::bit_cast<Counters>(words);
}

/* A camera counts by its node's clock; what it sees happens in virtual time. */
class ClockedSource : public FrameSource
{
  public:
    ClockedSource(std::unique_ptr<FrameSource> source, const NodeClock &clock)
        : source_(std::move(source)), clock_(clock)
    {
    }

    ImageSize size() const override { return source_->size(); }
    void prepare(std::uint64_t time_us) override { source_->prepare(clock_.virtual_us(time_us)); }
    void show(std::uint64_t time_us, const tsr_gray &image) override
    {
        source_->show(clock_.virtual_us(time_us), image);
    }

  private:
    std::unique_ptr<FrameSource> source_;
    const NodeClock &clock_;
};

} // namespace

template <typename Action> void EmulatedNode::at(std::uint64_t time_us, Action action)
{
    around_.queue.at(clock_.virtual_us(time_us), [this, life = lives_, action = std::move(action)] {
        if (powered() && lives_ == life) {
            action();
        }
    });
}

EmulatedNode::EmulatedNode(const Site &site, const SiteNode &node, const KeyRing &keys, Surroundings surroundings)
    : site_node_(node), site_(site), around_(std::move(surroundings)), setup_(set_up_node(site, node, keys)),
      random_(around_.seed * 0x9e3779b97f4a7c15u + node.id)
{
    setup_->config.watch_period_us = static_cast<std::uint32_t>(watch_period_us());
    if (streams()) {
        setup_->config.change.settle_frames = 1; /* it asks for no change */
    }
    tsr_memory_plan plan{};
    tsr_node_plan_memory(&setup_->config, &plan);
    arena_words_ = (plan.total + sizeof(arena_[0]) - 1) / sizeof(arena_[0]);
    radio_ = around_.air.add_radio(node.position_m, [this](tsr_radio_event event) {
        event.time_us = clock_.local_us(event.time_us);
        tsr_node_on_radio(node_.get(), &event, local_us());
        attend();
    });
    around_.air.set_power(radio_, false); /* until power_on() */
    add_camera(false);
    add_camera(true);
}

EmulatedNode::~EmulatedNode() = default;

std::uint64_t EmulatedNode::watch_period_us() const
{
    return std::uint64_t{streams() ? around_.baseline->period_ms : site_node_.watch_period_ms} * 1000;
}

void EmulatedNode::add_camera(bool right)
{
    auto source = around_.pictures.source(site_node_, right);
    if (!source) {
        return;
    }
    SourceCamera::Owner owner;
    owner.now_us = [this] { return local_us(); };
    owner.finish_at = [this, right](std::uint64_t time_us) {
        at(time_us, [this, right] { (right ? right_ : left_)->finish(); });
    };
    owner.done = [this, right](tsr_status status, std::uint64_t time_us) {
        captures_watching_ += phase() == TSR_PHASE_WATCHING ? 1 : 0;
        tsr_node_on_camera(node_.get(), right, status, time_us);
        attend();
    };
    (right ? right_ : left_) =
        std::make_unique<SourceCamera>(std::make_unique<ClockedSource>(std::move(source), clock_), std::move(owner));
}

void EmulatedNode::power_on(std::uint32_t counter_start)
{
    ++lives_;
    node_ = std::make_unique<tsr_node>();
    arena_.assign(arena_words_, kUnknownRam);
    around_.air.set_power(radio_, true);
    tsr_node_hal hal{};
    hal.aes = &mbedtls_aes_ops();
    hal.radio = around_.air.radio(radio_);
    hal.entropy = {entropy_ops(&EmulatedNode::fill_entropy), this};
    hal.left = left_ ? left_->camera() : tsr_camera{};
    hal.right = right_ ? right_->camera() : tsr_camera{};
    hal.port = around_.port;
    tsr_node_config config = setup_->config;
    config.counter_start = counter_start != 0 ? counter_start : config.counter_start;
    const tsr_status status = tsr_node_init(node_.get(), &config, &hal, reinterpret_cast<std::uint8_t *>(arena_.data()),
                                            arena_len(), local_us());
    if (status != TSR_OK) {
        throw InputError(site_.file.string(), site_node_.name,
                         std::string("does not start: ") + tsr_status_name(status));
    }
    attend();
}

void EmulatedNode::power_off()
{
    if (!powered()) {
        return;
    }
    past_counters_ = counters();
    past_mac_counters_ = mac_counters();
    past_sender_counters_ = sender_counters();
    const std::uint64_t now_us = around_.queue.now_us();
    cpu_busy_us_ -= busy_until_us_ > now_us ? busy_until_us_ - now_us : 0; /* the rest of a step is not done */
    coding_left_us_ = 0;
    busy_until_us_ = 0;
    step_at_us_ = timer_at_us_ = UINT64_MAX;
    around_.air.set_power(radio_, false);
    for (SourceCamera *camera : {left_.get(), right_.get()}) {
        if (camera != nullptr) {
            camera->abort();
        }
    }
    node_.reset();
    arena_ = {};
    note_phase(TSR_PHASE_IDLE);
}

/* What is scheduled was converted at the old rate: the node looks at its clock anew. */
void EmulatedNode::set_drift(int ppm)
{
    clock_.set_rate(around_.queue.now_us(), ppm);
    if (powered()) {
        step_at_us_ = timer_at_us_ = UINT64_MAX;
        attend();
    }
}

void EmulatedNode::set_camera_failing(bool failing)
{
    for (SourceCamera *camera : {left_.get(), right_.get()}) {
        if (camera != nullptr) {
            camera->set_failing(failing);
        }
    }
}

/* After an interrupt. */
void EmulatedNode::attend()
{
    serve_mac();
    schedule_step(local_us());
}

/* xorshift64* (Vigna, ACM TOMS 42(4), 2016): back-off only. */
void EmulatedNode::fill_entropy(void *self, std::uint8_t *bytes, std::size_t len)
{
    std::uint64_t &state = static_cast<EmulatedNode *>(self)->random_;
    for (std::size_t i = 0; i < len; ++i) {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        bytes[i] = static_cast<std::uint8_t>(state * 0x2545f4914f6cdd1du >> 56);
    }
}

void EmulatedNode::receive_from_port(const std::uint8_t *bytes, std::size_t len)
{
    if (powered()) {
        tsr_node_on_port(node_.get(), bytes, len, local_us());
        attend();
    }
}

/* Interrupt context: the MAC's timer runs even while the processor computes. */
void EmulatedNode::serve_mac()
{
    tsr_node_on_timer(node_.get(), local_us());
    const std::uint64_t timer_us = tsr_node_timer_us(node_.get());
    if (timer_us == timer_at_us_ || timer_us == UINT64_MAX) {
        timer_at_us_ = timer_us;
        return;
    }
    timer_at_us_ = timer_us;
    at(timer_us, [this, timer_us] {
        if (timer_at_us_ == timer_us) {
            timer_at_us_ = UINT64_MAX;
            serve_mac();
        }
    });
}

void EmulatedNode::schedule_step(std::uint64_t time_us)
{
    time_us = std::max(time_us, clock_.local_us(std::max(busy_until_us_, around_.queue.now_us())));
    if (time_us >= step_at_us_) {
        return;
    }
    step_at_us_ = time_us;
    at(time_us, [this, time_us] {
        if (step_at_us_ == time_us) {
            step_at_us_ = UINT64_MAX;
            step();
        }
    });
}

/* A baseline node's views go to its own coder. */
void EmulatedNode::take_views()
{
    if (streams()) {
        tsr_node_wake_next(node_.get());
    }
    tsr_gray_view left{};
    tsr_gray_view right{};
    if (tsr_node_take_pair(node_.get(), &left, &right)) {
        views_ = tsr::code_views(*around_.baseline, left, right);
        coding_left_us_ = instructions_time_us(around_.power, views_.instructions);
    }
}

/* A part of the coding; returns how long it took. */
std::uint64_t EmulatedNode::code_views(std::uint64_t most_us)
{
    const std::uint64_t took_us = std::min(coding_left_us_, most_us);
    coding_left_us_ -= took_us;
    if (took_us > 0 && coding_left_us_ == 0) {
        tsr_node_send_pair(node_.get(), views_.left.data(), views_.left.size(), views_.right.data(),
                           views_.right.size(), local_us());
    }
    return took_us;
}

void EmulatedNode::step()
{
    const std::uint64_t now_us = around_.queue.now_us();
    if (around_.baseline != nullptr) {
        take_views();
    }
    const tsr_node_outcome outcome = tsr_node_step(node_.get(), local_us());
    std::uint64_t took_us = 0;
    if (outcome.work != TSR_WORK_NONE) {
        took_us = work_time_us(around_.power, outcome.work, outcome.units);
        work_units_.at(outcome.work) += outcome.units;
        cpu_watching_us_ += outcome.work == TSR_WORK_CHANGE ? took_us : 0;
    } else {
        took_us = code_views(kCodingQuantumUs);
    }
    note_phase(tsr_node_get_phase(node_.get()));
    cpu_busy_us_ += took_us;
    busy_until_us_ = took_us > 0 ? now_us + took_us : busy_until_us_;
    serve_mac();
    const std::uint64_t wake_us = took_us > 0 ? local_us() : outcome.wake_us;
    if (wake_us != UINT64_MAX) {
        schedule_step(wake_us);
    }
}

void EmulatedNode::note_phase(tsr_node_phase phase)
{
    if (phase != phase_) {
        const tsr_node_phase before = std::exchange(phase_, phase);
        if (around_.phase_changed) {
            around_.phase_changed({around_.queue.now_us(), id(), phase, before});
        }
    }
}

bool EmulatedNode::at_rest() const
{
    if (!powered()) {
        return true;
    }
    /* What a lost capture, view or map has shown is still owed: the next frame is captured again. */
    const bool owes_map = node_->recapture && !streams() &&
                          (node_->config.role == TSR_ROLE_LEAD || node_->config.role == TSR_ROLE_BINOCULAR);
    return phase() <= TSR_PHASE_WATCHING && !owes_map && tsr_node_is_quiet(node_.get());
}

tsr_node_phase EmulatedNode::phase() const
{
    return powered() ? tsr_node_get_phase(node_.get()) : TSR_PHASE_IDLE;
}

tsr_node_counters EmulatedNode::counters() const
{
    return powered() ? sum(past_counters_, *tsr_node_get_counters(node_.get())) : past_counters_;
}

tsr_mac_counters EmulatedNode::mac_counters() const
{
    return powered() ? sum(past_mac_counters_, *tsr_node_get_mac_counters(node_.get())) : past_mac_counters_;
}

tsr_sender_counters EmulatedNode::sender_counters() const
{
    return powered() ? sum(past_sender_counters_, *tsr_node_get_sender_counters(node_.get())) : past_sender_counters_;
}

NodeTimes EmulatedNode::times() const
{
    NodeTimes times;
    times.radio = around_.air.times(radio_);
    times.total_us = around_.queue.now_us() - times.radio.off;
    times.cpu_busy_us = cpu_busy_us_;
    for (const auto *camera : {left_.get(), right_.get()}) {
        times.cameras += camera != nullptr ? 1 : 0;
        times.captures += camera != nullptr ? camera->captures() : 0;
    }
    times.exposure_us = SourceCamera::kExposureUs;
    times.readout_us = SourceCamera::kReadoutUs;
    return times;
}

EnergyMj EmulatedNode::energy() const
{
    return energy_of(around_.power, times());
}

double EmulatedNode::active_mj(std::uint64_t heard_us) const
{
    return tsr::active_mj(around_.power, times(), heard_us, {cpu_watching_us_, captures_watching_});
}

} // namespace tsr
