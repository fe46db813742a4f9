/*
 * scenario.toml to Scenario.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scenario/scenario.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "tsr/host/input_error.h"
#include "tsr/host/site_fields.h"

namespace tsr
{

namespace
{

constexpr double kDayS = 86'400;
constexpr int kCrowdMax = 10'000;     /* pairs */
constexpr double kAngleDegMax = 89.9; /* the axes meet; below 0 they would part */

std::string shown(double value)
{
    std::ostringstream text;
    text << value;
    return text.str();
}

/* A field that means nothing in this kind of scene is refused, as an unknown one. */
bool has_people(const std::string &kind)
{
    return kind != "tank";
}

bool has_sun(const std::string &kind)
{
    return kind == "house" || kind == "car" || kind == "street";
}

void read_scene(TomlFields &fields, scene::SceneOptions &scene)
{
    scene.kind = fields.string("kind");
    const auto &kinds = scene::scene_kinds();
    if (std::find(kinds.begin(), kinds.end(), scene.kind) == kinds.end()) {
        std::string known;
        for (const std::string &kind : kinds) {
            known += (known.empty() ? "" : ", ") + kind;
        }
        fields.refuse("kind", "'" + scene.kind + "' is none of " + known);
    }
    scene.clutter = fields.number("clutter", 0, 3, scene.clutter);
    scene.light_drift = fields.number("light_drift", 0, 0.9, scene.light_drift);
    scene.light_period_s = fields.number("light_period_s", 1, kDayS, scene.light_period_s);
    if (has_people(scene.kind)) {
        scene.people = static_cast<int>(fields.integer("people", 0, 20, scene.people));
    }
    if (scene.kind == "street") {
        scene.cars = static_cast<int>(fields.integer("cars", 0, 20, scene.cars));
    }
    if (has_sun(scene.kind)) {
        scene.sun_hours = fields.number("sun_hours", 0, 6, scene.sun_hours);
    }
    if (scene.kind == "tank") {
        scene.level_step_m = fields.number("level_step_m", 0.01, 0.8, scene.level_step_m);
        scene.level_rate_m_s = fields.number("level_rate_m_s", 0.0001, 1, scene.level_rate_m_s);
    }
    fields.refuse_unknown();
}

void read_layout(TomlFields &fields, scene::LayoutOptions &layout)
{
    layout.count = static_cast<int>(fields.integer("count", 1, 2000, layout.count));
    layout.distance_m = fields.number("distance_m", 0, 1000, layout.distance_m);
    std::array<double, 2> heights{};
    fields.numbers("heights_m", heights.data(), heights.size(), false);
    layout.height_low_m = heights[0];
    layout.height_high_m = heights[1];
    if (fields.has("heights_m") && !(heights[0] >= 0.1 && heights[0] <= heights[1] && heights[1] <= 100)) {
        fields.refuse("heights_m", "is not the lowest and the highest, 0.1 .. 100 m");
    }
}

void read_pairs(TomlFields &fields, ScenarioPairs &pairs)
{
    read_layout(fields, pairs.layout);
    const std::string boards = fields.string("boards", "one");
    if (boards != "one" && boards != "two") {
        fields.refuse("boards", "'" + boards + "' is neither one nor two");
    }
    pairs.two_boards = boards == "two";
    pairs.width = static_cast<int>(fields.integer("width", 16, 640, pairs.width));
    pairs.height = static_cast<int>(fields.integer("height", 16, 480, pairs.height));
    pairs.disparities = static_cast<int>(fields.integer("disparities", 16, 128, pairs.width > 160 ? 64 : 32));
    pairs.search_start_px = static_cast<int>(fields.integer("search_start_px", -640, 640, pairs.search_start_px));
    pairs.fov_deg = fields.has("fov_deg") ? fields.number("fov_deg", 10, 150) : 0;
    pairs.baseline_mm = fields.number("baseline_mm", 1, 10'000, pairs.baseline_mm);
    pairs.angle_deg = fields.number("angle_deg", 0, kAngleDegMax, pairs.angle_deg);
    pairs.watch_period_ms =
        static_cast<std::uint32_t>(fields.integer("watch_period_ms", 1, kWatchPeriodMsMax, pairs.watch_period_ms));
    pairs.step_px = fields.number("step_px", 0.0625, 1, pairs.step_px);
    pairs.reference_image = fields.boolean("reference_image", pairs.reference_image);
    pairs.reference_step = static_cast<int>(fields.integer("reference_step", 0, 63, pairs.reference_step));
    fields.refuse_unknown();
}

void read_camera(TomlFields &fields, ScenarioCamera &camera)
{
    const auto number = [&](const char *field, double minimum, double maximum, float &value) {
        value = static_cast<float>(fields.number(field, minimum, maximum, static_cast<double>(value)));
    };
    scene::SensorModel &sensor = camera.sensor;
    sensor.noise = fields.boolean("noise", sensor.noise);
    number("full_well_e", 100, 1e6, sensor.full_well_e);
    number("read_noise_e", 0, 1000, sensor.read_noise_e);
    number("vignetting", 0, 1, sensor.vignetting);
    sensor.exposure_control = fields.boolean("exposure_control", sensor.exposure_control);
    number("wanted_mean", 16, 240, sensor.wanted_mean);
    number("gain_max", 1, 64, sensor.gain_max);
    fields.numbers("distortion", camera.distortion.data(), camera.distortion.size(), false);
    camera.rolling_shutter_ms = fields.number("rolling_shutter_ms", 0, 1000, camera.rolling_shutter_ms);
    camera.jitter_us = fields.number("jitter_us", 0, 100'000, camera.jitter_us);
    fields.refuse_unknown();
}

constexpr double kSpacingMinM = 0.1;
constexpr double kAreaMaxM = 1e5;
constexpr double kSpacingM = 15; /* well within kReachM, so that a tree is found */

/* Two numbers of one range, the second not below the first if they are ordered. */
void read_range(TomlFields &fields, const char *field, double minimum, double maximum, bool ordered,
                std::array<double, 2> &values)
{
    fields.numbers(field, values.data(), values.size(), false);
    for (const double value : values) {
        if (!(value >= minimum && value <= maximum)) {
            fields.refuse(field, "is not two numbers of " + shown(minimum) + ".." + shown(maximum));
        }
    }
    if (ordered && values[0] > values[1]) {
        fields.refuse(field, "ends before it begins");
    }
}

void read_recorded(TomlFields &fields, ScenarioRecorded &recorded)
{
    recorded.site = fields.string("site");
    if (fields.has("area_m") && fields.has("spacing_m")) {
        fields.refuse("area_m", "stands beside spacing_m: pairs are on a grid or anywhere, not both");
    }
    if (fields.has("area_m")) {
        read_range(fields, "area_m", kSpacingMinM, kAreaMaxM, false, recorded.area_m);
    } else {
        recorded.spacing_m = fields.number("spacing_m", kSpacingMinM, 1000, kSpacingM);
    }
    recorded.pause_s = fields.number("pause_s", 0, kDayS, recorded.pause_s);
    recorded.offset_s = {0, kDayS};
    read_range(fields, "offset_s", 0, kDayS, true, recorded.offset_s);
    fields.refuse_unknown();
}

/* What the recorded site does not say of its own pairs. */
void read_recorded_pairs(TomlFields &fields, Scenario &scenario)
{
    ScenarioRecorded &recorded = *scenario.recorded;
    recorded.count = static_cast<int>(fields.integer("count", 1, kCrowdMax));
    if (fields.has("watch_period_ms")) {
        recorded.watch_period_ms = static_cast<std::uint32_t>(fields.integer("watch_period_ms", 1, kWatchPeriodMsMax));
    }
    if (fields.has("reference_image")) {
        recorded.reference_image = fields.boolean("reference_image", true);
    }
    recorded.start_within_s = fields.number("start_within_s", 0, kStartMsMax / 1000.0, recorded.start_within_s);
    if (recorded.start_within_s > scenario.scene.duration_s) {
        fields.refuse("start_within_s", "is after duration_s, the scenario's end");
    }
    fields.refuse_unknown();
}

/* A recording can be played on; a scenario says itself when it ends. */
void refuse_late_faults(const Scenario &scenario)
{
    for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
        const SiteFault &fault = scenario.faults[i];
        if (static_cast<double>(fault.at_us) > scenario.scene.duration_s * 1e6) {
            throw InputError(scenario.file.string() + ":" + std::to_string(fault.line),
                             "fault " + std::to_string(i + 1) + ": at_s", "is after duration_s, the scenario's end");
        }
    }
}

template <typename Read, typename Value> void read_table(TomlFields &top, const char *name, Read read, Value &value)
{
    if (auto fields = top.table(name)) {
        read(*fields, value);
    }
}

/* In the place of scene, pairs and camera. */
void read_crowd(TomlFields &top, Scenario &scenario)
{
    for (const char *other : {"scene", "camera"}) {
        if (top.has(other)) {
            top.refuse(other, "stands beside recorded: pictures are rendered or recorded, not both");
        }
    }
    if (!top.has("pairs")) {
        top.refuse("pairs", "is missing: recorded needs its count");
    }
    read_table(top, "recorded", read_recorded, scenario.recorded.emplace());
    read_table(top, "pairs", read_recorded_pairs, scenario);
}

} // namespace

bool is_scenario_file(const std::filesystem::path &file)
{
    const TomlFile toml(file);
    return toml.top().has("scene") || toml.top().has("recorded");
}

Scenario load_scenario(const std::filesystem::path &file, const std::vector<std::string> &settings)
{
    const TomlFile toml(file, settings);
    TomlFields top = toml.top();
    Scenario scenario;
    scenario.file = file;
    scenario.name = top.string("name");
    scenario.seed = static_cast<std::uint64_t>(
        top.integer("seed", 0, std::numeric_limits<std::int64_t>::max(), static_cast<std::int64_t>(scenario.seed)));
    scenario.scene.duration_s = top.number("duration_s", 10, kDayS, scenario.scene.duration_s);
    scenario.scene.seed = scenario.seed;
    if (top.has("recorded")) {
        read_crowd(top, scenario);
    } else if (top.has("scene")) {
        read_table(top, "scene", read_scene, scenario.scene);
        read_table(top, "pairs", read_pairs, scenario.pairs);
        read_table(top, "camera", read_camera, scenario.camera);
    } else {
        top.refuse("scene", "is missing, and so is recorded");
    }
    read_table(top, "radio", read_radio, scenario.radio);
    read_table(top, "thresholds", read_thresholds, scenario.thresholds);
    read_table(top, "battery", read_battery, scenario.battery);
    scenario.faults = read_faults(top);
    scenario.zones = read_zones(top, true);
    top.refuse_unknown();
    refuse_late_faults(scenario);
    return scenario;
}

} // namespace tsr
