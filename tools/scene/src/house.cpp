/*
 * The house: in its garden, within a ring of pairs; people come by.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>
#include <numbers>

#include "house_building.h"
#include "tsr/scene/surface.h"
#include "walk.h"

namespace tsr::scene
{

namespace
{

constexpr double kRingM = 10;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kGateDeg = -122; /* where people pass the ring */
constexpr float kGateSpanDeg = 24;
constexpr float kRollM = 0.35F; /* of the lawn */

struct Garden {
    float ring; /* radius of the cameras' ring */
    float half; /* from the middle to the fence */
    Eigen::Vector2f gate() const { return crossing(half / std::sin(-kGateDeg * kPi / 180)); }
    Eigen::Vector2f crossing(float distance) const
    {
        return {distance * std::cos(kGateDeg * kPi / 180), distance * std::sin(kGateDeg * kPi / 180)};
    }
};

float segment_distance(const Eigen::Vector2f &point, const Eigen::Vector2f &a, const Eigen::Vector2f &b)
{
    const Eigen::Vector2f way = b - a;
    const float share = std::clamp((point - a).dot(way) / way.squaredNorm(), 0.0F, 1.0F);
    return (point - a - share * way).norm();
}

/* Corners of the way round the house, from its front left. */
std::vector<Eigen::Vector2f> round_house()
{
    return {{-5.8F, -4.9F}, {-5.8F, 4.7F}, {5.6F, 4.8F}, {7.3F, 3.0F}, {7.3F, -2.4F}, {5.6F, -4.9F}};
}

/* Lawn rolls, but not where people walk and where things stand on z = 0. */
float lawn_height(const Garden &garden, float x, float y)
{
    const Eigen::Vector2f point(x, y);
    const float outside = (point.cwiseAbs() - Eigen::Vector2f(kHouseX + 1.5F, kHouseY + 1.5F)).maxCoeff();
    const float way = segment_distance(point, {kHouseDoorX, -kHouseY}, garden.gate());
    const float fence = std::max(std::fabs(std::fabs(x) - garden.half), std::fabs(std::fabs(y) - garden.half));
    const float lane = std::fabs(y + garden.half + 3);
    const float share = std::clamp(std::min({outside, way - 0.8F, lane - 2.2F, fence}), 0.0F, 2.5F) / 2.5F;
    return kRollM * share * noise_at(Eigen::Vector3f(x, y, 0) * 0.22F, 0, 3, 77);
}

void add_ground(World &world, const Garden &garden, const PropSurfaces &props)
{
    const SurfaceId grass = world.add_surface({Pattern::patches, 0.31F, 0.17F, 0.2F, 0.45F, 120});
    const SurfaceId asphalt = world.add_surface({Pattern::plain, 0.24F, 0, 0.4F, 0.45F, 121});
    const SurfaceId slabs = world.add_surface({Pattern::plain, 0.52F, 0, 0.3F, 0.4F, 122});
    const float size = 6 * garden.half;
    world.add(world.add_object("lawn"),
              make_terrain(
                  size, 80, [&](float x, float y) { return lawn_height(garden, x, y); }, grass));
    const float h = garden.half;
    world.add(world.add_object("lane"), make_box({-size / 2, -h - 4.6F, -0.4F}, {size / 2, -h - 1.4F, 0.02F}, asphalt));
    const ObjectId path = world.add_object("path");
    const Eigen::Vector2f from(kHouseDoorX, -kHouseY - 1.3F), way = garden.gate() - from;
    const int count = static_cast<int>(way.norm() / 0.66F);
    const float turn = std::atan2(way.y(), way.x()) * 180 / kPi;
    Chance chance(5);
    for (int i = 0; i <= count; ++i) {
        const Eigen::Vector2f at = from + way * (static_cast<float>(i) + 0.4F) / static_cast<float>(count);
        Mesh slab =
            make_centred_box({0, 0, 0}, {0.56F, chance.between(0.95F, 1.2F), 0.4F}, i % 3 == 0 ? props.stone : slabs);
        world.add(path, shifted(turned(std::move(slab), turn + chance.between(-4, 4)), at.x(), at.y(), -0.17F));
    }
}

void add_fence(World &world, const Garden &garden, const PropSurfaces &props)
{
    const SurfaceId wood = world.add_surface({Pattern::planks, 0.56F, 0.3F, 0.3F, 0.4F, 125, Grain::z});
    const ObjectId fence = world.add_object("fence");
    const float h = garden.half, gate = garden.gate().x();
    world.add(fence, shifted(make_fence(gate - 0.9F + h, 1.1F, 0.2F, wood), -h, -h, 0));
    world.add(fence, shifted(make_fence(h - gate - 0.9F, 1.1F, 0.2F, wood), gate + 0.9F, -h, 0));
    world.add(fence, shifted(turned(make_fence(2 * h, 1.5F, 0.24F, wood), 90), h, -h, 0));
    world.add(fence, shifted(turned(make_fence(2 * h, 1.5F, 0.24F, wood), -90), -h, h, 0));
    for (const float x : {gate - 1.0F, gate + 0.8F}) {
        world.add(fence, make_box({x, -h - 0.1F, -0.3F}, {x + 0.22F, -h + 0.12F, 1.35F}, props.stone));
    }
    world.add(world.add_object("back wall"),
              make_box({-h, h, -0.3F}, {h, h + 0.3F, 1.7F},
                       world.add_surface({Pattern::brick, 0.3F, 0.5F, 0.3F, 0.3F, 126})));
}

void add_plants(World &world, const Garden &garden, const PropSurfaces &props, Chance &chance)
{
    const ObjectId tree = world.add_object("tree"), bush = world.add_object("bush");
    const float h = garden.half;
    const std::vector<Eigen::Vector2f> trees = {
        {h - 0.8F, h - 1}, {-h + 0.8F, h - 1.2F}, {-h + 0.5F, -h + 1}, {h + 4, -2},     {-h - 5, 3}, {2, h + 4},
        {h + 9, h + 6},    {-4, h + 8},           {-h - 9, -h},        {h + 1, -h - 8}, {-8, -h - 9}};
    for (const Eigen::Vector2f &at : trees) {
        world.add(tree, shifted(make_tree(chance.between(5.0F, 8.0F), props.bark, props.leaves, chance), at.x(), at.y(),
                                -0.1F));
    }
    const std::vector<Eigen::Vector2f> bushes = {{-3.9F, -3.9F}, {3.3F, -3.95F}, {2.2F, -4.0F}, {-4.95F, -2.6F},
                                                 {-4.95F, 0.2F}, {4.0F, 3.95F},  {-0.3F, 4.0F}, {5.2F, -2.3F}};
    for (const Eigen::Vector2f &at : bushes) {
        world.add(bush, shifted(make_bush(chance.between(0.4F, 0.6F), props.leaves, chance), at.x(), at.y(), 0));
    }
    const int along = static_cast<int>(2 * h / 2.6F);
    for (int i = 0; i <= along; ++i) { /* along the fences */
        const float t = -h + 2.6F * static_cast<float>(i);
        world.add(bush, shifted(make_bush(chance.between(0.5F, 0.9F), props.leaves, chance), t + 0.8F, h - 0.7F, 0));
        world.add(bush, shifted(make_bush(chance.between(0.4F, 0.8F), props.leaves, chance),
                                i % 2 == 0 ? -h + 0.6F : h - 0.6F, t + 1, 0));
    }
}

/* Houses across the lane and beyond the garden: what the far end of a view ends at. */
void add_neighbours(World &world, const Garden &garden)
{
    const SurfaceId walls[] = {world.add_surface({Pattern::plain, 0.6F, 0, 0.8F, 0.2F, 130}),
                               world.add_surface({Pattern::brick, 0.35F, 0.5F, 0.3F, 0.3F, 131})};
    const SurfaceId roof = world.add_surface({Pattern::shingles, 0.25F, 0.1F, 0.4F, 0.3F, 132});
    const SurfaceId pane = world.add_surface({Pattern::plain, 0.12F, 0, 0.5F, 0.5F, 133});
    const ObjectId house = world.add_object("neighbour");
    const float away = garden.half + 14;
    for (int i = 0; i < 7; ++i) {
        const float angle = (20 + 51.4F * static_cast<float>(i)) * kPi / 180;
        Mesh block = make_box({-5, -4, -0.5F}, {5, 4, 4.5F}, walls[i % 2]);
        block.append(
            shifted(turned(make_prism({{-4.4F, 4.5F}, {4.4F, 4.5F}, {0, 7.5F}}, 10.6F, roof), 90), 5.3F, 0, 0));
        for (const float x : {-3.6F, -0.6F, 2.4F}) {
            for (const float y : {-4.02F, 3.98F}) {
                block.append(make_box({x, y, 1}, {x + 1.2F, y + 0.04F, 2.5F}, pane));
            }
        }
        world.add(house, shifted(turned(std::move(block), std::round(angle * 180 / kPi / 90) * 90 + 90),
                                 away * 1.15F * std::cos(angle), away * 1.15F * std::sin(angle), 0));
    }
}

/* Things along the walls, clear of doors and of the way round; with more clutter also on the lawn beyond the ring. */
void add_clutter(World &world, const SceneOptions &options, const Garden &garden, const PropSurfaces &props,
                 Chance &chance)
{
    const ObjectId clutter = world.add_object("clutter"), plant = world.add_object("plant");
    const auto put_plant = [&](float x, float y, float z) {
        const float height = chance.between(0.35F, 0.65F);
        world.add(clutter, shifted(make_flower_pot(height, props), x, y, z));
        world.add(plant, shifted(make_bush(0.75F * height, props.leaves, chance), x, y, z + 0.95F * height));
    };
    const auto put = [&](Mesh thing, float turn, float x, float y) {
        world.add(clutter, shifted(turned(std::move(thing), turn), x, y, 0));
    };
    struct Spot {
        float x, y, turn;
    };
    const std::vector<Spot> spots = {{1.0F, -4.05F, 0}, {-2.6F, -4.1F, 0},  {4.1F, -4.0F, 20},  {1.6F, 4.1F, 180},
                                     {-1.9F, 3.95F, 0}, {-4.1F, 4.0F, 10},  {-5.05F, 1.6F, 90}, {-5.0F, -1.2F, 90},
                                     {6.75F, 1.4F, 90}, {6.7F, -1.0F, 90},  {5.2F, 2.55F, 180}, {5.4F, -1.9F, 0},
                                     {0.3F, -4.0F, 0},  {-5.0F, 2.9F, -90}, {2.9F, 3.95F, 0}};
    const int near_count = std::min(static_cast<int>(10 * options.clutter), static_cast<int>(spots.size()));
    const int first = chance.whole(0, static_cast<int>(spots.size()) - 1);
    for (int i = 0; i < near_count; ++i) {
        const Spot &spot = spots[static_cast<std::size_t>(first + i * 4) % spots.size()];
        switch ((i + first) % 7) {
        case 0: put(make_bench(props), spot.turn, spot.x, spot.y); break;
        case 1: put(make_wheelie_bin(props), spot.turn + chance.between(-15, 15), spot.x, spot.y); break;
        case 2:
            put(make_wood_pile(1.3F, chance.between(0.8F, 1.4F), props, chance), spot.turn, spot.x - 0.3F, spot.y);
            break;
        case 3: put_plant(spot.x, spot.y, 0); break;
        case 4: put(make_barrel(props), chance.between(0, 90), spot.x, spot.y); break;
        case 5: put(make_crate({0.6F, 0.45F, chance.between(0.3F, 0.6F)}, props), spot.turn, spot.x, spot.y); break;
        default: put(make_wheelbarrow(props), spot.turn, spot.x, spot.y);
        }
    }
    const int far_count = static_cast<int>(10 * options.clutter);
    for (int i = 0; i < far_count; ++i) {
        const float angle =
            (kGateDeg + 25 + 310 * (static_cast<float>(i) + chance.between(0, 1)) / static_cast<float>(far_count)) *
            kPi / 180;
        const float away = garden.ring + chance.between(1.3F, 2.2F);
        const Eigen::Vector2f at(away * std::cos(angle), away * std::sin(angle));
        const float z = lawn_height(garden, at.x(), at.y());
        if (i % 3 == 0) {
            put_plant(at.x(), at.y(), z);
        } else {
            Mesh thing = i % 3 == 1 ? make_crate({0.7F, 0.5F, 0.5F}, props) : make_wheelbarrow(props);
            world.add(clutter, shifted(turned(std::move(thing), chance.between(0, 360)), at.x(), at.y(), z));
        }
    }
}

/* In turns: to the door and back, round the house, and along the lane. */
Walk walk_of(const Garden &garden, int index, Chance &chance)
{
    const Eigen::Vector2f gate = garden.gate(), inside = garden.crossing(garden.ring - 1.8F);
    const float lane = -garden.half - 2.2F;
    Walk walk;
    walk.speed_m_s = chance.between(1.0F, 1.5F);
    const float from = index % 2 == 0 ? -9.0F : 9.0F;
    walk.way = {{gate.x() + from, lane}, {gate.x(), lane}, {gate.x(), gate.y()}};
    if (index % 3 == 0) {
        walk.way.push_back({kHouseDoorX, -kHouseY - 1.6F, chance.between(4, 8)});
    } else if (index % 3 == 1) {
        walk.way.push_back({inside.x(), inside.y()});
        std::vector<Eigen::Vector2f> round = round_house();
        if (chance.whole(0, 1) == 0) {
            std::reverse(round.begin(), round.end());
        }
        for (const Eigen::Vector2f &corner : round) {
            walk.way.push_back({corner.x(), corner.y()});
        }
        walk.way.push_back({inside.x() + 0.3F, inside.y()});
    } else { /* a look at the garden, from the way */
        walk.way.push_back({inside.x(), inside.y()});
        walk.way.push_back({1.8F, -5.3F, 3});
        walk.way.push_back({4.6F, -5.2F, 2});
        walk.way.push_back({inside.x() + 0.3F, inside.y()});
    }
    walk.way.push_back({gate.x(), gate.y()});
    walk.way.push_back({gate.x(), lane});
    walk.way.push_back({gate.x() - from, lane});
    return walk;
}

void add_people(World &world, const SceneOptions &options, const Garden &garden)
{
    Chance chance(options.seed * 43 + 19);
    const Eigen::Vector2f corner(garden.half, garden.half);
    for (int i = 0; i < options.people; ++i) {
        Walk walk = walk_of(garden, i, chance);
        walk.start_s = options.duration_s * (i + chance.between(0.05F, 0.5F)) / options.people;
        const Clothes clothes = make_clothes(world, static_cast<std::uint32_t>(options.seed * 16 + 400) +
                                                        static_cast<std::uint32_t>(i) * 5);
        add_person(world, "person " + std::to_string(i + 1), person_keys(walk), clothes,
                   {chance.between(1.6F, 1.88F), 0, false});
        tell(world, time_within(walk, -corner, corner), "a person enters");
    }
}

/* All around but for the opening; few stand where the door can be seen. */
std::vector<Placement> ring_of(const LayoutOptions &layout)
{
    const bool few = layout.count <= 3;
    const double start = few ? -100 : kGateDeg + kGateSpanDeg / 2, span = few ? 120 : 360 - kGateSpanDeg;
    return make_ring(layout, {0, 0, 2.0}, kRingM, 1.6, 3.5, start, span);
}

} // namespace

Scene make_house(const SceneOptions &options, const LayoutOptions &layout)
{
    Scene scene;
    World &world = scene.world;
    /* Nearer than this a ring would cut the way round the house. */
    LayoutOptions ring = layout;
    ring.distance_m = std::max(layout.distance_m > 0 ? layout.distance_m : kRingM, 8.6);
    const Garden garden{static_cast<float>(ring.distance_m), static_cast<float>(ring.distance_m) + 3.5F};
    const PropSurfaces props = add_prop_surfaces(world, 140);
    Chance chance(options.seed * 29 + 13);
    add_house(world, props);
    add_ground(world, garden, props);
    add_fence(world, garden, props);
    add_plants(world, garden, props, chance);
    add_neighbours(world, garden);
    add_clutter(world, options, garden, props, chance);
    add_people(world, options, garden);
    settle_events(world, options.duration_s);
    world.light = make_daylight(options, 0.7F, 0.95F, -60, 42);
    scene.placements = ring_of(ring);
    scene.fov_deg = 72;
    scene.gateway = {-garden.half + 0.5, 0, 2};
    return scene;
}

} // namespace tsr::scene
