/* site.toml to Site. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/site.h"

#include <cmath>
#include <limits>

#include "site_battery.h"
#include "tsr/host/site_fields.h"
#include "tsr/host/toml_fields.h"

namespace tsr
{
namespace
{

constexpr double kAnyLarge = 1e9;
constexpr int kWatchSideMax = 640; /* the widest picture; the pair's own is checked later */

void read_site(TomlFields &fields, Site &site)
{
    site.name = fields.string("name");
    site.pan_id = static_cast<std::uint16_t>(fields.integer("pan_id", 0, 0xfffe, site.pan_id));
    site.channel = static_cast<int>(fields.integer("channel", 11, 26, site.channel));
    site.seed = static_cast<std::uint64_t>(
        fields.integer("seed", 0, std::numeric_limits<std::int64_t>::max(), static_cast<std::int64_t>(site.seed)));
    fields.refuse_unknown();
}

Role read_role(TomlFields &fields)
{
    const std::string text = fields.string("role");
    for (const Role role : {Role::gateway, Role::relay, Role::lead, Role::wing, Role::binocular}) {
        if (text == role_name(role)) {
            return role;
        }
    }
    fields.refuse("role", "'" + text + "' is not gateway, relay, lead, wing or binocular");
}

std::uint16_t read_id(TomlFields &fields, std::string_view field, std::optional<std::int64_t> fallback = {})
{
    return static_cast<std::uint16_t>(fields.integer(field, 1, kNodeIdMax, fallback));
}

SiteNode read_node(TomlFields &fields)
{
    SiteNode node;
    node.line = fields.line();
    node.id = read_id(fields, "id");
    node.name = fields.string("name", "node " + std::to_string(node.id));
    fields.set_prefix("node " + std::to_string(node.id));
    node.role = read_role(fields);
    node.parent = read_id(fields, "parent", kNodeNone);
    fields.numbers("position_m", node.position_m.data(), node.position_m.size(), false);
    node.frames = fields.string("frames", "");
    node.frames_right = fields.string("frames_right", "");
    node.watch_period_ms =
        static_cast<std::uint32_t>(fields.integer("watch_period_ms", 1, kWatchPeriodMsMax, node.watch_period_ms));
    node.start_ms = static_cast<std::uint32_t>(fields.integer("start_ms", 0, kStartMsMax, node.start_ms));
    for (const auto &[x, y, width, height] : fields.lists<4>("watch", 0, kWatchSideMax)) {
        node.watch.push_back({x, y, width, height});
    }
    fields.refuse_unknown();
    return node;
}

SitePose read_pose(TomlFields &fields)
{
    SitePose pose;
    fields.numbers("position_m", pose.position_m.data(), pose.position_m.size(), true);
    fields.numbers("rotation", pose.rotation.data(), pose.rotation.size(), false);
    return pose;
}

/* Crops of large sensors and converging cameras have it outside the picture, but not beyond so many pictures. */
constexpr int kPrincipalMax = 8;

void read_principal(TomlFields &fields, const SitePair &pair, std::array<double, 2> &principal_px)
{
    fields.numbers("principal_px", principal_px.data(), principal_px.size(), false);
    if (std::abs(principal_px[0]) > kPrincipalMax * pair.width ||
        std::abs(principal_px[1]) > kPrincipalMax * pair.height) {
        fields.refuse("principal_px", "is farther than " + std::to_string(kPrincipalMax) + " times the pair's " +
                                          std::to_string(pair.width) + "x" + std::to_string(pair.height) +
                                          " from the first pixel");
    }
}

/* d0 stands in the file, follows from the right principal point, or both agree. */
void read_offset(TomlFields &fields, TomlFields *right, SitePair &pair)
{
    double derived = pair.search_start_px;
    const bool right_principal = right != nullptr && right->has("principal_px");
    if (right_principal) {
        std::array<double, 2> principal_px{};
        read_principal(*right, pair, principal_px);
        derived += principal_px[0] - pair.principal_px[0];
    }
    pair.d0_px = fields.number("d0_px", -2047, 2047, derived);
    if (right_principal && std::abs(pair.d0_px - derived) > 0.01) {
        fields.refuse("d0_px",
                      "is not search_start_px plus the difference of the principal points, " + std::to_string(derived));
    }
}

SitePair read_pair(TomlFields &fields)
{
    SitePair pair;
    pair.line = fields.line();
    pair.name = fields.string("name");
    fields.set_prefix("pair '" + pair.name + "'");
    pair.lead = read_id(fields, "lead");
    pair.wing = read_id(fields, "wing", kNodeNone);
    pair.width = static_cast<int>(fields.integer("width", 16, 640));
    pair.height = static_cast<int>(fields.integer("height", 16, 480));
    pair.disparities = static_cast<int>(fields.integer("disparities", 16, 128));
    pair.search_start_px = static_cast<int>(fields.integer("search_start_px", -640, 640, 0));
    pair.focal_px = fields.number("focal_px", 1, kAnyLarge);
    pair.baseline_mm = fields.number("baseline_mm", 0.001, kAnyLarge);
    pair.principal_px = {(pair.width - 1) / 2.0, (pair.height - 1) / 2.0};
    read_principal(fields, pair, pair.principal_px);
    if (auto left = fields.table("left")) {
        pair.left = read_pose(*left);
        left->refuse_unknown();
    }
    auto right = fields.table("right");
    if (right) {
        pair.right = read_pose(*right);
    }
    read_offset(fields, right.get(), pair);
    if (right) {
        right->refuse_unknown();
    }
    pair.step_px = fields.number("step_px", 0.0625, 1, pair.step_px);
    pair.reference_image = fields.boolean("reference_image", pair.reference_image);
    pair.reference_step = static_cast<int>(fields.integer("reference_step", 0, 63, pair.reference_step));
    pair.truth = fields.string("truth", "");
    fields.refuse_unknown();
    return pair;
}

} // namespace

void read_radio(TomlFields &fields, SiteRadio &radio)
{
    radio.tx_power_dbm = fields.number("tx_power_dbm", -40, 30, radio.tx_power_dbm);
    radio.reference_loss_db = fields.number("reference_loss_db", 0, 120, radio.reference_loss_db);
    radio.path_loss_exponent = fields.number("path_loss_exponent", 1, 8, radio.path_loss_exponent);
    radio.shadowing_db = fields.number("shadowing_db", 0, 20, radio.shadowing_db);
    radio.fading_db = fields.number("fading_db", 0, 20, radio.fading_db);
    radio.fading_period_ms =
        static_cast<std::uint32_t>(fields.integer("fading_period_ms", 1, kFadingPeriodMsMax, radio.fading_period_ms));
    radio.sensitivity_dbm = fields.number("sensitivity_dbm", -140, 0, radio.sensitivity_dbm);
    radio.capture_db = fields.number("capture_db", 0, 20, radio.capture_db);
    /* Below the sensitivity it would take the noise for a busy channel; the standard allows 10 dB above. */
    radio.cca_threshold_dbm = fields.number("cca_threshold_dbm", radio.sensitivity_dbm, 10, radio.sensitivity_dbm + 10);
    radio.frame_loss = fields.number("frame_loss", 0, 1, radio.frame_loss);
    fields.refuse_unknown();
}

void read_thresholds(TomlFields &fields, SiteThresholds &limits)
{
    limits.similarity_px2 = fields.number("similarity_px2", 1.0 / 256, 254, limits.similarity_px2);
    limits.similarity_clip_px = fields.number("similarity_clip_px", 0.0625, 15.9375, limits.similarity_clip_px);
    limits.similarity_blocks =
        static_cast<int>(fields.integer("similarity_blocks", 0, 65535, limits.similarity_blocks));
    limits.similarity_overlap_min = fields.number("similarity_overlap_min", 0, 1, limits.similarity_overlap_min);
    limits.change_deviation_min =
        static_cast<int>(fields.integer("change_deviation_min", 1, 64, limits.change_deviation_min));
    limits.change_cells_min = static_cast<int>(fields.integer("change_cells_min", 0, 65535, limits.change_cells_min));
    fields.refuse_unknown();
}

void read_battery(TomlFields &fields, SiteBattery &battery)
{
    for (const BatteryField &field : kBatteryFields) {
        battery.*field.value = fields.number(field.name, field.minimum, field.maximum, battery.*field.value);
    }
    fields.refuse_unknown();
}

Site load_site(const std::filesystem::path &file)
{
    const TomlFile toml(file);
    TomlFields top = toml.top();
    Site site;
    site.file = file;
    auto general = top.table("site");
    if (!general) {
        top.refuse("site", "is missing");
    }
    read_site(*general, site);
    if (auto radio = top.table("radio")) {
        read_radio(*radio, site.radio);
    }
    if (auto thresholds = top.table("thresholds")) {
        read_thresholds(*thresholds, site.thresholds);
    }
    if (auto battery = top.table("battery")) {
        read_battery(*battery, site.battery);
    }
    for (TomlFields &fields : top.tables("node")) {
        site.nodes.push_back(read_node(fields));
    }
    for (TomlFields &fields : top.tables("pair")) {
        site.pairs.push_back(read_pair(fields));
    }
    site.faults = read_faults(top);
    place_zones(site, read_zones(top, false));
    top.refuse_unknown();
    check_site(site);
    return site;
}

} // namespace tsr
