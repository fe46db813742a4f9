/*
 * Faults that befall a run, each at its time (docs/faults.md).
 *
 * Several may last at once: losses of a link add up, a node stays off until the
 * last brown-out ends, a camera fails until the last failure ends; of two
 * drifts of one clock the later one counts, and when it ends the clock is right.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_FAULT_TIMELINE_H
#define TSR_EMULATOR_FAULT_TIMELINE_H

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "tsr/emulator/emulated_node.h"
#include "tsr/emulator/event_queue.h"
#include "tsr/emulator/sink_link.h"
#include "tsr/hal/air.h"
#include "tsr/host/fault.h"

namespace tsr
{

/* A fault that came. */
struct FaultNote {
    std::uint64_t time_us = 0;
    SiteFault fault;             /* node: the gateway, of a gateway restart */
    bool without_effect = false; /* a node without power cannot reboot */
};

class FaultTimeline
{
  public:
    struct World { /* all are kept */
        EventQueue &queue;
        Air &air;
        SinkLink &sink;
        const std::vector<std::unique_ptr<EmulatedNode>> &nodes;
        EmulatedNode &gateway;
    };

    explicit FaultTimeline(const World &world) : world_(world) {}

    /* All of a site, before time runs. */
    /* A node that is off until then. */
    void start_later(EmulatedNode &node, std::uint64_t time_us);
    void schedule(const std::vector<SiteFault> &faults);
    /* One, now, whatever its at_us says. */
    void strike(const SiteFault &fault);
    /* In order of time. */
    const std::vector<FaultNote> &notes() const { return notes_; }
    /* When all have come and those that end have ended. */
    static std::uint64_t last_us(const std::vector<SiteFault> &faults);

  private:
    struct State { /* of a node */
        bool dead = false;
        std::uint64_t off_until_us = 0;
        unsigned camera_failures = 0;
        unsigned drifts = 0; /* counts all that came */
    };

    EmulatedNode &node(std::uint16_t id);
    void kill(EmulatedNode &node);
    bool restart(EmulatedNode &node, const SiteFault &fault);
    void start_at(EmulatedNode &node, std::uint64_t time_us, std::uint32_t counter_start);
    void drift(EmulatedNode &node, const SiteFault &fault);
    void lose_link(EmulatedNode &node, const SiteFault &fault);
    void fail_camera(EmulatedNode &node, const SiteFault &fault);
    template <typename Action> void when_over(const SiteFault &fault, Action action);

    World world_;
    std::map<std::uint16_t, State> states_;
    std::vector<FaultNote> notes_;
};

} // namespace tsr

#endif
