/*
 * The car: parked in a yard, within a ring of pairs.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "car_body.h"
#include "props.h"
#include "walk.h"

namespace tsr::scene
{

namespace
{

constexpr double kRingM = 4;
constexpr float kGateDeg = 25; /* where the ring is open, and the yard has its gate */
constexpr float kGateSpanDeg = 32;
constexpr float kLidDeg = 72;
constexpr double kSwingS = 1.8; /* the lid, from shut to open */

/* Who comes in passes the gate and the ring's opening in line. */
Eigen::Vector2f towards_gate(float distance)
{
    const float angle = kGateDeg * std::numbers::pi_v<float> / 180;
    return {distance * std::cos(angle), distance * std::sin(angle)};
}

struct Yard {
    float ring; /* radius of the cameras' ring */
    float half; /* from the middle to the walls */
};

/* The wall along x = half has the gate; what is beyond it is a lane with another wall. */
void add_yard(World &world, const Yard &yard)
{
    const float h = yard.half, gate = h * std::tan(kGateDeg * std::numbers::pi_v<float> / 180);
    const SurfaceId asphalt = world.add_surface({Pattern::plain, 0.24F, 0, 0.35F, 0.5F, 201});
    const SurfaceId slabs = world.add_surface({Pattern::tiles, 0.42F, 0.2F, 0.4F, 0.4F, 202});
    const SurfaceId brick = world.add_surface({Pattern::brick, 0.36F, 0.58F, 0.26F, 0.3F, 203});
    const SurfaceId plaster = world.add_surface({Pattern::plain, 0.68F, 0, 0.6F, 0.06F, 204});
    const SurfaceId boards = world.add_surface({Pattern::planks, 0.36F, 0.1F, 0.18F, 0.4F, 205, Grain::z});
    const SurfaceId stone = world.add_surface({Pattern::plain, 0.55F, 0, 0.25F, 0.35F, 206});
    const SurfaceId white = world.add_surface({Pattern::plain, 0.8F, 0, 0.3F, 0.35F, 207});
    world.add(world.add_object("ground"), make_box({-h - 8, -h - 8, -0.3F}, {h + 8, h + 8, 0}, asphalt));
    const ObjectId floor = world.add_object("paving");
    world.add(floor, make_box({-3.4F, -2.0F, -0.1F}, {3.2F, 2.0F, 0.012F}, slabs));
    world.add(floor, make_box({-h, h - 1.2F, -0.1F}, {h, h, 0.1F}, slabs));
    world.add(floor, make_box({-h, h - 1.3F, -0.1F}, {h, h - 1.2F, 0.12F}, stone)); /* kerb */
    for (const float y : {-1.5F, 1.5F}) {
        world.add(floor, make_box({-3.0F, y - 0.05F, 0}, {2.6F, y + 0.05F, 0.016F}, white));
    }
    const ObjectId wall = world.add_object("wall");
    world.add(wall, make_box({-h - 0.25F, -h, 0}, {-h, h, 2.6F}, brick));
    world.add(wall, make_box({-h - 0.3F, -h, 2.6F}, {-h + 0.05F, h, 2.72F}, stone));
    world.add(wall, make_box({-h, h, 0}, {h, h + 0.25F, 3.4F}, plaster));
    world.add(wall, make_box({-h, h - 0.03F, 0}, {h, h, 0.5F}, stone));
    world.add(wall, make_box({h, -h, 0}, {h + 0.25F, gate - 1.3F, 2.4F}, brick));
    world.add(wall, make_box({h, gate + 1.3F, 0}, {h + 0.25F, h, 2.4F}, brick));
    world.add(wall, make_box({h + 5, -h - 4, 0}, {h + 5.25F, h + 4, 3}, boards));
    for (const float y : {gate - 1.5F, gate + 1.3F}) {
        world.add(wall, make_box({h - 0.06F, y, 0}, {h + 0.32F, y + 0.2F, 2.7F}, stone));
    }
    world.add(world.add_object("fence"), make_box({-h, -h - 0.08F, 0}, {h, -h, 2.0F}, boards));
    const ObjectId door = world.add_object("garage door");
    for (int i = 0; i < 2; ++i) {
        const float x = -5.2F + 5.0F * static_cast<float>(i);
        world.add(door, make_box({x, h - 0.08F, 0.1F}, {x + 2.6F, h - 0.02F, 2.3F}, boards));
        world.add(wall, make_box({x - 0.12F, h - 0.12F, 2.3F}, {x + 2.72F, h, 2.5F}, stone));
    }
}

void add_clutter(World &world, const SceneOptions &options, const Yard &yard)
{
    const PropSurfaces surfaces = add_prop_surfaces(world, 220);
    Chance chance(options.seed * 37 + 11);
    const ObjectId clutter = world.add_object("clutter"), bush = world.add_object("bush");
    const float h = yard.half, low = yard.ring + 0.9F;
    const int count = static_cast<int>(22 * options.clutter);
    for (int i = 0; i < count; ++i) {
        const float angle =
            (kGateDeg + 22 + 316 * (static_cast<float>(i) + chance.between(0, 1)) / static_cast<float>(count)) *
            std::numbers::pi_v<float> / 180;
        /* Along the walls, out of the way of who walks round the ring; each third stands nearer. */
        const Eigen::Vector2f way(std::cos(angle), std::sin(angle));
        const float wall = (h - 0.6F) / way.cwiseAbs().maxCoeff();
        const float away = i % 3 == 0 ? low + 0.1F : wall - chance.between(0, 0.5F);
        Mesh thing;
        switch (chance.whole(0, 6)) {
        case 0: thing = make_cone(surfaces); break;
        case 1: thing = make_barrel(surfaces); break;
        case 2: thing = make_wheelie_bin(surfaces); break;
        case 3:
            thing = make_flower_pot(0.6F, surfaces);
            if (i % 3 != 0) {
                world.add(bush,
                          shifted(make_bush(0.45F, surfaces.leaves, chance), away * way.x(), away * way.y(), 0.57F));
            }
            break;
        case 4: thing = make_wood_pile(1.4F, chance.between(0.5F, 1.1F), surfaces, chance); break;
        default: {
            const Eigen::Vector3f size = chance.within({0.5F, 0.4F, 0.3F}, {0.9F, 0.6F, 0.7F});
            thing = make_crate(size, surfaces);
            thing.append(shifted(turned(make_crate(size * 0.7F, surfaces), chance.between(0, 40)), 0, 0, size.z()));
        }
        }
        if (i % 3 == 0) {
            thing = make_cone(surfaces);
        }
        world.add(clutter,
                  shifted(turned(std::move(thing), chance.between(0, 360)), away * way.x(), away * way.y(), 0));
    }
    const ObjectId tree = world.add_object("tree");
    const SurfaceId bark = surfaces.bark, leaves = surfaces.leaves;
    world.add(tree, shifted(make_tree(6.5F, bark, leaves, chance), -h - 2, -h + 1, 0));
    world.add(tree, shifted(make_tree(5.5F, bark, leaves, chance), 2, -h - 2.5F, 0));
    world.add(tree, shifted(make_tree(6.0F, bark, leaves, chance), h + 3, h - 2, 0));
}

/* What the boot is opened for, as parts of the scene's time. */
struct Times {
    double open_s, put_s, take_s, shut_s;
};

Times times_of(const SceneOptions &options)
{
    const double d = options.duration_s;
    const double open_s = 0.3 * d, take_s = 0.72 * d;
    return {open_s, open_s + std::min(5.0, 0.15 * d), take_s, take_s + std::min(4.0, 0.12 * d)};
}

/* 0 .. 1, soft at both ends. */
float eased(double time_s, double start_s, double length_s)
{
    const auto share = static_cast<float>(std::clamp((time_s - start_s) / length_s, 0.0, 1.0));
    return share * share * (3 - 2 * share);
}

Eigen::Vector2f boot_side()
{
    return {-2.75F, -0.25F};
}

/* The way in and out: through the gate and the opening, then round the car's left side to the boot. */
std::vector<Waypoint> way_to_boot(const Yard &yard)
{
    const Eigen::Vector2f gate = towards_gate(yard.half * 1.08F) + Eigen::Vector2f(0.4F, 0), inner = towards_gate(3.0F);
    return {{yard.half + 2.5F, gate.y() + 3.2F},
            {yard.half + 1.6F, gate.y() + 0.3F},
            {inner.x(), inner.y()},
            {1.2F, 1.65F},
            {-2.2F, 1.6F},
            {-2.8F, 1.0F},
            {boot_side().x(), boot_side().y()}};
}

struct Visit {
    Walk in, out;
};

/* Comes to the boot at arrive_s, leaves at leave_s. */
Visit make_visit(const Yard &yard, double arrive_s, double leave_s)
{
    Visit visit;
    visit.in.way = way_to_boot(yard);
    visit.in.start_s = arrive_s - end_of(visit.in);
    visit.out.way.assign(visit.in.way.rbegin(), visit.in.way.rend());
    visit.out.start_s = leave_s;
    return visit;
}

void add_visitor(World &world, const std::string &name, const Visit &visit, const Clothes &clothes)
{
    std::vector<PersonKey> keys = person_keys(visit.in);
    const std::vector<PersonKey> out = person_keys(visit.out);
    /* Turns to the boot, and away from it. */
    const double arrived_s = keys.back().time_s;
    keys.push_back({arrived_s + 0.6, boot_side().x(), boot_side().y(), 0});
    keys.push_back({std::max(visit.out.start_s - 0.6, arrived_s + 0.7), boot_side().x(), boot_side().y(), 0});
    for (const PersonKey &key : out) {
        if (key.time_s > keys.back().time_s) {
            keys.push_back(key);
        }
    }
    add_person(world, name, keys, clothes, {});
}

/* Opens and shuts about its hinge. */
Motion lid_motion(const Times &times)
{
    return [times](std::uint64_t time_us) -> std::optional<Eigen::Affine3f> {
        const double time_s = static_cast<double>(time_us) / 1e6;
        const float open = eased(time_s, times.open_s, kSwingS) - eased(time_s, times.shut_s, kSwingS);
        const float angle = kLidDeg * open * std::numbers::pi_v<float> / 180;
        return Eigen::Affine3f(Eigen::Translation3f(kCarBootHinge) *
                               Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitY()));
    };
}

/* In the boot, on the ground beside it, and carried away in front of who takes it. */
Path box_path(const Times &times, const Walk &out)
{
    const Eigen::Vector3f boot = kCarBootFloor, above(-2.3F, -0.1F, 1.0F), side(-2.55F, -1.15F, 0.012F);
    std::vector<PathKey> keys = {{0, boot, 0},
                                 {times.put_s, boot, 0},
                                 {times.put_s + 0.7, above, 10},
                                 {times.put_s + 1.4, side, 35},
                                 {times.take_s, side, 35},
                                 {times.take_s + 0.9, {-2.5F, -0.3F, 0.95F}, 0}};
    const double wait_until_s = std::max(out.start_s, times.take_s + 1.0);
    keys.push_back({wait_until_s, {-2.5F, -0.3F, 0.95F}, 0});
    for (PathKey key : path_keys(out, 0.95F)) {
        const float heading = key.heading_deg * std::numbers::pi_v<float> / 180;
        key.position += 0.38F * Eigen::Vector3f(std::cos(heading), std::sin(heading), 0);
        if (key.time_s > keys.back().time_s + 0.3) {
            keys.push_back(key);
        }
    }
    return {keys, false};
}

void add_car(World &world, const SceneOptions &options, const Times &times, const Walk &carried_out)
{
    const CarSurfaces surfaces = add_car_surfaces(world, static_cast<std::uint32_t>(options.seed * 3 + 5));
    CarMeshes car = make_car_meshes(surfaces, false);
    const ObjectId body = world.add_object("car");
    world.add(body, std::move(car.body));
    world.add(world.add_object("car window"), std::move(car.panes));
    const ObjectId wheel = world.add_object("wheel");
    world.add(wheel, shifted(car.axle, kCarAxleM, 0, kCarWheelM));
    world.add(wheel, shifted(std::move(car.axle), -kCarAxleM, 0, kCarWheelM));
    world.add(world.add_object("boot lid"), std::move(car.boot_lid), lid_motion(times));
    const SurfaceId card = world.add_surface({Pattern::patches, 0.55F, 0.35F, 0.1F, 0.3F, 240});
    const SurfaceId tape = world.add_surface({Pattern::plain, 0.8F, 0, 0.1F, 0.2F, 241});
    Mesh box = make_box({-0.2F, -0.26F, 0}, {0.2F, 0.26F, 0.34F}, card);
    box.append(make_box({-0.201F, -0.03F, 0.1F}, {0.201F, 0.03F, 0.342F}, tape));
    world.add(world.add_object("box"), std::move(box), follow(box_path(times, carried_out)));
    tell(world, times.open_s, "the boot opens");
    tell(world, times.put_s, "a box is put down");
    tell(world, times.take_s, "the box is taken away");
    tell(world, times.shut_s, "the boot closes");
}

/* By turns round the outside of the ring, and in through its opening round the car. */
void add_passer(World &world, const Yard &yard, int index, int count, double duration_s, Chance &chance)
{
    const Eigen::Vector2f gate = towards_gate(yard.half * 1.08F);
    const float r = (yard.ring + yard.half) / 2 + 0.1F;
    Walk walk;
    walk.speed_m_s = chance.between(1.0F, 1.5F);
    walk.start_s = duration_s * (index + chance.between(0.1F, 0.6F)) / count;
    walk.way = {{yard.half + 2.5F, gate.y() - 4.5F}, {yard.half + 1.6F, gate.y() - 0.2F}};
    std::vector<Waypoint> round;
    if (index % 2 == 0) {
        round = {{r, 2.2F},      {r, -r * 0.75F}, {r * 0.7F, -r}, {-r * 0.7F, -r}, {-r, -r * 0.7F},
                 {-r, r * 0.7F}, {-r * 0.7F, r},  {r * 0.6F, r},  {r, r * 0.7F}};
    } else {
        const Eigen::Vector2f inner = towards_gate(3.1F);
        round = {{inner.x(), inner.y()}, {2.7F, -0.6F, 2.0F}, {1.6F, -1.7F},         {0.6F, -1.55F, 3.0F},
                 {1.6F, -1.7F},          {2.75F, -0.4F},      {inner.x(), inner.y()}};
    }
    walk.way.insert(walk.way.end(), round.begin(), round.end());
    walk.way.push_back({yard.half + 1.6F, gate.y() + 0.2F});
    walk.way.push_back({yard.half + 2.5F, gate.y() + 4.0F});
    const auto clothes = make_clothes(world, 310 + static_cast<std::uint32_t>(index) * 5);
    add_person(world, "person " + std::to_string(index + 2), person_keys(walk), clothes,
               {chance.between(1.6F, 1.9F), 0, false});
    tell(world, time_within(walk, {-yard.half, -yard.half}, {yard.half, yard.half}), "a person enters");
}

void add_people(World &world, const SceneOptions &options, const Yard &yard, const Visit &first, const Visit &second)
{
    Chance chance(options.seed * 41 + 3);
    const Eigen::Vector2f low(-yard.half, -yard.half), high(yard.half, yard.half);
    if (options.people > 0) {
        const Clothes clothes = make_clothes(world, static_cast<std::uint32_t>(options.seed * 8 + 300));
        add_visitor(world, "person 1", first, clothes);
        add_visitor(world, "person 1", second, clothes);
        tell(world, time_within(first.in, low, high), "a person walks up");
        tell(world, time_within(second.in, low, high), "a person walks up");
    }
    for (int i = 0; i + 1 < options.people; ++i) {
        add_passer(world, yard, i, options.people - 1, options.duration_s, chance);
    }
}

} // namespace

Scene make_car(const SceneOptions &options, const LayoutOptions &layout)
{
    Scene scene;
    World &world = scene.world;
    /* Nearer than this whoever is at the boot would stand in the ring. */
    LayoutOptions ring = layout;
    ring.distance_m = std::max(layout.distance_m > 0 ? layout.distance_m : kRingM, 3.6);
    const Yard yard{static_cast<float>(ring.distance_m), static_cast<float>(ring.distance_m) + 3.6F};
    const Times times = times_of(options);
    const Visit first = make_visit(yard, times.open_s - 0.8, times.put_s + 2.2);
    const Visit second = make_visit(yard, times.take_s - 0.8, times.shut_s + 2.2);
    add_yard(world, yard);
    add_clutter(world, options, yard);
    add_car(world, options, times, second.out);
    add_people(world, options, yard, first, second);
    settle_events(world, options.duration_s);
    world.light = make_daylight(options, 0.65F, 0.95F, 235, 46);
    scene.placements = make_ring(ring, {0, 0, 0.7}, kRingM, 0.8, 2.0, kGateDeg + kGateSpanDeg / 2, 360 - kGateSpanDeg);
    scene.fov_deg = 70;
    scene.gateway = {-yard.half + 0.3, 0, 2.4};
    return scene;
}

} // namespace tsr::scene
