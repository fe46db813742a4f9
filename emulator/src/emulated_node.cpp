/*
 * A node in virtual time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/emulated_node.h"

#include <algorithm>
#include <utility>

extern "C" {
#include "tsr/node/node_state.h"
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

} // namespace

EmulatedNode::EmulatedNode(const Site &site, const SiteNode &node, const KeyRing &keys, Surroundings surroundings)
    : site_node_(node), site_(site), around_(std::move(surroundings)), setup_(set_up_node(site, node, keys)),
      random_(around_.seed * 0x9e3779b97f4a7c15u + node.id)
{
    radio_ = around_.air.add_radio(node.position_m, [this](const tsr_radio_event &event) {
        tsr_node_on_radio(node_.get(), &event, around_.queue.now_us());
        serve_mac();
        schedule_step(around_.queue.now_us());
    });
    add_camera(false);
    add_camera(true);
}

EmulatedNode::~EmulatedNode() = default;

void EmulatedNode::add_camera(bool right)
{
    auto source = around_.pictures.source(site_node_, right);
    if (!source) {
        return;
    }
    SourceCamera::Owner owner;
    owner.now_us = [this] { return around_.queue.now_us(); };
    owner.finish_at = [this, right](std::uint64_t time_us) {
        around_.queue.at(time_us, [this, right] { (right ? right_ : left_)->finish(); });
    };
    owner.done = [this, right](tsr_status status, std::uint64_t time_us) {
        tsr_node_on_camera(node_.get(), right, status, time_us);
        schedule_step(around_.queue.now_us());
    };
    (right ? right_ : left_) = std::make_unique<SourceCamera>(std::move(source), std::move(owner));
}

void EmulatedNode::start()
{
    node_ = std::make_unique<tsr_node>();
    tsr_memory_plan plan{};
    tsr_node_plan_memory(&setup_->config, &plan);
    arena_.assign((plan.total + sizeof(arena_[0]) - 1) / sizeof(arena_[0]), 0);
    tsr_node_hal hal{};
    hal.aes = &mbedtls_aes_ops();
    hal.radio = around_.air.radio(radio_);
    hal.entropy = {entropy_ops(&EmulatedNode::fill_entropy), this};
    hal.left = left_ ? left_->camera() : tsr_camera{};
    hal.right = right_ ? right_->camera() : tsr_camera{};
    hal.port = around_.port;
    const std::uint64_t now_us = around_.queue.now_us();
    const tsr_status status = tsr_node_init(node_.get(), &setup_->config, &hal,
                                            reinterpret_cast<std::uint8_t *>(arena_.data()), arena_len(), now_us);
    if (status != TSR_OK) {
        throw InputError(site_.file.string(), site_node_.name,
                         std::string("does not start: ") + tsr_status_name(status));
    }
    serve_mac();
    schedule_step(now_us);
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
    tsr_node_on_port(node_.get(), bytes, len, around_.queue.now_us());
    serve_mac();
    schedule_step(around_.queue.now_us());
}

/* Interrupt context: the MAC's timer runs even while the processor computes. */
void EmulatedNode::serve_mac()
{
    tsr_node_on_timer(node_.get(), around_.queue.now_us());
    const std::uint64_t timer_us = tsr_node_timer_us(node_.get());
    if (timer_us == timer_at_us_ || timer_us == UINT64_MAX) {
        timer_at_us_ = timer_us;
        return;
    }
    timer_at_us_ = timer_us;
    around_.queue.at(timer_us, [this, timer_us] {
        if (timer_at_us_ == timer_us) {
            timer_at_us_ = UINT64_MAX;
            serve_mac();
        }
    });
}

void EmulatedNode::schedule_step(std::uint64_t time_us)
{
    time_us = std::max(time_us, busy_until_us_);
    if (time_us >= step_at_us_) {
        return;
    }
    step_at_us_ = time_us;
    around_.queue.at(time_us, [this, time_us] {
        if (step_at_us_ == time_us) {
            step_at_us_ = UINT64_MAX;
            step();
        }
    });
}

void EmulatedNode::step()
{
    const std::uint64_t now_us = around_.queue.now_us();
    const tsr_node_outcome outcome = tsr_node_step(node_.get(), now_us);
    note_phase();
    if (outcome.work != TSR_WORK_NONE) {
        const std::uint64_t took_us = work_time_us(around_.power, outcome.work, outcome.units);
        work_units_.at(outcome.work) += outcome.units;
        cpu_busy_us_ += took_us;
        busy_until_us_ = now_us + took_us;
    }
    serve_mac();
    if (outcome.wake_us != UINT64_MAX) {
        schedule_step(outcome.wake_us);
    }
}

void EmulatedNode::note_phase()
{
    const tsr_node_phase phase = tsr_node_get_phase(node_.get());
    if (phase != phase_) {
        phase_ = phase;
        if (around_.phase_changed) {
            around_.phase_changed({around_.queue.now_us(), id(), phase});
        }
    }
}

tsr_node_phase EmulatedNode::phase() const
{
    return tsr_node_get_phase(node_.get());
}

bool EmulatedNode::at_rest() const
{
    return tsr_node_get_phase(node_.get()) <= TSR_PHASE_WATCHING && tsr_node_is_quiet(node_.get());
}

const tsr_node_counters &EmulatedNode::counters() const
{
    return *tsr_node_get_counters(node_.get());
}

const tsr_mac_counters &EmulatedNode::mac_counters() const
{
    return *tsr_node_get_mac_counters(node_.get());
}

const tsr_sender_counters &EmulatedNode::sender_counters() const
{
    return *tsr_node_get_sender_counters(node_.get());
}

EnergyMj EmulatedNode::energy() const
{
    NodeTimes times;
    times.total_us = around_.queue.now_us();
    times.radio = around_.air.times(radio_);
    times.cpu_busy_us = cpu_busy_us_;
    for (const auto *camera : {left_.get(), right_.get()}) {
        times.cameras += camera != nullptr ? 1 : 0;
        times.captures += camera != nullptr ? camera->captures() : 0;
    }
    times.exposure_us = SourceCamera::kExposureUs;
    times.readout_us = SourceCamera::kReadoutUs;
    return energy_of(around_.power, times);
}

} // namespace tsr
