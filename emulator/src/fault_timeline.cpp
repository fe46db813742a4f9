/* What each fault does to the run. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/fault_timeline.h"

#include <algorithm>

namespace tsr
{

void FaultTimeline::start_later(EmulatedNode &node, std::uint64_t time_us)
{
    states_[node.id()].off_until_us = time_us;
    start_at(node, time_us, 0);
}

void FaultTimeline::schedule(const std::vector<SiteFault> &faults)
{
    for (const SiteFault &fault : faults) {
        world_.queue.at(fault.at_us, [this, fault] { strike(fault); });
    }
}

std::uint64_t FaultTimeline::last_us(const std::vector<SiteFault> &faults)
{
    std::uint64_t last_us = 0;
    for (const SiteFault &fault : faults) {
        last_us = std::max(last_us, fault.at_us + fault.for_us);
    }
    return last_us;
}

EmulatedNode &FaultTimeline::node(std::uint16_t id)
{
    return **std::find_if(world_.nodes.begin(), world_.nodes.end(), [id](const auto &one) { return one->id() == id; });
}

/* What ends for ever needs no event. */
template <typename Action> void FaultTimeline::when_over(const SiteFault &fault, Action action)
{
    if (fault.for_us != 0) {
        world_.queue.at(world_.queue.now_us() + fault.for_us, std::move(action));
    }
}

void FaultTimeline::strike(const SiteFault &fault)
{
    FaultNote note{world_.queue.now_us(), fault, false};
    if (fault.kind == SiteFaultKind::gateway_restart) {
        note.fault.node = world_.gateway.id();
    }
    if (fault.kind == SiteFaultKind::sink_restart) {
        world_.sink.restart();
        notes_.push_back(note);
        return;
    }
    EmulatedNode &struck = node(note.fault.node);
    switch (fault.kind) {
    case SiteFaultKind::death: kill(struck); break;
    case SiteFaultKind::reboot:
    case SiteFaultKind::brown_out:
    case SiteFaultKind::gateway_restart: note.without_effect = !restart(struck, fault); break;
    case SiteFaultKind::clock_drift: drift(struck, fault); break;
    case SiteFaultKind::link_loss: lose_link(struck, fault); break;
    case SiteFaultKind::camera_failure: fail_camera(struck, fault); break;
    case SiteFaultKind::sink_restart: break;
    }
    notes_.push_back(note);
}

void FaultTimeline::kill(EmulatedNode &node)
{
    states_[node.id()].dead = true;
    node.power_off();
}

/* False: it is off, and stays so as long as it would have. */
bool FaultTimeline::restart(EmulatedNode &node, const SiteFault &fault)
{
    State &state = states_[node.id()];
    const std::uint64_t back_us = world_.queue.now_us() + fault.for_us;
    if (!node.powered() && back_us <= state.off_until_us) {
        return false;
    }
    if (state.dead) {
        return false;
    }
    node.power_off();
    if (fault.for_us == 0) {
        node.power_on(fault.counter_start);
        return true;
    }
    state.off_until_us = back_us;
    start_at(node, back_us, fault.counter_start);
    return true;
}

/* Unless it is dead by then, or has been off for longer. */
void FaultTimeline::start_at(EmulatedNode &node, std::uint64_t time_us, std::uint32_t counter_start)
{
    world_.queue.at(time_us, [this, &node, time_us, counter_start] {
        const State &then = states_[node.id()];
        if (!then.dead && then.off_until_us == time_us) {
            node.power_on(counter_start);
        }
    });
}

void FaultTimeline::drift(EmulatedNode &node, const SiteFault &fault)
{
    const unsigned number = ++states_[node.id()].drifts;
    node.set_drift(fault.ppm);
    when_over(fault, [this, &node, number] {
        if (states_[node.id()].drifts == number) {
            node.set_drift(0);
        }
    });
}

void FaultTimeline::lose_link(EmulatedNode &struck, const SiteFault &fault)
{
    const std::size_t other = fault.other == 0 ? air::kEveryRadio : node(fault.other).radio_index();
    const std::size_t number = world_.air.losses().begin(struck.radio_index(), other, fault.loss_db, fault.frame_loss);
    when_over(fault, [this, number] { world_.air.losses().end(number); });
}

void FaultTimeline::fail_camera(EmulatedNode &node, const SiteFault &fault)
{
    ++states_[node.id()].camera_failures;
    node.set_camera_failing(true);
    when_over(fault, [this, &node] {
        if (--states_[node.id()].camera_failures == 0) {
            node.set_camera_failing(false);
        }
    });
}

} // namespace tsr
