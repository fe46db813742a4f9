/*
 * The bedroom: a person comes in, sits, walks about, falls, gets up and leaves.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>
#include <numbers>

#include "scene_parts.h"
#include "tsr/scene/person.h"

namespace tsr::scene
{

namespace
{

/* The room: x from -X to X, y from -Y to Y; the door in the south wall, the window in the north one. */
constexpr float kX = 2.4F, kY = 2.1F, kHigh = 2.7F, kWall = 0.15F;
constexpr float kDoorX = 1.3F, kDoorWide = 0.9F;
constexpr float kWalkM_s = 0.9F;

void add_shell(World &world)
{
    const SurfaceId paper = world.add_surface({Pattern::stripes, 0.62F, 0.5F, 0.18F, 0.12F, 61});
    const SurfaceId plaster = world.add_surface({Pattern::plain, 0.7F, 0, 0.5F, 0.12F, 62});
    const SurfaceId parquet = world.add_surface({Pattern::planks, 0.36F, 0.15F, 0.12F, 0.35F, 63});
    const SurfaceId white = world.add_surface({Pattern::plain, 0.8F, 0, 0.3F, 0.06F, 64});
    world.add(world.add_object("floor"), make_box({-kX - 2, -kY - 2, -0.2F}, {kX + 2, kY + 1, 0}, parquet));
    world.add(world.add_object("ceiling"),
              make_box({-kX - 0.2F, -kY - 0.2F, kHigh}, {kX + 0.2F, kY + 0.2F, kHigh + 0.2F}, plaster));
    const ObjectId walls = world.add_object("wall");
    const Mesh south = make_wall(2 * kX + 2 * kWall, kHigh, kWall,
                                 {{kX + kWall + kDoorX - kDoorWide / 2, 0, kDoorWide, 2.05F}}, plaster);
    world.add(walls, shifted(south, -kX - kWall, -kY - kWall, 0));
    const Mesh north = make_wall(2 * kX + 2 * kWall, kHigh, kWall, {{1.5F, 0.95F, 1.5F, 1.25F}}, paper);
    world.add(walls, shifted(north, -kX - kWall, kY, 0));
    world.add(walls, make_box({-kX - kWall, -kY, 0}, {-kX, kY, kHigh}, paper));
    world.add(walls, make_box({kX, -kY, 0}, {kX + kWall, kY, kHigh}, plaster));
    const ObjectId frame = world.add_object("window frame");
    const float left = -kX - kWall + 1.5F;
    world.add(frame, make_centred_box({left + 0.75F, kY + 0.06F, 1.575F}, {0.05F, 0.05F, 1.25F}, white));
    world.add(frame, make_centred_box({left + 0.75F, kY - 0.05F, 0.93F}, {1.6F, 0.22F, 0.04F}, white));
    const SurfaceId cloth = world.add_surface({Pattern::stripes, 0.55F, 0.2F, 0.15F, 0.3F, 65});
    const ObjectId curtains = world.add_object("curtain");
    for (const float x : {left - 0.15F, left + 1.65F}) { /* curtains in folds */
        for (int fold = 0; fold < 5; ++fold) {
            const float away = 0.05F * static_cast<float>(fold - 2);
            world.add(curtains, shifted(make_cylinder(0.035F, 0.04F, 2.1F, 8, cloth), x + away, kY - 0.12F, 0.25F));
        }
    }
}

void add_bed(World &world)
{
    const SurfaceId wood = world.add_surface({Pattern::planks, 0.3F, 0.12F, 0.1F, 0.4F, 71});
    const SurfaceId sheet = world.add_surface({Pattern::plain, 0.78F, 0, 0.12F, 0.2F, 72});
    const SurfaceId blanket = world.add_surface({Pattern::patches, 0.5F, 0.22F, 0.07F, 0.3F, 73});
    const ObjectId bed = world.add_object("bed");
    world.add(bed, make_box({-kX + 0.05F, -1.0F, 0.15F}, {-kX + 2.05F, 0.5F, 0.35F}, wood));
    world.add(bed, make_box({-kX + 0.05F, -1.0F, 0.35F}, {-kX + 2.0F, 0.5F, 0.52F}, sheet));
    world.add(bed, make_box({-kX + 0.7F, -1.03F, 0.5F}, {-kX + 2.05F, 0.53F, 0.58F}, blanket));
    world.add(bed, make_box({-kX, -1.0F, 0}, {-kX + 0.06F, 0.5F, 0.95F}, wood));
    world.add(bed, shifted(make_ellipsoid({0.2F, 0.35F, 0.09F}, 20, sheet), -kX + 0.35F, -0.55F, 0.58F));
    world.add(bed, shifted(make_ellipsoid({0.2F, 0.35F, 0.09F}, 20, sheet), -kX + 0.35F, 0.1F, 0.58F));
}

void add_furniture(World &world, const SceneOptions &options)
{
    const SurfaceId oak = world.add_surface({Pattern::planks, 0.42F, 0.2F, 0.15F, 0.4F, 81});
    const SurfaceId dark = world.add_surface({Pattern::planks, 0.2F, 0.08F, 0.12F, 0.5F, 82});
    const SurfaceId carpet = world.add_surface({Pattern::patches, 0.45F, 0.18F, 0.09F, 0.4F, 83});
    world.add(world.add_object("carpet"), make_box({-0.6F, -0.9F, 0}, {1.5F, 0.7F, 0.015F}, carpet));
    const ObjectId wardrobe = world.add_object("wardrobe");
    world.add(wardrobe, make_box({-kX + 0.02F, -kY + 0.02F, 0}, {-kX + 1.6F, -kY + 0.55F, 1.95F}, oak));
    for (const float x : {-kX + 0.76F, -kX + 0.86F}) {
        world.add(wardrobe, make_centred_box({x, -kY + 0.57F, 1.0F}, {0.025F, 0.04F, 0.16F}, dark));
    }
    const ObjectId desk = world.add_object("desk");
    world.add(desk, make_box({kX - 0.6F, 0.4F, 0.7F}, {kX - 0.02F, 1.8F, 0.74F}, dark));
    for (const float y : {0.45F, 1.75F}) {
        world.add(desk, make_box({kX - 0.58F, y - 0.03F, 0}, {kX - 0.06F, y + 0.03F, 0.7F}, dark));
    }
    const ObjectId chair = world.add_object("chair");
    world.add(chair, make_centred_box({1.4F, 1.1F, 0.43F}, {0.42F, 0.42F, 0.04F}, oak));
    world.add(chair, make_centred_box({1.2F, 1.1F, 0.7F}, {0.03F, 0.42F, 0.5F}, oak));
    for (const float x : {1.22F, 1.58F}) {
        for (const float y : {0.92F, 1.28F}) {
            world.add(chair, make_centred_box({x, y, 0.205F}, {0.03F, 0.03F, 0.41F}, oak));
        }
    }
    Chance chance(options.seed * 17 + 3);
    const ObjectId books = world.add_object("books");
    const ObjectId shelf = world.add_object("shelf");
    for (const float z : {1.15F, 1.5F, 1.85F}) {
        world.add(shelf, make_box({kX - 0.25F, 0.3F, z}, {kX, 1.9F, z + 0.025F}, oak));
        float y = 0.35F;
        while (y < 1.75F && options.clutter > 0) {
            const float thick = chance.between(0.02F, 0.06F), tall = chance.between(0.16F, 0.26F);
            const SurfaceId cover = world.add_surface({Pattern::plain, chance.between(0.08F, 0.75F), 0, 0.06F, 0.4F,
                                                       static_cast<std::uint32_t>(chance.whole(0, 1 << 20))});
            world.add(books, make_box({kX - chance.between(0.15F, 0.22F), y, z + 0.025F},
                                      {kX - 0.01F, y + thick, z + 0.025F + tall}, cover));
            y += thick +
                 (chance.whole(0, 6) == 0 ? chance.between(0.05F, 0.2F) : 0.003F) / static_cast<float>(options.clutter);
        }
    }
    const ObjectId clutter = world.add_object("clutter");
    for (int i = 0; i < static_cast<int>(8 * options.clutter); ++i) { /* under the window and on the desk */
        const SurfaceId surface = world.add_surface(
            {i % 2 == 0 ? Pattern::patches : Pattern::stripes, chance.between(0.3F, 0.75F), chance.between(0.08F, 0.3F),
             chance.between(0.04F, 0.12F), 0.4F, static_cast<std::uint32_t>(900 + i)});
        const float side = chance.between(0.08F, 0.3F);
        const bool on_desk = i % 3 == 0;
        const float x = on_desk ? kX - chance.between(0.15F, 0.45F) : chance.between(-1.8F, 0.9F);
        const float y = on_desk ? chance.between(0.6F, 1.6F) : kY - chance.between(0.2F, 0.4F);
        Mesh thing = i % 4 == 3 ? make_cylinder(side / 2, side / 3, side * 1.2F, 16, surface)
                                : shifted(make_centred_box({0, 0, 0}, {side, side, side}, surface), 0, 0, side / 2);
        world.add(clutter, shifted(turned(std::move(thing), chance.between(0, 90)), x, y, on_desk ? 0.74F : 0));
    }
    const SurfaceId picture = world.add_surface({Pattern::patches, 0.7F, 0.15F, 0.1F, 0.4F, 91});
    world.add(world.add_object("picture"), make_centred_box({-kX + 0.015F, 1.2F, 1.6F}, {0.03F, 0.8F, 0.6F}, picture));
}

/* Keys one after the other; what is left of the scene's time is shared out among the rests. */
class Script
{
  public:
    Script(double start_s, double pace) : time_s_(start_s), pace_(pace) {}

    void walk(float x, float y)
    {
        if (keys_.empty()) {
            keys_.push_back({time_s_, x, y, 90, Posture::standing});
            return;
        }
        const float dx = x - keys_.back().x, dy = y - keys_.back().y;
        const float heading = std::atan2(dy, dx) * 180 / std::numbers::pi_v<float>;
        pose(heading, Posture::standing, 0.4);
        time_s_ += static_cast<double>(std::hypot(dx, dy) / kWalkM_s) * pace_;
        keys_.push_back({time_s_, x, y, heading, Posture::standing});
    }
    void pose(float heading_deg, Posture posture, double takes_s)
    {
        time_s_ += takes_s * pace_;
        keys_.push_back({time_s_, keys_.back().x, keys_.back().y, heading_deg, posture});
    }
    void rest(double time_s)
    {
        time_s_ += time_s;
        keys_.push_back(keys_.back());
        keys_.back().time_s = time_s_;
    }
    double now_s() const { return time_s_; }
    const std::vector<PersonKey> &keys() const { return keys_; }

  private:
    std::vector<PersonKey> keys_;
    double time_s_;
    double pace_;
};

/* In, to the chair, up, to the window, a fall on the way back, up again, out. Events are noted if asked for. */
Script day(double start_s, double pace, double rest_s, std::vector<Event> *events)
{
    const auto note = [&](double time_s, const char *what) {
        if (events != nullptr) {
            events->push_back({static_cast<std::uint64_t>(time_s * 1e6), what});
        }
    };
    Script script(start_s, pace);
    script.walk(kDoorX, -kY - 1.5F);
    script.walk(kDoorX, -kY + 0.4F);
    note(script.now_s(), "a person enters");
    script.walk(0.95F, 0.4F);
    script.walk(1.35F, 0.75F);
    script.walk(1.42F, 1.1F);
    script.pose(0, Posture::sitting, 1.5);
    note(script.now_s(), "the person sits");
    script.rest(rest_s);
    script.pose(0, Posture::standing, 1.5);
    note(script.now_s(), "the person gets up");
    script.walk(0.9F, 0.9F);
    script.walk(-0.6F, 1.5F);
    script.pose(90, Posture::standing, 1);
    script.rest(rest_s);
    script.walk(0.2F, 0.5F);
    note(script.now_s(), "the person falls");
    script.pose(200, Posture::lying, 0.9);
    script.rest(rest_s);
    script.pose(-20, Posture::standing, 5);
    note(script.now_s(), "the person gets up");
    script.rest(rest_s / 4);
    script.walk(kDoorX, -kY + 0.4F);
    script.walk(kDoorX, -kY - 1.5F);
    note(script.now_s(), "the person leaves");
    return script;
}

void add_people(World &world, const SceneOptions &options)
{
    if (options.people < 1) {
        return;
    }
    const double start_s = 0.08 * options.duration_s;
    const double moving_s = day(0, 1, 0, nullptr).now_s(), room_s = 0.88 * options.duration_s - start_s;
    const double pace = std::min(1.0, room_s / moving_s); /* a short scene is hurried */
    const double rest_s = std::max(0.0, room_s - moving_s) / 3.25;
    add_person(world, "person 1", day(start_s, pace, rest_s, &world.events).keys(), make_clothes(world, 5), {});
    for (int i = 1; i < options.people; ++i) { /* others look in at the door while the first lies */
        const double at_s = start_s + room_s * (0.70 + 0.04 * i);
        Script visit(at_s, pace);
        visit.walk(kDoorX, -kY - 1.5F - 0.5F * static_cast<float>(i));
        visit.walk(kDoorX - 0.1F, -kY + 0.5F + 0.2F * static_cast<float>(i % 3));
        visit.rest(0.05 * options.duration_s);
        visit.walk(kDoorX, -kY - 1.5F - 0.5F * static_cast<float>(i));
        add_person(world, "person " + std::to_string(i + 1), visit.keys(),
                   make_clothes(world, static_cast<std::uint32_t>(5 + 7 * i)),
                   {.height_m = 1.6F + 0.05F * static_cast<float>(i % 5)});
    }
}

} // namespace

Scene make_bedroom(const SceneOptions &options, const LayoutOptions &layout)
{
    Scene scene;
    World &world = scene.world;
    add_shell(world);
    add_bed(world);
    add_furniture(world, options);
    add_people(world, options);
    world.lamp_position = Eigen::Vector3f(0.2F, -0.1F, kHigh - 0.25F);
    world.light = [options](std::uint64_t time_us) {
        Light light;
        light.sky = 0.55F * drift_at(options, time_us); /* from the window, spread by the walls */
        light.sun = 0.8F * drift_at(options, time_us);
        light.to_sun = {0.35F, 0.75F, 0.55F};
        light.lamp = 1.0F;
        return light;
    };
    scene.placements = make_ring(layout, {0, 0, 0.7}, 1.75, 2.1, 2.4, -60, 360);
    scene.fov_deg = 90;
    scene.gateway = {kDoorX, -kY - 1, 2};
    return scene;
}

} // namespace tsr::scene
