/*
 * Copies of recorded pairs.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scenario/crowd.h"

#include <algorithm>
#include <cmath>

#include "scenario_site.h"
#include "tree.h"
#include "tsr/host/input_error.h"
#include "tsr/host/site_fields.h"
#include "tsr/scenario/staging.h"
#include "tsr/scene/hash.h"

namespace tsr
{

namespace
{

constexpr std::uint64_t kPlaceKey = 0x706c616365u;
constexpr std::uint64_t kOffsetKey = 0x6f6666736574u;
constexpr std::uint64_t kStartKey = 0x7374617274u;

using Position = std::array<double, 2>; /* x and y: heights stay as they were recorded */

/* Chance of a pair: 0 .. 2^64 - 1. */
std::uint64_t draw(const Scenario &scenario, std::uint64_t key, std::size_t pair)
{
    return scene::hash64(scene::hash64(scenario.seed ^ key) + pair);
}

/* A whole number of 0 .. most. */
std::uint64_t draw_to(std::uint64_t most, std::uint64_t chance)
{
    return chance % (most + 1);
}

std::uint64_t rounded(double value)
{
    return static_cast<std::uint64_t>(std::llround(value));
}

/* On the grid row by row, or anywhere in the area, to the millimetre. */
Position place_of(const Scenario &scenario, std::size_t pair)
{
    const ScenarioRecorded &recorded = *scenario.recorded;
    if (recorded.spacing_m > 0) {
        const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(recorded.count))));
        return {static_cast<double>(pair % side) * recorded.spacing_m,
                static_cast<double>(pair / side) * recorded.spacing_m};
    }
    Position place{};
    for (std::size_t axis = 0; axis < place.size(); ++axis) {
        const std::uint64_t chance = draw(scenario, kPlaceKey, 2 * pair + axis);
        place[axis] = static_cast<double>(draw_to(rounded(recorded.area_m[axis] * 1000), chance)) / 1000;
    }
    return place;
}

std::uint64_t offset_ms_of(const Scenario &scenario, std::size_t pair)
{
    const std::uint64_t first_ms = rounded(scenario.recorded->offset_s[0] * 1000);
    const std::uint64_t last_ms = rounded(scenario.recorded->offset_s[1] * 1000);
    return first_ms + draw_to(last_ms - first_ms, draw(scenario, kOffsetKey, pair));
}

void move(std::array<double, 3> &position, const Position &shift)
{
    for (std::size_t axis = 0; axis < shift.size(); ++axis) {
        position[axis] += shift[axis];
    }
}

void require_frames(const Site &recorded, const SitePair &pair)
{
    for (const std::uint16_t id : {pair.lead, pair.wing}) {
        const SiteNode *node = recorded.node(id);
        if (node != nullptr && node->frames.empty()) {
            throw InputError(recorded.file.string() + ":" + std::to_string(node->line),
                             "node " + std::to_string(id) + ": frames", "is missing; a crowd sees what was recorded");
        }
    }
}

SiteNode copy_node(const ScenarioRecorded &recorded, const SiteNode &original, std::uint16_t id,
                   const std::string &name, const Position &shift)
{
    SiteNode node = original;
    node.id = id;
    node.name = name;
    node.line = 0;
    node.frames.clear();
    node.frames_right.clear();
    move(node.position_m, shift);
    if (recorded.watch_period_ms > 0) {
        node.watch_period_ms = recorded.watch_period_ms;
    }
    return node;
}

/* The pair and its one or two nodes at the end of the site. */
void add_copy(Site &site, const Site &recorded, const SitePair &original, const Scenario &scenario)
{
    const ScenarioRecorded &options = *scenario.recorded;
    const Position place = place_of(scenario, site.pairs.size());
    const auto next = static_cast<std::uint16_t>(site.nodes.size() + 1);
    const SiteNode &lead = *recorded.node(original.lead);
    const Position shift = {place[0] - lead.position_m[0], place[1] - lead.position_m[1]};
    SitePair pair = original;
    pair.name = "pair " + std::to_string(site.pairs.size() + 1);
    pair.line = 0;
    pair.truth.clear();
    pair.lead = next;
    pair.reference_image = options.reference_image.value_or(pair.reference_image);
    move(pair.left.position_m, shift);
    if (pair.right) {
        move(pair.right->position_m, shift);
    }
    const bool two_boards = original.wing != kNodeNone;
    site.nodes.push_back(copy_node(options, lead, next, pair.name + (two_boards ? " lead" : ""), shift));
    site.nodes.back().parent = kNodeNone;
    if (two_boards) {
        pair.wing = static_cast<std::uint16_t>(next + 1);
        site.nodes.push_back(copy_node(options, *recorded.node(original.wing), pair.wing, pair.name + " wing", shift));
        site.nodes.back().parent = pair.lead;
    }
    site.pairs.push_back(std::move(pair));
}

/* In the middle of the pairs. */
SiteNode make_gateway(const Site &site, double height_m)
{
    SiteNode gateway;
    gateway.id = static_cast<std::uint16_t>(site.nodes.size() + 1);
    gateway.name = "gateway";
    gateway.role = Role::gateway;
    gateway.position_m[2] = height_m;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto [low, high] =
            std::minmax_element(site.nodes.begin(), site.nodes.end(), [axis](const SiteNode &a, const SiteNode &b) {
                return a.position_m[axis] < b.position_m[axis];
            });
        gateway.position_m[axis] = (low->position_m[axis] + high->position_m[axis]) / 2;
    }
    return gateway;
}

/* Hops to the gateway of the pair's lead. */
std::size_t depth_of(const std::vector<std::uint16_t> &parents, std::uint16_t node)
{
    std::size_t depth = 0;
    for (; parents[node] != kNodeNone; node = parents[node]) {
        ++depth;
    }
    return depth;
}

/* Instants drawn from the seed, given out from the gateway outwards: whom nobody hears sends in vain, and again. */
void start_outwards(Site &site, const Scenario &scenario)
{
    std::vector<std::uint16_t> parents(site.nodes.size() + 1, kNodeNone);
    for (const SiteNode &node : site.nodes) {
        parents[node.id] = node.parent;
    }
    std::vector<std::pair<std::size_t, std::size_t>> outwards; /* depth, pair */
    std::vector<std::uint32_t> starts_ms;
    const std::uint64_t last_ms = rounded(scenario.recorded->start_within_s * 1000);
    for (std::size_t i = 0; i < site.pairs.size(); ++i) {
        outwards.emplace_back(depth_of(parents, site.pairs[i].lead), i);
        starts_ms.push_back(static_cast<std::uint32_t>(draw_to(last_ms, draw(scenario, kStartKey, i))));
    }
    std::sort(outwards.begin(), outwards.end());
    std::sort(starts_ms.begin(), starts_ms.end());
    for (std::size_t i = 0; i < outwards.size(); ++i) {
        const SitePair &pair = site.pairs[outwards[i].second];
        for (const std::uint16_t id : {pair.lead, pair.wing}) {
            if (id != kNodeNone) {
                site.nodes[id - 1u].start_ms = starts_ms[i];
            }
        }
    }
}

Site load_recorded(const Scenario &scenario)
{
    const auto file = scenario.file.parent_path() / scenario.recorded->site;
    std::error_code error;
    if (!std::filesystem::exists(file, error) && error) {
        throw InputError(scenario.file.string(), "recorded.site", file.string() + ": " + error.message());
    }
    if (!std::filesystem::exists(file, error)) {
        throw InputError(scenario.file.string(), "recorded.site",
                         "there is no " + file.string() + "; tarsier render makes such a site of a scene");
    }
    Site recorded = load_site(file);
    if (recorded.pairs.empty()) {
        throw InputError(file.string(), "pair", "is missing; a crowd is made of copies of pairs");
    }
    for (const SitePair &pair : recorded.pairs) {
        require_frames(recorded, pair);
    }
    return recorded;
}

} // namespace

Crowd stage_crowd(const Scenario &scenario)
{
    Crowd crowd;
    crowd.recorded = load_recorded(scenario);
    crowd.site = site_of(scenario);
    Site &site = crowd.site;
    const auto count = static_cast<std::size_t>(scenario.recorded->count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t original = i % crowd.recorded.pairs.size();
        add_copy(site, crowd.recorded, crowd.recorded.pairs[original], scenario);
        crowd.pairs.push_back({original, offset_ms_of(scenario, i)});
    }
    place_zones(site, scenario.zones);
    crowd.pause_ms = rounded(scenario.recorded->pause_s * 1000);
    site.nodes.push_back(make_gateway(site, crowd.recorded.gateway().position_m[2]));
    join_tree(site, kReachM);
    start_outwards(site, scenario);
    check_site(site);
    return crowd;
}

} // namespace tsr
