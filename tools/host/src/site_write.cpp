/* Site to site.toml. SPDX-License-Identifier: Apache-2.0 */
#include <array>
#include <charconv>
#include <span>
#include <string>

#include "site_battery.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/site.h"

namespace tsr
{
namespace
{

/* The shortest text that reads back as the same double. */
std::string number(double value)
{
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

std::string quoted(const std::string &text)
{
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (byte < 0x20 || byte == 0x7f) {
            result += "\\u00";
            result += kHex[byte >> 4];
            result += kHex[byte & 15];
        } else {
            result += c;
        }
    }
    return result + "\"";
}

std::string list(std::span<const double> values)
{
    std::string text = "[";
    for (std::size_t i = 0; i < values.size(); i++) {
        text += (i == 0 ? "" : ", ") + number(values[i]);
    }
    return text + "]";
}

std::string line(const std::string &field, const std::string &value)
{
    return field + " = " + value + "\n";
}

std::string head_text(const Site &site)
{
    std::string text = "[site]\n";
    text += line("name", quoted(site.name));
    text += line("pan_id", std::to_string(site.pan_id));
    text += line("channel", std::to_string(site.channel));
    text += line("seed", std::to_string(site.seed));
    text += "\n[radio]\n";
    text += line("tx_power_dbm", number(site.radio.tx_power_dbm));
    text += line("reference_loss_db", number(site.radio.reference_loss_db));
    text += line("path_loss_exponent", number(site.radio.path_loss_exponent));
    text += line("shadowing_db", number(site.radio.shadowing_db));
    text += line("fading_db", number(site.radio.fading_db));
    text += line("fading_period_ms", std::to_string(site.radio.fading_period_ms));
    text += line("sensitivity_dbm", number(site.radio.sensitivity_dbm));
    text += line("capture_db", number(site.radio.capture_db));
    text += line("cca_threshold_dbm", number(site.radio.cca_threshold_dbm));
    text += line("frame_loss", number(site.radio.frame_loss));
    const SiteThresholds &limits = site.thresholds;
    text += "\n[thresholds]\n";
    text += line("similarity_px2", number(limits.similarity_px2));
    text += line("similarity_clip_px", number(limits.similarity_clip_px));
    text += line("similarity_blocks", std::to_string(limits.similarity_blocks));
    text += line("similarity_overlap_min", number(limits.similarity_overlap_min));
    text += line("change_deviation_min", std::to_string(limits.change_deviation_min));
    text += line("change_cells_min", std::to_string(limits.change_cells_min));
    text += "\n[battery]\n";
    for (const BatteryField &field : kBatteryFields) {
        text += line(field.name, number(site.battery.*field.value));
    }
    return text;
}

std::string node_text(const SiteNode &node)
{
    std::string text = "\n[[node]]\n";
    text += line("id", std::to_string(node.id));
    text += line("name", quoted(node.name));
    text += line("role", quoted(std::string(role_name(node.role))));
    if (node.parent != kNodeNone) {
        text += line("parent", std::to_string(node.parent));
    }
    text += line("position_m", list(node.position_m));
    if (!node.frames.empty()) {
        text += line("frames", quoted(node.frames.string()));
    }
    if (!node.frames_right.empty()) {
        text += line("frames_right", quoted(node.frames_right.string()));
    }
    text += line("watch_period_ms", std::to_string(node.watch_period_ms));
    text += line("start_ms", std::to_string(node.start_ms));
    std::string watch;
    for (const SiteRectangle &area : node.watch) {
        const std::array<double, 4> values{double(area.x), double(area.y), double(area.width), double(area.height)};
        watch += (watch.empty() ? "" : ", ") + list(values);
    }
    return watch.empty() ? text : text + line("watch", "[" + watch + "]");
}

std::string pose_text(const std::string &side, const SitePose &pose)
{
    return side + " = { position_m = " + list(pose.position_m) + ", rotation = " + list(pose.rotation) + " }\n";
}

std::string pair_text(const SitePair &pair)
{
    std::string text = "\n[[pair]]\n";
    text += line("name", quoted(pair.name));
    text += line("lead", std::to_string(pair.lead));
    if (pair.wing != kNodeNone) {
        text += line("wing", std::to_string(pair.wing));
    }
    text += line("width", std::to_string(pair.width));
    text += line("height", std::to_string(pair.height));
    text += line("disparities", std::to_string(pair.disparities));
    text += line("search_start_px", std::to_string(pair.search_start_px));
    text += line("d0_px", number(pair.d0_px));
    text += line("focal_px", number(pair.focal_px));
    text += line("baseline_mm", number(pair.baseline_mm));
    text += line("principal_px", list(pair.principal_px));
    text += pose_text("left", pair.left);
    if (pair.right) {
        text += pose_text("right", *pair.right);
    }
    text += line("step_px", number(pair.step_px));
    text += line("reference_image", pair.reference_image ? "true" : "false");
    text += line("reference_step", std::to_string(pair.reference_step));
    if (!pair.truth.empty()) {
        text += line("truth", quoted(pair.truth.string()));
    }
    return text;
}

std::string zone_text(const SitePair &pair, const SiteZone &zone)
{
    const SiteRectangle &part = zone.part;
    std::string text = "\n[[zone]]\n";
    text += line("pair", quoted(pair.name));
    text += line("name", quoted(zone.name));
    text += line("rectangle",
                 list(std::array<double, 4>{double(part.x), double(part.y), double(part.width), double(part.height)}));
    text += line(zone_field(zone.kind), number(zone.depth_m));
    text += line("area_percent", number(zone.area_percent));
    text += line("every_s", number(zone.every_s));
    return zone.kind == ZoneKind::changed ? text : text + line("hysteresis_percent", number(zone.hysteresis_percent));
}

/* What a kind does not have is left out: it would be refused. */
std::string fault_text(const SiteFault &fault)
{
    std::string text = "\n[[fault]]\n";
    text += line("at_s", number(static_cast<double>(fault.at_us) / 1e6));
    text += line("kind", quoted(std::string(fault_name(fault.kind))));
    if (fault.node != kNodeNone) {
        text += line("node", std::to_string(fault.node));
    }
    if (fault.for_us != 0) {
        text += line("for_s", number(static_cast<double>(fault.for_us) / 1e6));
    }
    if (fault.kind == SiteFaultKind::clock_drift) {
        text += line("ppm", std::to_string(fault.ppm));
    }
    if (fault.other != kNodeNone) {
        text += line("other", std::to_string(fault.other));
    }
    if (fault.kind == SiteFaultKind::link_loss) {
        text += line("loss_db", number(fault.loss_db)) + line("frame_loss", number(fault.frame_loss));
    }
    return fault.counter_start == 0 ? text : text + line("counter_start", std::to_string(fault.counter_start));
}

} // namespace

void write_site(const std::filesystem::path &file, const Site &site)
{
    std::string text = head_text(site);
    for (const SiteNode &node : site.nodes) {
        text += node_text(node);
    }
    for (const SitePair &pair : site.pairs) {
        text += pair_text(pair);
    }
    for (const SitePair &pair : site.pairs) {
        for (const SiteZone &zone : pair.zones) {
            text += zone_text(pair, zone);
        }
    }
    for (const SiteFault &fault : site.faults) {
        text += fault_text(fault);
    }
    write_file_atomically(file, text);
}

} // namespace tsr
