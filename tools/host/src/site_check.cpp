/* What makes a site workable: ids, tree, roles, numbers. SPDX-License-Identifier: Apache-2.0 */
#include "site_faults.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "site_battery.h"
#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr std::size_t kNameMax = 64;

using NodeIndex = std::map<std::uint16_t, const SiteNode *>;

NodeIndex index_nodes(const Site &site)
{
    NodeIndex index;
    for (const SiteNode &node : site.nodes) {
        if (node.id < 1 || node.id > kNodeIdMax) {
            refuse_node(site, node, "id", "is outside 1..65533");
        }
        if (!index.emplace(node.id, &node).second) {
            refuse_node(site, node, "id", "is used twice");
        }
        if (const std::string fault = fault_in_name(node.name); !fault.empty()) {
            refuse_node(site, node, "name", fault);
        }
        if (node.watch_period_ms < 1 || node.watch_period_ms > kWatchPeriodMsMax) {
            refuse_node(site, node, "watch_period_ms", "is outside 1.." + std::to_string(kWatchPeriodMsMax));
        }
        if (node.start_ms > kStartMsMax) {
            refuse_node(site, node, "start_ms", "is outside 0.." + std::to_string(kStartMsMax));
        }
        for (const double metres : node.position_m) {
            if (!(std::abs(metres) <= kPositionMaxM)) {
                refuse_node(site, node, "position_m", "is farther than 1000 km");
            }
        }
        if (!node.frames.empty() && !has_camera(node.role)) {
            refuse_node(site, node, "frames", "a " + std::string(role_name(node.role)) + " has no camera");
        }
        if (!node.frames_right.empty() && node.role != Role::binocular) {
            refuse_node(site, node, "frames_right", "only a binocular node has a right camera");
        }
        if (!node.watch.empty() && node.role != Role::lead && node.role != Role::binocular) {
            refuse_node(site, node, "watch", "a " + std::string(role_name(node.role)) + " does not watch");
        }
        if (node.role == Role::binocular && node.frames.empty() != node.frames_right.empty()) {
            refuse_node(site, node, "frames_right", "frames and frames_right come together");
        }
    }
    return index;
}

void check_gateway(const Site &site)
{
    const SiteNode *gateway = nullptr;
    for (const SiteNode &node : site.nodes) {
        if (node.role == Role::gateway && gateway != nullptr) {
            refuse_node(site, node, "role",
                        "node " + std::to_string(gateway->id) + " is the gateway already; there is exactly one");
        }
        if (node.role == Role::gateway) {
            gateway = &node;
        }
    }
    if (gateway == nullptr) {
        refuse_site(site, 0, "node", "no node has role = \"gateway\"");
    }
    if (gateway->parent != kNodeNone) {
        refuse_node(site, *gateway, "parent", "the gateway is the root of the tree");
    }
}

void check_tree(const Site &site, const NodeIndex &index)
{
    for (const SiteNode &node : site.nodes) {
        if (node.role == Role::gateway) {
            continue;
        }
        if (node.parent == kNodeNone) {
            refuse_node(site, node, "parent", "is missing; only the gateway has none");
        }
        const auto parent = index.find(node.parent);
        if (parent == index.end()) {
            refuse_node(site, node, "parent", "there is no node " + std::to_string(node.parent));
        }
        if (parent->second->role == Role::wing) {
            refuse_node(site, node, "parent",
                        "node " + std::to_string(node.parent) + " is a wing and forwards nothing");
        }
    }
    /* Every way up ends at the gateway, or it is longer than there are nodes. */
    std::set<std::uint16_t> reaches_gateway;
    for (const SiteNode &node : site.nodes) {
        std::set<std::uint16_t> way;
        const SiteNode *at = &node;
        while (at->role != Role::gateway && !reaches_gateway.contains(at->id)) {
            if (!way.insert(at->id).second) {
                refuse_node(site, node, "parent",
                            "the way to the gateway runs in a circle through node " + std::to_string(at->id));
            }
            at = index.at(at->parent);
        }
        reaches_gateway.merge(way);
    }
}

void check_pair_nodes(const Site &site, const SitePair &pair, const NodeIndex &index)
{
    const auto lead = index.find(pair.lead);
    if (lead == index.end()) {
        refuse_pair(site, pair, "lead", "there is no node " + std::to_string(pair.lead));
    }
    const bool binocular = lead->second->role == Role::binocular;
    if (!binocular && lead->second->role != Role::lead) {
        refuse_pair(site, pair, "lead",
                    "node " + std::to_string(pair.lead) + " is a " + std::string(role_name(lead->second->role)));
    }
    if (binocular) {
        if (pair.wing != kNodeNone) {
            refuse_pair(site, pair, "wing", "a binocular node has both cameras on one board");
        }
        return;
    }
    if (pair.wing == kNodeNone) {
        refuse_pair(site, pair, "wing", "is missing");
    }
    const auto wing = index.find(pair.wing);
    if (wing == index.end()) {
        refuse_pair(site, pair, "wing", "there is no node " + std::to_string(pair.wing));
    }
    if (wing->second->role != Role::wing) {
        refuse_pair(site, pair, "wing",
                    "node " + std::to_string(pair.wing) + " is a " + std::string(role_name(wing->second->role)));
    }
    if (wing->second->parent != pair.lead) {
        refuse_node(site, *wing->second, "parent",
                    "is " + std::to_string(wing->second->parent) + ", but a wing's parent is its lead, " +
                        std::to_string(pair.lead));
    }
}

void check_watch(const Site &site, const SiteNode &node, const SitePair &pair)
{
    if (node.watch.size() > kWatchMax) {
        refuse_node(site, node, "watch",
                    std::to_string(node.watch.size()) + " rectangles, not at most " + std::to_string(kWatchMax));
    }
    for (const SiteRectangle &area : node.watch) {
        if (const std::string fault = fault_in_rectangle(area, pair); !fault.empty()) {
            refuse_node(site, node, "watch", fault);
        }
    }
}

void check_pair_numbers(const Site &site, const SitePair &pair)
{
    if (const std::string fault = fault_in_name(pair.name); !fault.empty()) {
        refuse_pair(site, pair, "name", fault);
    }
    if (pair.width < 16 || pair.width > 640 || pair.height < 16 || pair.height > 480) {
        refuse_pair(site, pair, "width", "an image is 16x16 to 640x480");
    }
    /* The node's matcher searches no other counts: tsr/vision/match.h. */
    if (pair.disparities < 16 || pair.disparities > 128 || pair.disparities % 8 != 0 || pair.disparities > pair.width) {
        refuse_pair(site, pair, "disparities", "is not a multiple of 8 in 16..128, at most the width");
    }
    if (std::abs(pair.search_start_px) > pair.width - pair.disparities) {
        refuse_pair(site, pair, "search_start_px",
                    "is outside -" + std::to_string(pair.width - pair.disparities) + ".." +
                        std::to_string(pair.width - pair.disparities) + ", width - disparities");
    }
    if (!(pair.focal_px >= 1 && pair.focal_px <= 1e6)) {
        refuse_pair(site, pair, "focal_px", "is not positive");
    }
    if (!(pair.baseline_mm >= 0.001 && pair.baseline_mm <= 1e9)) {
        refuse_pair(site, pair, "baseline_mm", "is not positive");
    }
    if (!(std::abs(pair.d0_px) <= 2047)) {
        refuse_pair(site, pair, "d0_px", "is outside -2047..2047");
    }
    if (!(pair.disparities - 1 + pair.d0_px > 0)) {
        refuse_pair(site, pair, "d0_px", "no searched disparity gives a finite depth: d + d0 <= 0");
    }
    const double sixteenths = pair.step_px * 16;
    if (sixteenths != 1 && sixteenths != 2 && sixteenths != 4 && sixteenths != 8 && sixteenths != 16) {
        refuse_pair(site, pair, "step_px", "is not 1/16, 1/8, 1/4, 1/2 or 1");
    }
    if (pair.reference_step < 0 || pair.reference_step > 63) {
        refuse_pair(site, pair, "reference_step", "is outside 0..63");
    }
}

void check_pairs(const Site &site, const NodeIndex &index)
{
    std::set<std::string> names;
    std::set<std::uint16_t> paired;
    for (const SitePair &pair : site.pairs) {
        check_pair_numbers(site, pair);
        check_pair_nodes(site, pair, index);
        check_watch(site, *index.at(pair.lead), pair);
        check_pair_geometry(site, pair);
        if (!names.insert(pair.name).second) {
            refuse_pair(site, pair, "name", "is used twice");
        }
        if (!paired.insert(pair.lead).second) {
            refuse_pair(site, pair, "lead", "node " + std::to_string(pair.lead) + " is in another pair");
        }
        if (pair.wing != kNodeNone && !paired.insert(pair.wing).second) {
            refuse_pair(site, pair, "wing", "node " + std::to_string(pair.wing) + " is in another pair");
        }
    }
    for (const SiteNode &node : site.nodes) {
        if (has_camera(node.role) && !paired.contains(node.id)) {
            refuse_node(site, node, "role", "a " + std::string(role_name(node.role)) + " that no [[pair]] names");
        }
    }
}

void check_radio(const Site &site)
{
    const SiteRadio &radio = site.radio;
    if (!(radio.frame_loss >= 0 && radio.frame_loss <= 1)) {
        refuse_site(site, 0, "radio.frame_loss", "is outside 0..1");
    }
    if (!(radio.shadowing_db >= 0 && radio.shadowing_db <= 20)) {
        refuse_site(site, 0, "radio.shadowing_db", "is outside 0..20");
    }
    if (!(radio.fading_db >= 0 && radio.fading_db <= 20)) {
        refuse_site(site, 0, "radio.fading_db", "is outside 0..20");
    }
    if (radio.fading_period_ms < 1 || radio.fading_period_ms > kFadingPeriodMsMax) {
        refuse_site(site, 0, "radio.fading_period_ms", "is outside 1.." + std::to_string(kFadingPeriodMsMax));
    }
    if (!(radio.capture_db >= 0 && radio.capture_db <= 20)) {
        refuse_site(site, 0, "radio.capture_db", "is outside 0..20");
    }
    if (!(radio.cca_threshold_dbm >= radio.sensitivity_dbm)) {
        refuse_site(site, 0, "radio.cca_threshold_dbm", "is below sensitivity_dbm");
    }
}

void check_battery(const Site &site)
{
    for (const BatteryField &field : kBatteryFields) {
        const double value = site.battery.*field.value;
        if (!(value >= field.minimum && value <= field.maximum)) {
            char range[64];
            std::snprintf(range, sizeof range, "is outside %g..%g", field.minimum, field.maximum);
            refuse_site(site, 0, std::string("battery.") + field.name, range);
        }
    }
}

void check_settings(const Site &site)
{
    if (const std::string fault = fault_in_name(site.name); !fault.empty()) {
        refuse_site(site, 0, "site.name", fault);
    }
    if (site.pan_id == 0xffff) {
        refuse_site(site, 0, "site.pan_id", "0xffff is the broadcast PAN");
    }
    if (site.channel < 11 || site.channel > 26) {
        refuse_site(site, 0, "site.channel", "is outside 11..26");
    }
    check_radio(site);
    check_battery(site);
    const SiteThresholds &limits = site.thresholds;
    /* In sixteenths of a pixel the node's fields have 8 bits and 16 bits; 0 would mean its default. */
    if (!(limits.similarity_clip_px >= 1.0 / 16 && limits.similarity_clip_px <= 255.0 / 16)) {
        refuse_site(site, 0, "thresholds.similarity_clip_px", "is outside 1/16..15.9375");
    }
    if (!(limits.similarity_px2 >= 1.0 / 256 &&
          limits.similarity_px2 <= limits.similarity_clip_px * limits.similarity_clip_px)) {
        refuse_site(site, 0, "thresholds.similarity_px2", "is outside 1/256..similarity_clip_px squared");
    }
    if (limits.similarity_blocks < 0) {
        refuse_site(site, 0, "thresholds.similarity_blocks", "is negative");
    }
}

} // namespace

std::string fault_in_name(const std::string &name)
{
    if (name.empty() || name.size() > kNameMax) {
        return "has " + std::to_string(name.size()) + " bytes, not 1.." + std::to_string(kNameMax);
    }
    for (const char c : name) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            return "has a control character";
        }
    }
    return "";
}

std::string fault_in_rectangle(const SiteRectangle &part, const SitePair &pair)
{
    if (part.x >= 0 && part.y >= 0 && part.width >= 1 && part.height >= 1 && part.x <= pair.width - part.width &&
        part.y <= pair.height - part.height) {
        return "";
    }
    return "[" + std::to_string(part.x) + ", " + std::to_string(part.y) + ", " + std::to_string(part.width) + ", " +
           std::to_string(part.height) + "] is not a rectangle x, y, width, height inside the pair's " +
           std::to_string(pair.width) + "x" + std::to_string(pair.height);
}

void refuse_site(const Site &site, int line, const std::string &field, const std::string &reason)
{
    const std::string file = site.file.empty() ? "site" : site.file.string();
    throw InputError(line > 0 ? file + ":" + std::to_string(line) : file, field, reason);
}

void refuse_node(const Site &site, const SiteNode &node, const std::string &field, const std::string &reason)
{
    refuse_site(site, node.line, "node " + std::to_string(node.id) + ": " + field, reason);
}

void refuse_pair(const Site &site, const SitePair &pair, const std::string &field, const std::string &reason)
{
    refuse_site(site, pair.line, "pair '" + pair.name + "': " + field, reason);
}

void check_site(const Site &site)
{
    check_settings(site);
    const NodeIndex index = index_nodes(site);
    check_gateway(site);
    check_tree(site, index);
    check_pairs(site, index);
    check_faults(site);
    check_zones(site);
}

} // namespace tsr
