/*
 * Scenes with cameras and nodes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scenario/staging.h"

#include <cmath>
#include <numbers>

#include "impossible.h"
#include "scenario_site.h"
#include "tree.h"
#include "tsr/host/input_error.h"
#include "tsr/host/site_fields.h"

namespace tsr
{

namespace
{

constexpr double kPi = std::numbers::pi;

scene::Camera make_camera(const Scenario &scenario, double fov_deg)
{
    const ScenarioPairs &pairs = scenario.pairs;
    scene::Camera camera;
    camera.width = pairs.width;
    camera.height = pairs.height;
    camera.focal_px = pairs.width / 2.0 / std::tan(fov_deg / 2 * kPi / 180);
    camera.principal_px = {(pairs.width - 1) / 2.0, (pairs.height - 1) / 2.0};
    camera.distortion = scenario.camera.distortion;
    camera.readout_us = static_cast<std::uint32_t>(std::lround(scenario.camera.rolling_shutter_ms * 1000));
    return camera;
}

/* The axes meet at the angle: after rectification the right principal point lies further right by f tan(angle). */
void place_pair(Staging &staging, const Scenario &scenario, const scene::Placement &placement, std::uint16_t left_node,
                std::uint16_t right_node)
{
    const ScenarioPairs &pairs = scenario.pairs;
    const double fov_deg = pairs.fov_deg > 0 ? pairs.fov_deg : staging.scene->fov_deg;
    scene::Camera camera = make_camera(scenario, fov_deg);
    camera.pose = scene::look_at(placement.eye, placement.target);
    const double half_m = pairs.baseline_mm / 2000;
    scene::Camera left = camera, right = camera;
    left.pose.translation() -= half_m * camera.pose.linear().col(0);
    right.pose.translation() += half_m * camera.pose.linear().col(0);
    right.principal_px.x() += camera.focal_px * std::tan(pairs.angle_deg * kPi / 180);
    staging.cameras.push_back({left_node, false, left});
    staging.cameras.push_back({right_node, true, right});
}

SitePose site_pose(const Eigen::Isometry3d &pose)
{
    SitePose site;
    for (std::size_t row = 0; row < 3; ++row) {
        site.position_m[row] = pose.translation()[static_cast<Eigen::Index>(row)];
        for (std::size_t column = 0; column < 3; ++column) {
            site.rotation[3 * row + column] =
                pose.linear()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
        }
    }
    return site;
}

SitePair site_pair(const Scenario &scenario, const scene::Placement &placement, const StagedCamera &left,
                   const StagedCamera &right)
{
    const ScenarioPairs &pairs = scenario.pairs;
    SitePair pair;
    pair.name = placement.name;
    pair.lead = left.node;
    pair.wing = right.node == left.node ? kNodeNone : right.node;
    pair.width = pairs.width;
    pair.height = pairs.height;
    pair.disparities = pairs.disparities;
    pair.search_start_px = pairs.search_start_px;
    pair.focal_px = left.camera.focal_px;
    pair.baseline_mm = pairs.baseline_mm;
    pair.principal_px = {left.camera.principal_px.x(), left.camera.principal_px.y()};
    pair.d0_px = pairs.search_start_px + right.camera.principal_px.x() - left.camera.principal_px.x();
    pair.left = site_pose(left.camera.pose);
    pair.right = site_pose(right.camera.pose);
    pair.step_px = pairs.step_px;
    pair.reference_image = pairs.reference_image;
    pair.reference_step = pairs.reference_step;
    return pair;
}

SiteNode site_node(const Scenario &scenario, const StagedCamera &camera, Role role, const std::string &name)
{
    SiteNode node;
    node.id = camera.node;
    node.role = role;
    node.name = name;
    const Eigen::Vector3d position = camera.camera.pose.translation();
    node.position_m = {position.x(), position.y(), position.z()};
    node.watch_period_ms = scenario.pairs.watch_period_ms;
    return node;
}

/* Cameras, then nodes and pairs of the site. */
void place_pairs(Staging &staging, const Scenario &scenario)
{
    const bool two_boards = scenario.pairs.two_boards;
    std::uint16_t next = 1;
    for (const scene::Placement &placement : staging.scene->placements) {
        const std::uint16_t left_node = next++;
        const std::uint16_t right_node = two_boards ? next++ : left_node;
        place_pair(staging, scenario, placement, left_node, right_node);
        const StagedCamera &left = staging.cameras[staging.cameras.size() - 2], &right = staging.cameras.back();
        staging.site.pairs.push_back(site_pair(scenario, placement, left, right));
        staging.site.nodes.push_back(site_node(scenario, left, two_boards ? Role::lead : Role::binocular,
                                               placement.name + (two_boards ? " lead" : "")));
        if (two_boards) {
            staging.site.nodes.push_back(site_node(scenario, right, Role::wing, placement.name + " wing"));
            staging.site.nodes.back().parent = left_node;
        }
    }
    SiteNode gateway;
    gateway.id = next;
    gateway.name = "gateway";
    gateway.role = Role::gateway;
    const Eigen::Vector3d &position = staging.scene->gateway;
    gateway.position_m = {position.x(), position.y(), position.z()};
    staging.site.nodes.push_back(gateway);
}

} // namespace

Staging stage_scenario(const Scenario &scenario)
{
    if (scenario.recorded) {
        throw InputError(scenario.file.string(), "recorded",
                         "there is no scene to render: its frames are there already");
    }
    Staging staging;
    staging.scene = std::make_unique<scene::Scene>(scene::make_scene(scenario.scene, scenario.pairs.layout));
    staging.geometry = std::make_unique<scene::Geometry>(staging.scene->world);
    staging.site = site_of(scenario);
    Site &site = staging.site;
    place_pairs(staging, scenario);
    place_zones(site, scenario.zones);
    refuse_impossible(scenario, staging);
    join_tree(site, kReachM);
    check_site(site);
    return staging;
}

} // namespace tsr
