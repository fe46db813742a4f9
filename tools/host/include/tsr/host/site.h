/*
 * A site: one deployment, read from site.toml (docs/units.md lists every field
 * with unit, range and default; keys live in a file of their own, keys.h).
 *
 * Camera axes: x right, y down, z forward. A pose takes camera coordinates to
 * site coordinates, p_site = R p_camera + position, R row-major.
 *
 * The node matches left pixel (x, y) with right pixel (x - d - search_start, y):
 *
 *   Z = f B / (d + d0)                            docs/math.md, eq. (4)
 *   d0 = search_start + cx_right - cx_left        eq. (3)
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_SITE_H
#define TSR_HOST_SITE_H

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tsr/host/fault.h"
#include "tsr/host/zone.h"

namespace tsr
{

inline constexpr std::uint16_t kNodeNone = 0; /* no such node: a gateway's parent, a binocular pair's wing */
inline constexpr std::uint16_t kNodeIdMax = 0xfffd;
inline constexpr std::uint32_t kWatchPeriodMsMax = 3'600'000; /* in us it fits the firmware's 32 bits */
inline constexpr std::uint32_t kStartMsMax = 86'400'000;
inline constexpr double kPositionMaxM = 1e6; /* of any coordinate */

enum class Role {
    gateway,  /* the root of the tree; joined to the sink by the gateway link */
    relay,    /* passes on what its children send */
    lead,     /* the node of a pair that matches; its camera is the left one */
    wing,     /* its partner, one hop away; sends its view to the lead */
    binocular /* two sensors on one board: left and right */
};

std::string_view role_name(Role role);
bool has_camera(Role role);

inline constexpr std::uint32_t kFadingPeriodMsMax = 3'600'000;

struct SiteRadio { /* the emulator's link budget: docs/radio.md */
    double tx_power_dbm = 0.0;
    double reference_loss_db = 40.0; /* at 1 m */
    double path_loss_exponent = 3.0;
    double shadowing_db = 0.0; /* standard deviation over links */
    double fading_db = 0.0;    /* standard deviation of a link over time */
    std::uint32_t fading_period_ms = 1000;
    double sensitivity_dbm = -95.0;   /* 1 % of frames with 20 octets are lost */
    double capture_db = 3.0;          /* over another frame, likewise */
    double cca_threshold_dbm = -85.0; /* not below the sensitivity; in a file by default 10 dB above it */
    double frame_loss = 0.0;          /* 0 .. 1, independent of the distance */
};

/* When is a frame a change, when are two maps the same scene (docs/math.md, eq. (6) to (9) and (20) to (22))?
 * The node and the sink apply the same rule to maps. */
struct SiteThresholds {
    double similarity_px2 = 3.0;         /* mean squared difference above which a block differs, 1/256 .. clip^2 */
    double similarity_clip_px = 2.0;     /* a difference counts as at most this, 1/16 .. 15.9375 */
    int similarity_blocks = 0;           /* differing blocks that make two maps differ; 0 = by the map's size */
    double similarity_overlap_min = 0.5; /* sink: below this part of pixels valid in both, of those in either: differ */
    int change_deviation_min = 5;        /* gray levels, 1 .. 64 */
    int change_cells_min = 0;            /* touching cells that wake the pair; 0 = the node's default */
};

/* What feeds each node, and the converter between it and the board; by default a Saft LS 26500 and a TPS62740
 * (docs/energy.md gives the sources). */
struct SiteBattery {
    double capacity_mah = 7700; /* nominal, of all its cells together */
    double voltage_v = 3.6;     /* under load */
    double usable_percent = 85; /* of the capacity, before the node stops */
    double self_discharge_percent_year = 1;
    double converter_efficiency_percent = 90;
    double converter_quiescent_ua = 0.46; /* drawn from the battery beside the load */
};

constexpr std::size_t kWatchMax = 4; /* rectangles */

struct SiteNode {
    std::uint16_t id = kNodeNone;
    std::string name; /* "node <id>" if the file gives none */
    Role role = Role::relay;
    std::uint16_t parent = kNodeNone;
    std::array<double, 3> position_m{};
    std::filesystem::path frames;       /* folder of the lead's, wing's or left camera's frames; may be empty */
    std::filesystem::path frames_right; /* binocular only */
    std::uint32_t watch_period_ms = 1000;
    std::uint32_t start_ms = 0;       /* power-on, virtual time */
    std::vector<SiteRectangle> watch; /* lead, binocular: where a change wakes; empty = everywhere */
    int line = 0;                     /* in site.toml; 0 = built in memory */
};

struct SitePose {
    std::array<double, 3> position_m{};
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

struct SitePair {
    std::string name;
    std::uint16_t lead = kNodeNone; /* or the binocular node */
    std::uint16_t wing = kNodeNone; /* kNodeNone for a binocular node */
    int width = 160;
    int height = 120;
    int disparities = 32;     /* searched: 0 .. disparities - 1 px */
    int search_start_px = 0;  /* the right view is shifted by this much on the node */
    double d0_px = 0.0;       /* signed; site.toml may leave it out, see above */
    double focal_px = 0.0;    /* of the rectified pair */
    double baseline_mm = 0.0; /* distance of the two cameras */
    std::array<double, 2> principal_px{};
    SitePose left;
    std::optional<SitePose> right;
    double step_px = 0.5;        /* the map's disparity step: 1/16, 1/8, 1/4, 1/2 or 1 */
    bool reference_image = true; /* send the gray left image that colours the map */
    int reference_step = 35;     /* its quantiser, 0 .. 63; 8 more double the steps of gray */
    std::vector<SiteZone> zones; /* in the order of the file; a node names them by it */
    std::filesystem::path truth; /* folder of PFM ground truth, for reports; may be empty */
    int line = 0;
};

struct Site {
    std::filesystem::path file; /* where it was read from; errors name it */
    std::string name;
    std::uint16_t pan_id = 0xbeef;
    int channel = 15; /* IEEE 802.15.4, 2.4 GHz: 11 .. 26 */
    std::uint64_t seed = 1;
    SiteRadio radio;
    SiteThresholds thresholds;
    SiteBattery battery;
    std::vector<SiteNode> nodes;
    std::vector<SitePair> pairs;
    std::vector<SiteFault> faults; /* in the order of the file */

    const SiteNode *node(std::uint16_t id) const;             /* null: no such node */
    const SiteNode &gateway() const;                          /* of a checked site */
    const SitePair *pair_of(std::uint16_t camera_node) const; /* by lead, wing or binocular id; null: none */
    /* A folder of the file, relative to site.toml's own folder. */
    std::filesystem::path resolve(const std::filesystem::path &folder) const;
};

/* Reads and checks file. Throws InputError: "site.toml:LINE: pair 'porch': right.rotation: reason". */
Site load_site(const std::filesystem::path &file);

/*
 * Refuses a site that cannot work: ids outside 1..0xfffd or used twice, an
 * unknown parent, a cycle, other than one gateway, a wing whose parent is not
 * its lead, a camera node without a pair, a pair of nodes that do not exist or
 * have other roles, cameras that are not rectified, faults of nodes that do not
 * exist, cannot have them or are dead by then, numbers out of range.
 * Throws InputError for the first fault found.
 */
void check_site(const Site &site);

/* Writes site as TOML that load_site() reads back equal. Throws InputError. */
void write_site(const std::filesystem::path &file, const Site &site);

} // namespace tsr

#endif
