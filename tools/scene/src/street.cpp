/*
 * The street: two rows of houses, people, cars, and pairs on the fronts and lamp posts.
 *
 * It is along x, as long as its cameras need; each end meets a street across, where cars come from.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>

#include "facade.h"
#include "street_plan.h"
#include "walk.h"

namespace tsr::scene
{

namespace
{

/* Heights of the cameras of one mount, one after the other. */
constexpr int kLevels = 5;
constexpr double kLowM = 2.5, kHighM = 4.5;
constexpr double kAheadM = 9; /* to what a pair watches */

StreetPlan plan_of(const LayoutOptions &layout)
{
    /* Two pairs a house; beyond 32 houses a side mounts carry more of them. */
    StreetPlan plan;
    plan.houses = std::clamp((layout.count + 1) / 2, 6, 32);
    return plan;
}

/* Both rows, with a house across each end. */
void add_rows(World &world, const SceneOptions &options, const StreetPlan &plan, std::vector<Door> &doors)
{
    const StreetLabels labels = add_street_labels(world);
    StreetSurfaces surfaces = add_street_surfaces(world, 500);
    surfaces.coarse = plan.houses > 10;
    Chance chance(options.seed * 47 + 23);
    for (int i = 0; i < plan.houses; ++i) {
        for (const float side : {-1.0F, 1.0F}) {
            const float x = plan.boundary(i);
            Eigen::Affine3f place(Eigen::Translation3f(side > 0 ? x : x + kHouseWidthM, side * kFrontY, 0));
            if (side < 0) {
                place.rotate(Eigen::AngleAxisf(3.14159265F, Eigen::Vector3f::UnitZ()));
            }
            const float door = add_house_front(world, labels, surfaces, place, kHouseWidthM, chance);
            doors.push_back({side > 0 ? x + door : x + kHouseWidthM - door, side});
        }
    }
    for (const float end : {-1.0F, 1.0F}) {
        for (int i = -2; i < 2; ++i) {
            const float along = kHouseWidthM * static_cast<float>(i);
            Eigen::Affine3f place(
                Eigen::Translation3f(end * (plan.half_length() + kCrossStreetM), end > 0 ? -along : along, 0));
            place.rotate(Eigen::AngleAxisf(-end * 1.57079633F, Eigen::Vector3f::UnitZ()));
            add_house_front(world, labels, surfaces, place, kHouseWidthM, chance);
        }
    }
}

/* On the fronts to either side of where two houses meet, and on the lamp post before it. */
Placement placement_of(const StreetPlan &plan, const LayoutOptions &layout, int index)
{
    const int mounts = 2 * (plan.houses - 1);
    const int mount = static_cast<int>(static_cast<long>(index) * mounts / layout.count);
    const int first = static_cast<int>((static_cast<long>(mount) * layout.count + mounts - 1) / mounts);
    const int layer = index - first; /* among those of its mount */
    /* Neighbours along the street are on opposite sides. */
    const int boundary = 1 + mount / 2;
    const double side = (mount + mount / 2) % 2 == 0 ? 1 : -1;
    const int spot = (layer + mount) % 3; /* front left, front right, lamp post */
    const bool post = spot == 2;
    const int level = (layer / 3 + 2 * mount) % kLevels, turn = layer / 15;
    const bool own = layout.height_high_m > 0;
    const double low = own ? layout.height_low_m : kLowM, high = own ? layout.height_high_m : kHighM;
    const double ahead = layout.distance_m > 0 ? layout.distance_m : kAheadM;
    const double way = spot == 0 ? -1 : (spot == 1 ? 1 : (mount / 3 % 2 == 0 ? 0.15 : -0.15));
    Placement placement;
    placement.name = "pair " + std::to_string(index + 1);
    placement.eye = {plan.boundary(boundary) + (spot == 0 ? -0.3 : (spot == 1 ? 0.3 : 0.0)) + 0.02 * turn,
                     side * (post ? kPostY - 0.45 : kFrontY - 0.55), low + (high - low) * level / (kLevels - 1)};
    /* Along the street or across it; down to where people and cars are. */
    placement.target = {placement.eye.x() + way * ahead * (turn % 2 == 0 ? 1 : 0.6), side * (post ? -kFrontY : -0.5),
                        post ? 1.6 : 1.0};
    if (!post && ahead > 0) {
        placement.target.y() = side * (turn % 2 == 0 ? 1.0 : 4.0) * std::min(ahead / kAheadM, 1.0);
    }
    return placement;
}

} // namespace

Scene make_street(const SceneOptions &options, const LayoutOptions &layout)
{
    Scene scene;
    World &world = scene.world;
    const StreetPlan plan = plan_of(layout);
    std::vector<Door> doors;
    add_rows(world, options, plan, doors);
    add_road(world, plan);
    add_furniture(world, options, plan);
    const std::vector<Drive> drives = add_traffic(world, options, plan);
    add_pedestrians(world, options, plan, doors, drives);
    settle_events(world, options.duration_s);
    world.light = make_daylight(options, 0.7F, 0.85F, -40, 50);
    for (int i = 0; i < layout.count; ++i) {
        scene.placements.push_back(placement_of(plan, layout, i));
    }
    scene.fov_deg = 70;
    scene.gateway = {0, kFrontY - 0.4, 4.8};
    return scene;
}

} // namespace tsr::scene
