/*
 * One node of the emulator: the firmware's state machine with its cameras,
 * radio and processor in virtual time.
 *
 * The processor does one step at a time and is busy for as long as the step's
 * work takes; radio interrupts are served in between, as on a board.
 *
 * A node has a life from power-on to power-off. What a life has asked of the
 * queue, the air or a camera ends with it. Counters of the firmware go on from
 * one life to the next here, though the firmware forgets them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_EMULATED_NODE_H
#define TSR_EMULATOR_EMULATED_NODE_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tsr/emulator/baseline.h"
#include "tsr/emulator/energy.h"
#include "tsr/emulator/event_queue.h"
#include "tsr/emulator/node_clock.h"
#include "tsr/emulator/node_setup.h"
#include "tsr/emulator/pictures.h"
#include "tsr/hal/air.h"
#include "tsr/hal/source_camera.h"

namespace tsr
{

/* A node entered a phase. */
struct PhaseChange {
    std::uint64_t time_us = 0;
    std::uint16_t node = 0;
    tsr_node_phase phase = TSR_PHASE_IDLE;
    tsr_node_phase before = TSR_PHASE_IDLE;
};

class EmulatedNode
{
  public:
    struct Surroundings {
        EventQueue &queue;
        Air &air;
        const PowerModel &power;
        Pictures &pictures;
        std::uint64_t seed;
        const Baseline *baseline;                               /* kept; null: nodes that send maps */
        tsr_port port;                                          /* of a gateway */
        std::function<void(const PhaseChange &)> phase_changed; /* may be empty */
    };

    EmulatedNode(const Site &site, const SiteNode &node, const KeyRing &keys, Surroundings surroundings);
    ~EmulatedNode();
    EmulatedNode(const EmulatedNode &) = delete;
    EmulatedNode &operator=(const EmulatedNode &) = delete;

    /* Power on: the firmware starts with its configuration and unknown RAM. counter_start: in the place of the
     * configuration's, if not 0. Throws InputError if the firmware refuses to start. */
    void power_on(std::uint32_t counter_start = 0);
    void power_off();
    bool powered() const { return node_ != nullptr; }
    /* Power-ons until now. */
    std::uint64_t lives() const { return lives_; }
    /* From now on; above 0 its clock is fast. */
    void set_drift(int ppm);
    const NodeClock &clock() const { return clock_; }
    void set_camera_failing(bool failing);
    std::size_t radio_index() const { return radio_; }
    /* Bytes from the sink; without power they are lost. */
    void receive_from_port(const std::uint8_t *bytes, std::size_t len);

    std::uint16_t id() const { return site_node_.id; }
    const SiteNode &site_node() const { return site_node_; }
    std::uint64_t watch_period_us() const;
    tsr_node_phase phase() const;
    bool at_rest() const; /* idle or watching, no map owed, nothing under way in MAC or sender; or off */
    /* Of all lives. */
    tsr_node_counters counters() const;
    tsr_mac_counters mac_counters() const;
    tsr_sender_counters sender_counters() const;
    std::size_t arena_len() const { return arena_words_ * sizeof(arena_[0]); }
    /* Instructions done, by kind of work. */
    const std::array<std::uint64_t, TSR_WORK_COUNT> &work_units() const { return work_units_; }
    NodeTimes times() const; /* with power, until now */
    EnergyMj energy() const;
    /* Of what was done because of changes, mJ; heard_us: time on air of frames that this node got. */
    double active_mj(std::uint64_t heard_us) const;

  private:
    void add_camera(bool right);
    std::uint64_t local_us() const { return clock_.local_us(around_.queue.now_us()); }
    /* Do something at a time of the clock, if this life lasts until then. */
    template <typename Action> void at(std::uint64_t time_us, Action action);
    void attend();
    void schedule_step(std::uint64_t time_us);
    void step();
    bool streams() const { return around_.baseline != nullptr && around_.baseline->stream; }
    void take_views();
    std::uint64_t code_views(std::uint64_t most_us);
    void serve_mac();
    void note_phase(tsr_node_phase phase);
    static void fill_entropy(void *self, std::uint8_t *bytes, std::size_t len);

    const SiteNode &site_node_;
    const Site &site_;
    Surroundings around_;
    std::unique_ptr<NodeSetup> setup_;
    std::unique_ptr<tsr_node> node_;
    std::vector<std::uint64_t> arena_; /* empty without power */
    std::size_t arena_words_ = 0;
    std::size_t radio_ = 0;
    NodeClock clock_;
    std::unique_ptr<SourceCamera> left_;
    std::unique_ptr<SourceCamera> right_;
    std::uint64_t lives_ = 0;
    tsr_node_counters past_counters_{}; /* of the lives before */
    tsr_mac_counters past_mac_counters_{};
    tsr_sender_counters past_sender_counters_{};
    std::uint64_t random_ = 0;
    std::uint64_t busy_until_us_ = 0;
    std::uint64_t step_at_us_ = UINT64_MAX;  /* the step that is scheduled */
    std::uint64_t timer_at_us_ = UINT64_MAX; /* the MAC timer that is scheduled */
    std::uint64_t cpu_busy_us_ = 0;
    std::uint64_t cpu_watching_us_ = 0; /* of that, comparing frames with the background */
    std::uint64_t captures_watching_ = 0;
    CodedViews views_; /* of a baseline node, being coded */
    std::uint64_t coding_left_us_ = 0;
    std::array<std::uint64_t, TSR_WORK_COUNT> work_units_{};
    tsr_node_phase phase_ = TSR_PHASE_IDLE;
};

} // namespace tsr

#endif
