/*
 * A scenario: a virtual scene or recorded frames, the pairs that watch, and the world around
 * them, read from scenario.toml (docs/units.md lists every field with
 * unit, range and default).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_SCENARIO_H
#define TSR_SCENARIO_SCENARIO_H

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tsr/host/site.h"
#include "tsr/scene/scene.h"
#include "tsr/scene/sensor.h"

namespace tsr
{

struct ScenarioPairs {
    scene::LayoutOptions layout;
    bool two_boards = false; /* a lead and a wing, one camera each; otherwise one binocular node */
    int width = 160;
    int height = 120;
    int disparities = 32;
    int search_start_px = 0;
    double fov_deg = 0; /* horizontal; 0: the scene's own */
    double baseline_mm = 60;
    double angle_deg = 0; /* between the optical axes, which meet; the views are those after rectification */
    std::uint32_t watch_period_ms = 1000;
    double step_px = 0.5;
    bool reference_image = true;
    int reference_step = 35;
};

struct ScenarioCamera {
    scene::SensorModel sensor;
    std::array<double, 4> distortion{}; /* k1, k2, p1, p2 */
    double rolling_shutter_ms = 0;      /* from the first row to the last */
    double jitter_us = 0;               /* the right camera is up to this early or late */
};

/* Instead of a scene: the pairs of a recorded site, shared out among many (tsr/scenario/crowd.h). */
struct ScenarioRecorded {
    std::filesystem::path site; /* whose nodes have folders of frames */
    int count = 0;              /* pairs */
    double spacing_m = 0;       /* of a square grid of pairs; 0: they stand anywhere in area_m */
    std::array<double, 2> area_m{};
    double pause_s = 0;                /* between two rounds of a recording, of its first two frames */
    std::array<double, 2> offset_s{};  /* each pair enters its rounds at an instant between these */
    double start_within_s = 0;         /* until all are switched on, from the gateway outwards */
    std::uint32_t watch_period_ms = 0; /* 0: the recorded site's; likewise without a value: */
    std::optional<bool> reference_image;
};

struct Scenario {
    std::filesystem::path file; /* errors name it */
    std::string name;
    std::uint64_t seed = 1;
    std::optional<ScenarioRecorded> recorded; /* then neither scene's kind nor pairs nor camera mean anything */
    scene::SceneOptions scene;                /* duration_s is the scenario's */
    ScenarioPairs pairs;
    ScenarioCamera camera;
    SiteRadio radio;
    SiteThresholds thresholds;
    SiteBattery battery;
    std::vector<SiteFault> faults; /* of nodes as stage_scenario() or stage_crowd() numbers them */
    std::vector<SiteZone> zones;   /* of pairs as it names them; of every pair if they name none */
};

/* Is it a scenario, not a site? By its having a [scene] or [recorded]. Throws InputError if it is no TOML. */
bool is_scenario_file(const std::filesystem::path &file);

/* settings: "table.field = value" in the place of what the file says. Throws InputError: "file:LINE: table: field:
 * reason". */
Scenario load_scenario(const std::filesystem::path &file, const std::vector<std::string> &settings);

} // namespace tsr

#endif
