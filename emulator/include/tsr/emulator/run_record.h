/*
 * What a run gave, gathered in one place: summary.json, the CSV tables and the
 * page print the same records.
 *
 * The sink's side is read from the files it exported (sink.json, maps/): the
 * emulator knows nothing else of it. Times are virtual.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_RUN_RECORD_H
#define TSR_EMULATOR_RUN_RECORD_H

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tsr/emulator/battery.h"
#include "tsr/emulator/pictures.h"
#include "tsr/emulator/simulation.h"
#include "tsr/emulator/truth.h"

namespace tsr
{

/* One map the sink has. */
struct ReceivedMap {
    std::uint16_t node = 0;
    std::uint32_t counter = 0;
    std::uint64_t capture_time_us = 0;
    std::optional<std::uint64_t> commit_time_us; /* nothing: the run was stopped before the sink's answer */
    bool kept = false;
    std::size_t map_bytes = 0;
    std::size_t reference_bytes = 0;
    std::string file;              /* below the out folder, without ending */
    std::string ending = ".pfm";   /* of the file of numbers; of a baseline's, of its left picture */
    std::optional<MapError> error; /* where there is ground truth to compare a match with */

    std::optional<double> latency_s() const; /* from capture to commit */
};

/* One event of a zone that the sink has. */
struct ReceivedEvent {
    std::uint16_t node = 0;
    std::uint32_t counter = 0; /* of its message; several may share it */
    std::uint64_t capture_time_us = 0;
    std::optional<std::uint64_t> commit_time_us; /* as of a map */
    std::string zone;
    std::string kind;
    double area_percent = 0;
    std::optional<double> depth_m;
    std::optional<double> true_depth_m; /* of a surface that was measured: at the same instant, by ground truth */
};

struct NodeRecord {
    const SiteNode *site = nullptr;
    const SitePair *pair = nullptr; /* of a camera */
    int hops = 0;                   /* to the gateway */
    std::uint64_t lives = 0;
    tsr_node_counters counters{};
    tsr_mac_counters mac{};
    tsr_sender_counters sender{};
    AirTally air;
    EnergyMj energy;
    double active_mj = 0; /* of that, what was done because of changes */
    std::uint64_t powered_us = 0;
    double mean_uw = 0; /* of that time */
    BatteryLife life;
    std::array<std::uint64_t, TSR_WORK_COUNT> work_units{};
    std::size_t arena_len = 0;
    std::size_t maps_received = 0;
};

struct LinkRecord {
    std::uint16_t from = kNodeNone;
    std::uint16_t to = kNodeNone;
    int hops = 0; /* of the end that is further from the gateway */
    LinkTally tally;
    int rssi_dbm = 0; /* mean over fading */
    int snr_db = 0;
};

/* How the work of a camera that woke ended. */
enum class Fate {
    committed, /* the sink has the map */
    withheld,  /* it was like the last one */
    measured,  /* it was for the zones alone */
    lost,      /* the map was given up or refused */
    failed,    /* no map came of it: camera, partner or power failed */
    view,      /* a wing's: its lead waits for it */
    under_way  /* when the run ended */
};
const char *fate_name(Fate fate);

struct Episode { /* from waking to rest */
    std::uint16_t node = kNodeNone;
    std::uint64_t from_us = 0;
    std::uint64_t until_us = 0;
    Fate fate = Fate::under_way;
};

/* Of a sample: nearest ranks, so each is a value that occurred. */
struct Quantiles {
    std::size_t count = 0;
    double median = 0;
    double p95 = 0;
    double max = 0;
};

struct RunDigest { /* what one looks at first */
    Quantiles latency_s;
    Quantiles error_px; /* over maps, of each map's median error */
    Quantiles error_mm;
    std::optional<double> correct;           /* median over maps with an error of the part within 1 px */
    double active_mj = 0;                    /* of all nodes */
    double active_mj_per_map = 0;            /* for each map the sink has; 0 without any */
    std::uint16_t shortest_life = kNodeNone; /* a node with a battery that will be empty first; not the gateway */
    double shortest_life_days = 0;
    double median_life_days = 0; /* but for the gateway; infinite if most have no end */
    /* Frames and octets on air by place in kMessageNames, the last acknowledgements, and hops. */
    std::map<std::pair<std::size_t, int>, FrameTally> traffic;
};

/* What the command was told that changes results. */
struct RunSettings {
    std::string scenario;         /* its file's name, without folders; empty: a site was run */
    std::vector<std::string> set; /* of --set, but for the seed */
};

struct RunRecord {
    const Site *site = nullptr;             /* kept */
    const Simulation *simulation = nullptr; /* kept */
    std::vector<NodeRecord> nodes;          /* in the site's order */
    std::vector<LinkRecord> links;          /* used ones, by from and to */
    std::vector<ReceivedMap> maps;          /* by node and counter */
    std::vector<ReceivedEvent> zone_events; /* in the order of arrival */
    std::vector<Episode> episodes;          /* by their end; those under way last */
    std::vector<SceneEvent> events;         /* what the scene says of itself */
    RunDigest digest;
    RunSettings settings;
    unsigned sink_restarts = 0;
    double wall_time_s = 0;

    const NodeRecord *node(std::uint16_t id) const; /* null: none */
};

/* Reads the events in out's sink.json. Throws InputError. */
std::vector<ReceivedEvent> read_received_events(const Simulation &simulation, const std::filesystem::path &out);

/* true_depth_m of kTrueDepthsMax events at most, evenly over them: each takes a picture of the truth. Throws
 * InputError. */
inline constexpr std::size_t kTrueDepthsMax = 2000;
void find_true_depths(const Site &site, Pictures &pictures, std::vector<ReceivedEvent> &events);

/* Reads sink.json in out and compares each map with ground truth, where there is some. Throws InputError. */
std::vector<ReceivedMap> read_received_maps(const Site &site, const Simulation &simulation, Pictures &pictures,
                                            const std::filesystem::path &out);

/* Everything but settings, sink_restarts and wall_time_s; finds when maps and events were committed. */
RunRecord gather(const Site &site, const Simulation &simulation, const Pictures &pictures,
                 std::vector<ReceivedMap> maps, std::vector<ReceivedEvent> zone_events);

/* values are reordered. */
Quantiles quantiles_of(std::vector<double> &values);

} // namespace tsr

#endif
