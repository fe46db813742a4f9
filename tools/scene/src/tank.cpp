/*
 * The tank: a basin in a hall, its level rising and falling in steps.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>

#include "scene_parts.h"
#include "tsr/scene/path.h"

namespace tsr::scene
{

namespace
{

constexpr float kInnerX = 2.4F, kInnerY = 1.8F, kDepth = 1.5F, kWall = 0.12F;
constexpr float kLevelLowM = 0.4F;

void add_basin(World &world)
{
    const SurfaceId concrete = world.add_surface({Pattern::plain, 0.55F, 0, 0.3F, 0.35F, 11});
    const SurfaceId floor = world.add_surface({Pattern::tiles, 0.35F, 0.2F, 0.3F, 0.3F, 12});
    const SurfaceId steel = world.add_surface({Pattern::plain, 0.3F, 0, 0.08F, 0.4F, 13});
    const SurfaceId marks = world.add_surface({Pattern::stripes, 0.8F, 0.1F, 0.2F, 0.1F, 14});
    world.add(world.add_object("floor"), make_box({-5, -5, -0.2F}, {5, 5, 0}, floor));
    const ObjectId basin = world.add_object("basin");
    const float x = kInnerX / 2, y = kInnerY / 2;
    Mesh walls = make_box({-x - kWall, -y - kWall, 0}, {-x, y + kWall, kDepth}, concrete);
    walls.append(make_box({x, -y - kWall, 0}, {x + kWall, y + kWall, kDepth}, concrete));
    walls.append(make_box({-x, -y - kWall, 0}, {x, -y, kDepth}, concrete));
    walls.append(make_box({-x, y, 0}, {x, y + kWall, kDepth}, concrete));
    world.add(basin, std::move(walls));
    const ObjectId fittings = world.add_object("fittings");
    Mesh pipe = turned(make_cylinder(0.07F, 0.07F, 2.4F, 16, steel), 90, Eigen::Vector3f::UnitX());
    world.add(fittings, shifted(pipe, 0.7F, 2.2F, kDepth + 0.25F));
    for (int i = 0; i < 5; ++i) { /* a ladder */
        world.add(fittings, make_centred_box({-x + 0.05F, -0.4F, 0.2F + 0.3F * static_cast<float>(i)},
                                             {0.06F, 0.4F, 0.03F}, steel));
    }
    world.add(fittings, make_centred_box({-x + 0.03F, -0.62F, kDepth / 2}, {0.05F, 0.04F, kDepth + 0.3F}, steel));
    world.add(fittings, make_centred_box({-x + 0.03F, -0.18F, kDepth / 2}, {0.05F, 0.04F, kDepth + 0.3F}, steel));
    world.add(fittings, make_centred_box({0.2F, y - 0.02F, kDepth / 2}, {0.18F, 0.03F, kDepth}, marks));
}

void add_hall(World &world, const SceneOptions &options)
{
    const SurfaceId brick = world.add_surface({Pattern::brick, 0.42F, 0.6F, 0.25F, 0.25F, 21});
    const ObjectId walls = world.add_object("hall");
    world.add(walls, make_box({-5.2F, -5, 0}, {-5, 5, 3.5F}, brick));
    world.add(walls, make_box({5, -5, 0}, {5.2F, 5, 3.5F}, brick));
    world.add(walls, make_box({-5, -5.2F, 0}, {5, -5, 3.5F}, brick));
    world.add(walls, make_box({-5, 5, 0}, {5, 5.2F, 3.5F}, brick));
    Chance chance(options.seed * 31 + 7);
    const ObjectId clutter = world.add_object("clutter");
    for (int i = 0; i < static_cast<int>(14 * options.clutter); ++i) {
        const SurfaceId surface = world.add_surface(
            {i % 2 == 0 ? Pattern::planks : Pattern::patches, chance.between(0.15F, 0.75F), chance.between(0.05F, 0.3F),
             chance.between(0.1F, 0.3F), 0.4F, static_cast<std::uint32_t>(100 + i)});
        const float angle = chance.between(0, 6.28F), away = chance.between(2.6F, 4.4F);
        /* One after the other: compilers differ in the order of arguments. */
        const float high = chance.between(0.2F, 1.1F), deep = chance.between(0.2F, 0.7F),
                    wide = chance.between(0.2F, 0.7F);
        const Eigen::Vector3f size(wide, deep, high);
        Mesh thing = i % 3 == 0 ? make_cylinder(size.x() / 2, size.x() / 2, size.z(), 18, surface)
                                : shifted(make_centred_box({0, 0, 0}, size, surface), 0, 0, size.z() / 2);
        world.add(clutter, shifted(turned(std::move(thing), chance.between(0, 90)), away * std::cos(angle),
                                   away * std::sin(angle), 0));
    }
}

/* Up, wait, up ... and down again, as long as the scene lasts. */
Path level_path(const SceneOptions &options, std::vector<Event> &events)
{
    const auto step = static_cast<float>(options.level_step_m);
    const double moving_s = options.level_step_m / options.level_rate_m_s;
    const double rest_s = std::max(20.0, moving_s);
    float level = kLevelLowM;
    bool rising = true;
    std::vector<PathKey> keys = {{0, {0, 0, level}, 0}};
    for (double time_s = rest_s; time_s + moving_s < options.duration_s; time_s += rest_s + moving_s) {
        if (rising && level + step > kDepth - 0.1F) {
            rising = false;
        } else if (!rising && level - step < kLevelLowM / 2) {
            rising = true;
        }
        keys.push_back({time_s, {0, 0, level}, 0});
        level += rising ? step : -step;
        keys.push_back({time_s + moving_s, {0, 0, level}, 0});
        events.push_back({static_cast<std::uint64_t>(time_s * 1e6), rising ? "the level rises" : "the level falls"});
    }
    return {keys, true};
}

} // namespace

Scene make_tank(const SceneOptions &options, const LayoutOptions &layout)
{
    Scene scene;
    World &world = scene.world;
    add_basin(world);
    add_hall(world, options);
    /* Grain, foam, pellets: what fills the tank is matt and has a texture of its own. */
    const SurfaceId grain = world.add_surface({Pattern::patches, 0.7F, 0.25F, 0.05F, 0.3F, 41});
    const ObjectId content = world.add_object("content");
    world.add(content, make_box({-kInnerX / 2, -kInnerY / 2, -0.02F}, {kInnerX / 2, kInnerY / 2, 0}, grain),
              follow(level_path(options, world.events)));
    world.has_sun = false;
    world.lamp_position = Eigen::Vector3f(0.8F, -1.2F, 3.3F);
    world.light = [options](std::uint64_t time_us) {
        Light light;
        light.sky = 0.6F * drift_at(options, time_us);
        light.lamp = 1.6F;
        return light;
    };
    scene.placements = make_ring(layout, {0, 0, 0.8}, 2.2, 2.5, 3.0, -90, 360);
    scene.fov_deg = 70;
    scene.gateway = {0, -4, 2};
    return scene;
}

} // namespace tsr::scene
