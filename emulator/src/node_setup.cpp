/*
 * Node configuration from site and keys.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/node_setup.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr double kDisparityOne = 16; /* UQ12.4 */

tsr_role firmware_role(Role role)
{
    switch (role) {
    case Role::gateway: return TSR_ROLE_GATEWAY;
    case Role::relay: return TSR_ROLE_RELAY;
    case Role::lead: return TSR_ROLE_LEAD;
    case Role::wing: return TSR_ROLE_WING;
    case Role::binocular: return TSR_ROLE_BINOCULAR;
    }
    return TSR_ROLE_RELAY;
}

/* For every node below this one, the child it is behind. */
std::vector<tsr_route> routes_of(const Site &site, const SiteNode &node)
{
    std::vector<std::uint16_t> parents(kNodeIdMax + 1u,
                                       kNodeNone); /* by id: a search for each step up takes too long */
    for (const SiteNode &other : site.nodes) {
        parents[other.id] = other.parent;
    }
    std::vector<tsr_route> routes;
    for (const SiteNode &other : site.nodes) {
        std::uint16_t step = other.id;
        while (parents[step] != kNodeNone && parents[step] != node.id) {
            step = parents[step];
        }
        if (parents[step] == node.id) {
            routes.push_back({other.id, step});
        }
    }
    return routes;
}

void copy_key(const Key &key, std::uint8_t (&to)[TSR_AES_KEY_LEN])
{
    std::copy(key.begin(), key.end(), to);
}

void set_thresholds(tsr_node_config &config, const SiteThresholds &thresholds)
{
    config.change.deviation_min = static_cast<std::uint8_t>(thresholds.change_deviation_min);
    config.change.min_cells = static_cast<std::uint16_t>(thresholds.change_cells_min);
    config.similarity.clip_q4 = static_cast<std::uint8_t>(std::lround(thresholds.similarity_clip_px * kDisparityOne));
    config.similarity.threshold_q8 =
        static_cast<std::uint16_t>(std::lround(thresholds.similarity_px2 * kDisparityOne * kDisparityOne));
    config.similarity.min_blocks = static_cast<std::uint16_t>(thresholds.similarity_blocks);
}

tsr_depth_rule depth_rule(const SitePair &pair, const SiteZone &zone)
{
    constexpr double kScaleOne = 256; /* UQ24.8 */
    constexpr double kMillimetres = 1000;
    const double limit_q4 = std::ceil(disparity_at(pair, zone.depth_m) * kDisparityOne);
    tsr_depth_rule rule{};
    rule.zone.part = {static_cast<std::uint16_t>(zone.part.x), static_cast<std::uint16_t>(zone.part.y),
                      static_cast<std::uint16_t>(zone.part.width), static_cast<std::uint16_t>(zone.part.height)};
    rule.begin_px = begin_pixels(zone);
    if (zone.kind == ZoneKind::changed) {
        rule.zone.kind = TSR_ZONE_SURFACE;
        rule.scale_q8 = static_cast<std::uint32_t>(std::lround(pair.focal_px * pair.baseline_mm * kScaleOne));
        rule.change_mm = static_cast<std::uint16_t>(std::lround(zone.depth_m * kMillimetres));
    } else {
        rule.zone.kind = zone.kind == ZoneKind::below ? TSR_ZONE_NEARER : TSR_ZONE_FARTHER;
        rule.zone.limit_q4 = static_cast<std::uint16_t>(std::clamp(limit_q4, 0.0, double{TSR_DISPARITY_INVALID}));
        rule.end_px = end_pixels(zone);
    }
    return rule;
}

/* The shortest period of a pair's zones is that of all. */
void note_period(tsr_node_config &config, const SiteZone &zone)
{
    const auto period_us = static_cast<std::uint32_t>(std::lround(zone.every_s * 1e6));
    if (period_us > 0 && (config.measure_period_us == 0 || period_us < config.measure_period_us)) {
        config.measure_period_us = period_us;
    }
}

void set_up_camera(tsr_node_config &config, const SiteNode &node, const SitePair &pair)
{
    const auto width = static_cast<std::uint16_t>(pair.width);
    const auto height = static_cast<std::uint16_t>(pair.height);
    config.watch_period_us = node.watch_period_ms * 1000;
    config.change.width = width;
    config.change.height = height;
    config.change.watched_count = static_cast<std::uint8_t>(node.watch.size());
    for (std::size_t i = 0; i < node.watch.size(); i++) {
        const SiteRectangle &area = node.watch[i];
        config.change.watched[i] = {static_cast<std::uint16_t>(area.x), static_cast<std::uint16_t>(area.y),
                                    static_cast<std::uint16_t>(area.width), static_cast<std::uint16_t>(area.height)};
    }
    config.match.width = width;
    config.match.height = height;
    config.match.disparities = static_cast<std::uint16_t>(pair.disparities);
    config.match.search_start_px = static_cast<std::int16_t>(pair.search_start_px);
    config.similarity.width = width;
    config.similarity.height = height;
    config.d0_q4 = static_cast<std::int16_t>(std::lround(pair.d0_px * kDisparityOne));
    config.step_log2 = static_cast<std::uint8_t>(std::lround(std::log2(pair.step_px * kDisparityOne)));
    config.reference_step =
        pair.reference_image ? static_cast<std::uint8_t>(pair.reference_step) : std::uint8_t{TSR_REFERENCE_NONE};
}

} // namespace

std::unique_ptr<NodeSetup> set_up_node(const Site &site, const SiteNode &node, const KeyRing &keys)
{
    auto setup = std::make_unique<NodeSetup>();
    setup->routes = routes_of(site, node);
    tsr_node_config &config = setup->config;
    config.role = firmware_role(node.role);
    config.pan_id = site.pan_id;
    config.address = node.id;
    config.partner = TSR_ADDRESS_NONE;
    config.channel = static_cast<std::uint8_t>(site.channel);
    config.routes.parent = node.parent == kNodeNone ? TSR_ADDRESS_NONE : node.parent;
    config.routes.descendants = setup->routes.data();
    config.routes.descendant_count = static_cast<std::uint16_t>(setup->routes.size());
    copy_key(keys.link_key, config.link_key);
    copy_key(keys.node_key(node.id).value(), config.node_key);
    const SitePair *pair = site.pair_of(node.id);
    if (pair != nullptr) {
        if (pair->wing != kNodeNone) {
            config.partner = node.id == pair->lead ? pair->wing : pair->lead;
            copy_key(keys.pair_key(pair->lead, pair->wing).value(), config.pair_key);
        }
        set_up_camera(config, node, *pair);
        for (const SiteZone &zone : pair->zones) {
            setup->rules.push_back(depth_rule(*pair, zone));
            note_period(config, zone);
        }
        config.rules = setup->rules.data();
        config.rule_count = static_cast<std::uint8_t>(setup->rules.size());
        set_thresholds(config, site.thresholds);
    }
    const char *field = nullptr;
    if (tsr_node_check(&config, &field) != TSR_OK) {
        throw InputError(site.file.string(),
                         pair != nullptr ? "pair '" + pair->name + "'" : "node " + std::to_string(node.id),
                         std::string("the firmware refuses its ") + (field != nullptr ? field : "configuration"));
    }
    return setup;
}

} // namespace tsr
