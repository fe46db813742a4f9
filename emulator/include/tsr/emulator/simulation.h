/*
 * One run: every node of a site, the air between them, the sink behind the
 * gateway, from power-on until the recordings are played and all is quiet.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_SIMULATION_H
#define TSR_EMULATOR_SIMULATION_H

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "tsr/emulator/emulated_node.h"
#include "tsr/emulator/event_queue.h"
#include "tsr/emulator/fault_timeline.h"
#include "tsr/emulator/sink_link.h"
#include "tsr/emulator/traffic.h"
#include "tsr/host/pcapng.h"

namespace tsr
{

/* What one sender put on air. */
struct AirTally {
    std::uint64_t frames = 0; /* acknowledgements included */
    std::uint64_t bytes = 0;  /* PSDU octets */
    std::uint64_t lost = 0;   /* not received by the addressed node */
    air::LossTally lost_by{}; /* of these, why; broadcasts have no cause */
};

class Simulation
{
  public:
    /* The sink's answer takes this long in virtual time, whatever it takes in
     * truth. */
    static constexpr std::uint64_t kSinkAnswerUs = 2000;
    /* Frames watched until the first map is on its way: four that teach the background, the fifth, and one to spare. */
    static constexpr std::uint64_t kFirstMapFrames = 6;
    /* After the last frame: time to deliver what is under way. */
    static constexpr std::uint64_t kPatienceUs = 120'000'000;

    /* Called after each event; false ends the run. */
    using Progress = std::function<bool(std::uint64_t now_us, std::uint64_t end_us)>;
    /* Watching is most of a long run's timeline; past this many changes only what leads to a map or a view is noted. */
    static constexpr std::size_t kWatchingNotedMax = 20'000;

    /* All are kept. Throws InputError for recordings or configurations that cannot be run. */
    Simulation(const Site &site, const KeyRing &keys, Pictures &pictures, SinkLink &sink,
               std::optional<Baseline> baseline = {});
    ~Simulation();
    Simulation(const Simulation &) = delete;
    Simulation &operator=(const Simulation &) = delete;

    /* Every frame on air goes there. capture is kept. Call before run(). */
    void record_air(PcapngCapture &capture) { capture_ = &capture; }
    /* Called before each event with its time; may wait; false ends the run before it. Call before run(). */
    void keep_pace(std::function<bool(std::uint64_t)> pace) { pace_ = std::move(pace); }
    void run(const Progress &progress);

    std::uint64_t duration_us() const { return queue_.now_us(); }
    /* How long there is something to see. */
    std::uint64_t played_us() const { return played_us_; }
    /* Progress has ended the run before that. */
    bool stopped() const { return stopped_; }
    const std::optional<Baseline> &baseline() const { return baseline_; }
    const std::vector<std::unique_ptr<EmulatedNode>> &nodes() const { return nodes_; }
    const std::vector<PhaseChange> &timeline() const { return timeline_; }
    /* Frames watched by all nodes in each second. */
    const std::vector<std::uint32_t> &looks_per_s() const { return looks_per_s_; }
    FaultTimeline &faults() { return *faults_; }
    const FaultTimeline &faults() const { return *faults_; }
    /* When a node's clock showed a time. */
    std::uint64_t virtual_us(std::uint16_t node, std::uint64_t local_us) const;
    const AirTally &air_tally(std::size_t node_index) const { return air_tallies_.at(node_index); }
    const Traffic &traffic() const { return traffic_; }
    const Air &air() const { return *air_; }
    /* Whether everything was delivered before patience ended. */
    bool quiet() const;

  private:
    static tsr_status write_port(void *self, const std::uint8_t *bytes, std::size_t len);
    static const tsr_port_ops kPortOps;

    const Site &site_;
    Pictures &pictures_;
    SinkLink &sink_;
    std::optional<Baseline> baseline_; /* nothing: nodes send maps */
    PowerModel power_;
    EventQueue queue_;
    std::unique_ptr<Air> air_;
    std::vector<std::unique_ptr<EmulatedNode>> nodes_;
    EmulatedNode *gateway_ = nullptr;
    std::unique_ptr<FaultTimeline> faults_;
    void note(const PhaseChange &change);

    std::vector<PhaseChange> timeline_;
    std::vector<std::uint32_t> looks_per_s_;
    std::vector<AirTally> air_tallies_;
    Traffic traffic_;
    std::uint64_t played_us_ = 0;
    bool stopped_ = false;
    mutable std::size_t last_busy_ = 0;       /* a node's index, where quiet() looks first */
    PcapngCapture *capture_ = nullptr;        /* may stay null */
    std::function<bool(std::uint64_t)> pace_; /* may stay empty */
};

} // namespace tsr

#endif
