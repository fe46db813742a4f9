/*
 * Building and running a site in virtual time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/simulation.h"

#include <algorithm>

namespace tsr
{

namespace
{

AirModel air_model(const Site &site)
{
    AirModel model;
    model.tx_power_dbm = site.radio.tx_power_dbm;
    model.reference_loss_db = site.radio.reference_loss_db;
    model.path_loss_exponent = site.radio.path_loss_exponent;
    model.shadowing_db = site.radio.shadowing_db;
    model.fading_db = site.radio.fading_db;
    model.fading_period_ms = site.radio.fading_period_ms;
    model.sensitivity_dbm = site.radio.sensitivity_dbm;
    model.capture_db = site.radio.capture_db;
    model.cca_threshold_dbm = site.radio.cca_threshold_dbm;
    model.frame_loss = site.radio.frame_loss;
    model.seed = site.seed;
    return model;
}

} // namespace

const tsr_port_ops Simulation::kPortOps = {&Simulation::write_port};

Simulation::Simulation(const Site &site, const KeyRing &keys, Pictures &pictures, SinkLink &sink,
                       std::optional<Baseline> baseline)
    : site_(site), pictures_(pictures), sink_(sink), baseline_(baseline), traffic_(site, keys)
{
    Air::Clock clock;
    clock.now_us = [this] { return queue_.now_us(); };
    clock.at = [this](std::uint64_t time_us, std::function<void()> action) { queue_.at(time_us, std::move(action)); };
    air_ = std::make_unique<Air>(air_model(site_), std::move(clock));
    for (const SiteNode &node : site_.nodes) {
        EmulatedNode::Surroundings around{
            queue_, *air_, power_, pictures_, site_.seed, baseline_ ? &*baseline_ : nullptr, {}, {}};
        if (node.role == Role::gateway) {
            around.port = {&kPortOps, this};
        }
        around.phase_changed = [this](const PhaseChange &change) { note(change); };
        nodes_.push_back(std::make_unique<EmulatedNode>(site_, node, keys, around));
        if (node.role == Role::gateway) {
            gateway_ = nodes_.back().get();
        }
    }
    faults_ = std::make_unique<FaultTimeline>(FaultTimeline::World{queue_, *air_, sink_, nodes_, *gateway_});
    air_tallies_.resize(nodes_.size());
    air_->set_tap([this](const AirFrame &frame) {
        AirTally &tally = air_tallies_.at(frame.sender);
        ++tally.frames;
        tally.bytes += frame.psdu_len;
        tally.lost += frame.lost_at;
        tally.lost_by.at(static_cast<std::size_t>(frame.cause)) += frame.lost_at;
        const bool acknowledges = frame.acknowledged != AirFrame::kNobody;
        traffic_.count(frame, nodes_[frame.sender]->id(), acknowledges ? nodes_[frame.acknowledged]->id() : kNodeNone);
        if (capture_ != nullptr) {
            capture_->add(frame.start_us, frame.channel, {frame.psdu, frame.psdu_len});
        }
    });
}

Simulation::~Simulation() = default;

/* Virtual time stands still while the real sink answers. */
tsr_status Simulation::write_port(void *self, const std::uint8_t *bytes, std::size_t len)
{
    auto &simulation = *static_cast<Simulation *>(self);
    auto answer = simulation.sink_.exchange(bytes, len);
    const std::uint64_t answered_us = simulation.queue_.now_us() + kSinkAnswerUs;
    simulation.traffic_.hear_sink(answered_us, answer);
    simulation.queue_.at(answered_us, [&gateway = *simulation.gateway_, life = simulation.gateway_->lives(),
                                       answer = std::move(answer)] {
        if (gateway.lives() == life) { /* what a port still held is lost with the power */
            gateway.receive_from_port(answer.data(), answer.size());
        }
    });
    return TSR_OK;
}

void Simulation::note(const PhaseChange &change)
{
    if (change.phase == TSR_PHASE_WATCHING) {
        const std::size_t second = change.time_us / 1'000'000;
        looks_per_s_.resize(std::max(looks_per_s_.size(), second + 1));
        ++looks_per_s_[second];
    }
    if (std::max(change.phase, change.before) > TSR_PHASE_WATCHING || timeline_.size() < kWatchingNotedMax) {
        timeline_.push_back(change);
    }
}

std::uint64_t Simulation::virtual_us(std::uint16_t node, std::uint64_t local_us) const
{
    const auto found =
        std::find_if(nodes_.begin(), nodes_.end(), [node](const auto &one) { return one->id() == node; });
    return found == nodes_.end() ? local_us : (*found)->clock().virtual_us(local_us);
}

bool Simulation::quiet() const
{
    if (!nodes_[last_busy_]->at_rest()) { /* asked after each event, and mostly it is still the same one */
        return false;
    }
    const auto busy = std::find_if(nodes_.begin(), nodes_.end(), [](const auto &node) { return !node->at_rest(); });
    last_busy_ = busy == nodes_.end() ? 0 : static_cast<std::size_t>(busy - nodes_.begin());
    return busy == nodes_.end();
}

void Simulation::run(const Progress &progress)
{
    std::uint64_t longest_period_us = 0;
    std::uint64_t latest_start_us = 0;
    for (const auto &node : nodes_) {
        const SiteNode &site_node = node->site_node();
        longest_period_us = std::max(longest_period_us, node->watch_period_us());
        if (site_node.start_ms > 0) {
            latest_start_us = std::max<std::uint64_t>(latest_start_us, site_node.start_ms * std::uint64_t{1000});
            faults_->start_later(*node, site_node.start_ms * std::uint64_t{1000});
        } else {
            node->power_on();
        }
    }
    faults_->schedule(site_.faults);
    /* Every watching node sees the last frame at least once, and however short a recording is, there is a first map,
     * also of a node that a fault has started anew. */
    const bool streams = baseline_ && baseline_->stream;
    played_us_ = std::max(pictures_.end_us() + (streams ? 0 : 2) * longest_period_us,
                          std::max(latest_start_us, FaultTimeline::last_us(site_.faults)) +
                              (streams ? 2 : kFirstMapFrames) * longest_period_us);
    const std::uint64_t latest_us = played_us_ + kPatienceUs;
    while (!queue_.empty() && queue_.next_us() <= latest_us) {
        if (queue_.next_us() > played_us_ && quiet()) {
            break;
        }
        if (pace_ && !pace_(queue_.next_us())) {
            stopped_ = true;
            break;
        }
        queue_.run_next();
        if (progress && !progress(queue_.now_us(), played_us_)) {
            stopped_ = true;
            break;
        }
    }
}

} // namespace tsr
