/*
 * Road, pavements and what stands on them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "street_plan.h"

#include <algorithm>
#include <cmath>

#include "car_body.h"
#include "props.h"

namespace tsr::scene
{

namespace
{

constexpr float kPlantedTreeM = 5.2F;
constexpr float kBeyondM = 34; /* how far the streets across reach to either side */

void add_pavements(World &world, const StreetPlan &plan)
{
    const SurfaceId slabs = world.add_surface({Pattern::tiles, 0.38F, 0.2F, 0.45F, 0.35F, 602});
    const SurfaceId kerb = world.add_surface({Pattern::tiles, 0.58F, 0.3F, 0.9F, 0.35F, 603});
    const ObjectId pavement = world.add_object("pavement"), edge = world.add_object("kerb");
    const float half = plan.half_length();
    for (const float side : {-1.0F, 1.0F}) {
        const auto strip = [&](float y0, float y1, float top, SurfaceId surface) {
            return make_box({-half, std::min(side * y0, side * y1), -0.2F}, {half, std::max(side * y0, side * y1), top},
                            surface);
        };
        world.add(pavement, strip(kKerbY + 0.16F, kFrontY + 0.3F, kPavementZ, slabs));
        world.add(edge, strip(kKerbY, kKerbY + 0.16F, kPavementZ + 0.005F, kerb));
        const float end = side * (half + kCrossStreetM);
        world.add(pavement, make_box({std::min(end, end - side * 2.2F), -kBeyondM, -0.2F},
                                     {std::max(end, end - side * 2.2F), kBeyondM, kPavementZ}, slabs));
    }
}

void add_markings(World &world, const StreetPlan &plan)
{
    const SurfaceId white = world.add_surface({Pattern::plain, 0.78F, 0, 0.25F, 0.3F, 604});
    const SurfaceId patch = world.add_surface({Pattern::plain, 0.15F, 0, 0.2F, 0.4F, 605});
    const SurfaceId iron = world.add_surface({Pattern::tiles, 0.2F, 0.08F, 0.06F, 0.3F, 606});
    const ObjectId marking = world.add_object("marking"), road = world.add_object("road");
    const float half = plan.half_length();
    for (int i = 0; i < static_cast<int>(half / 2); ++i) {
        const float x = -half + 1 + 4 * static_cast<float>(i);
        if (!plan.is_by_crossing(x + 1, 2.6F)) {
            world.add(marking, make_box({x, -0.06F, -0.1F}, {x + 2, 0.06F, 0.008F}, white));
        }
    }
    for (const float crossing : plan.crossings()) {
        for (int i = 0; i < 9; ++i) {
            const float y = -kKerbY + 0.35F + static_cast<float>(i);
            world.add(marking, make_box({crossing - 1.4F, y, -0.1F}, {crossing + 1.4F, y + 0.5F, 0.009F}, white));
        }
    }
    for (const float side : {-1.0F, 1.0F}) {
        for (int i = 0; i <= plan.houses * 2; ++i) { /* bays for parked cars */
            const float x = plan.boundary(0) + 5 * static_cast<float>(i);
            world.add(marking,
                      make_box({x - 0.05F, side * 3.6F - 1.0F, -0.1F}, {x + 0.05F, side * 3.6F + 1.0F, 0.007F}, white));
        }
    }
    Chance chance(61);
    for (int i = 0; i < plan.houses; ++i) { /* what roadworks have left */
        const float x = plan.boundary(i) + chance.between(1, 6), y = chance.between(-2.4F, 0.8F);
        world.add(road, make_box({x, y, -0.1F}, {x + chance.between(1, 3.5F), y + chance.between(0.6F, 1.6F), 0.004F},
                                 patch));
        world.add(road, shifted(make_cylinder(0.32F, 0.32F, 0.11F, 16, iron), x + 3, -y, -0.1F));
    }
}

void add_parked_cars(World &world, const SceneOptions &options, const StreetPlan &plan)
{
    Chance chance(options.seed * 53 + 31);
    const int every = std::max(1, plan.houses / 8); /* a long street has them here and there */
    std::vector<CarSurfaces> looks;
    for (std::uint32_t i = 0; i < 4; ++i) {
        looks.push_back(add_car_surfaces(world, 640 + i * 3 + static_cast<std::uint32_t>(options.seed % 5)));
    }
    const ObjectId parked = world.add_object("parked car");
    for (int bay = 0; bay < plan.houses * 2; ++bay) {
        const float x = plan.boundary(0) + 5 * static_cast<float>(bay) + 2.5F;
        for (const float side : {-1.0F, 1.0F}) {
            const bool taken = chance.whole(0, 2 * every) == 0;
            const CarSurfaces &look = looks[static_cast<std::size_t>(chance.whole(0, 3))];
            if (!taken || plan.is_by_crossing(x, 5)) {
                continue;
            }
            const Eigen::Vector3f off =
                chance.within({-0.15F, -0.05F, -1.5F}, {0.15F, 0.05F, 1.5F}); /* m, m, degrees */
            Mesh car = turned(make_whole_car(look, true), (side < 0 ? 0.0F : 180.0F) + off.z());
            world.add(parked, shifted(std::move(car), x + off.x(), side * kParkedY + off.y(), 0));
        }
    }
}

/* Trees before the middles of houses, clear of cameras where houses meet; lamp posts there. */
void add_trees_and_posts(World &world, const StreetPlan &plan, const PropSurfaces &props, Chance &chance)
{
    const ObjectId tree = world.add_object("tree"), post = world.add_object("lamp post"),
                   sign = world.add_object("road sign");
    const int every = plan.houses > 20 ? 3 : 2;
    for (int i = 0; i < plan.houses; ++i) {
        const float x = plan.boundary(i) + kHouseWidthM / 2;
        for (const float side : {-1.0F, 1.0F}) {
            if ((i + (side > 0 ? 1 : 0)) % every == 0 && !plan.is_by_crossing(x, 3)) {
                world.add(tree, shifted(make_tree(kPlantedTreeM + chance.between(-0.6F, 0.5F), props.bark, props.leaves,
                                                  chance),
                                        x, side * kPostY, kPavementZ - 0.1F));
            }
        }
    }
    for (int i = 0; i <= plan.houses; ++i) {
        const float side = i % 2 == 0 ? 1.0F : -1.0F;
        for (const float s : {side, -side}) {
            Mesh mesh = make_lamp_post(5.4F, props);
            world.add(post, shifted(turned(std::move(mesh), s > 0 ? 180 : 0), plan.boundary(i), s * kPostY,
                                    kPavementZ - 0.05F));
        }
        world.add(sign, shifted(turned(make_road_sign(props, i % 2 == 0), side > 0 ? 90 : -90),
                                plan.boundary(i) + side * 2.1F, side * (kPostY - 0.05F), kPavementZ - 0.05F));
    }
}

void add_small_things(World &world, const SceneOptions &options, const StreetPlan &plan, const PropSurfaces &props,
                      Chance &chance)
{
    const ObjectId clutter = world.add_object("clutter"), plant = world.add_object("plant");
    const int count = static_cast<int>(1.2 * options.clutter * std::min(plan.houses, 16) * 2);
    for (int i = 0; i < count; ++i) {
        const float side = i % 2 == 0 ? 1.0F : -1.0F;
        const int house = static_cast<int>((static_cast<float>(i) + 0.5F) / static_cast<float>(count) *
                                           static_cast<float>(plan.houses));
        float x = plan.boundary(house) + (i / 2 % 2 == 0 ? chance.between(1.2F, 3.4F) : chance.between(6.6F, 8.6F));
        const float z = kPavementZ, y = side * (kKerbY + 0.62F);
        if (plan.is_by_crossing(x, 2.2F)) {
            x = plan.boundary(house) + 1.2F;
        }
        switch (chance.whole(0, 5)) {
        case 0: world.add(clutter, shifted(turned(make_wheelie_bin(props), 90 + 90 * side), x, y, z)); break;
        case 1: world.add(clutter, shifted(make_litter_bin(props), x, y, z)); break;
        case 2: world.add(clutter, shifted(turned(make_bench(props), side > 0 ? 180.0F : 0.0F), x, y, z)); break;
        case 3:
            world.add(clutter, shifted(make_crate({0.6F, 0.45F, chance.between(0.3F, 0.6F)}, props), x, y, z));
            break;
        case 4: world.add(clutter, shifted(make_barrel(props), x, y, z)); break;
        default:
            world.add(clutter, shifted(make_flower_pot(0.6F, props), x, y, z));
            world.add(plant, shifted(make_bush(0.45F, props.leaves, chance), x, y, z + 0.57F));
        }
    }
}

} // namespace

std::vector<float> StreetPlan::crossings() const
{
    std::vector<float> all;
    for (int i = houses / 2 % 6; i < houses; i += 6) {
        all.push_back(boundary(i) + kHouseWidthM / 2);
    }
    return all;
}

bool StreetPlan::is_by_crossing(float x, float reach) const
{
    for (const float crossing : crossings()) {
        if (std::fabs(x - crossing) < reach) {
            return true;
        }
    }
    return false;
}

void add_road(World &world, const StreetPlan &plan)
{
    const SurfaceId asphalt = world.add_surface({Pattern::plain, 0.28F, 0, 0.3F, 0.45F, 601});
    const float half = plan.half_length() + kCrossStreetM + 10;
    world.add(world.add_object("road"), make_box({-half, -60, -0.3F}, {half, 60, 0}, asphalt));
    add_pavements(world, plan);
    add_markings(world, plan);
}

void add_furniture(World &world, const SceneOptions &options, const StreetPlan &plan)
{
    const PropSurfaces props = add_prop_surfaces(world, 620);
    Chance chance(options.seed * 59 + 37);
    add_trees_and_posts(world, plan, props, chance);
    add_small_things(world, options, plan, props, chance);
    add_parked_cars(world, options, plan);
}

} // namespace tsr::scene
