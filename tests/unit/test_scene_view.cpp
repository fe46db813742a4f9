/*
 * What virtual cameras see: depth, labels, shadows, and that tracing only what
 * moved gives the picture that tracing everything gives.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>

#include <gtest/gtest.h>

#include "tsr/scene/path.h"
#include "tsr/scene/scene.h"
#include "tsr/scene/view.h"

namespace
{

using namespace tsr::scene;

Camera looking_down_y()
{
    Camera camera;
    camera.width = 40;
    camera.height = 30;
    camera.focal_px = 40;
    camera.principal_px = {19.5, 14.5};
    camera.pose = look_at({0, -5, 1}, {0, 0, 1});
    return camera;
}

TEST(SceneView, DepthAndObjectsAreExact)
{
    World world;
    const SurfaceId gray = world.add_surface({});
    const ObjectId wall = world.add_object("wall"), ball = world.add_object("ball");
    world.add(wall, make_box({-20, 3, -20}, {20, 4, 20}, gray));
    world.add(ball, shifted(make_ellipsoid({1, 1, 1}, 64, gray), 0, 0, 1));
    const Geometry geometry(world);
    RayCaster caster(geometry);
    const Truth truth = View(geometry, looking_down_y()).truth(caster, 0);
    const std::size_t corner = 0, middle = 14 * 40 + 19;
    EXPECT_EQ(truth.objects[corner], wall);
    EXPECT_NEAR(truth.depth_m[corner], 8, 1e-4); /* along the axis, not along the ray */
    EXPECT_EQ(truth.objects[middle], ball);
    EXPECT_NEAR(truth.depth_m[middle], 4, 0.01);
}

TEST(SceneView, WhatNoRayMeetsIsSky)
{
    World world;
    world.add(world.add_object("floor"), make_box({-50, -50, -1}, {50, 50, 0}, world.add_surface({})));
    const Geometry geometry(world);
    RayCaster caster(geometry);
    const Truth truth = View(geometry, looking_down_y()).truth(caster, 0);
    EXPECT_EQ(truth.objects.front(), 0);
    EXPECT_EQ(truth.depth_m.front(), 0);
    EXPECT_GT(truth.depth_m.back(), 0);
}

/* Half way between a pose and the same turned by 180 degrees, matrices meet in nothing. */
TEST(SceneView, AThingThatTurnsRoundWhileRowsAreReadIsSeen)
{
    World world;
    const ObjectId door = world.add_object("door");
    world.add(door, make_box({-3, -0.1F, -3}, {3, 0.1F, 5}, world.add_surface({})), [](std::uint64_t time_us) {
        const float angle = time_us < 100'000 ? 0 : static_cast<float>(M_PI);
        return Eigen::Affine3f(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
    });
    const Geometry geometry(world);
    RayCaster caster(geometry);
    Camera camera = looking_down_y();
    camera.readout_us = 200'000;
    View view(geometry, camera);
    view.render(caster, 0);
    const Truth truth = view.truth(caster, 0);
    for (const std::size_t row : {0u, 14u, 15u, 29u}) {
        EXPECT_EQ(truth.objects[row * 40 + 19], door) << row;
        EXPECT_NEAR(truth.depth_m[row * 40 + 19], 4.9, 0.01) << row;
    }
}

/* A post between the sun and the floor: its shadow lies where geometry says. */
TEST(SceneView, TheSunCastsShadows)
{
    World world;
    const SurfaceId gray = world.add_surface({Pattern::plain, 0.5F, 0, 1, 0, 0});
    world.add(world.add_object("floor"), make_box({-50, -50, -1}, {50, 50, 0}, gray));
    world.add(world.add_object("post"), make_box({-1.2F, -0.4F, 0}, {-1, 0.4F, 2}, gray));
    world.light = [](std::uint64_t) { return Light{.sky = 0, .sun = 1, .to_sun = {-1, 0, 1}, .lamp = 0}; };
    const Geometry geometry(world);
    RayCaster caster(geometry);
    Camera camera = looking_down_y();
    camera.pose = look_at({0.1, -0.001, 6}, {0.1, 0, 0});
    View view(geometry, camera);
    const Layers &layers = view.render(caster, 0);
    const auto lit_at = [&](double x, double y) { /* floor point to pixel */
                                                  const Eigen::Vector2d pixel = projected(
                                                      camera, camera.pose.inverse() * Eigen::Vector3d(x, y, 0));
                                                  return layers.sun[static_cast<std::size_t>(
                                                      std::lround(pixel.y()) * camera.width + std::lround(pixel.x()))];
    };
    EXPECT_FLOAT_EQ(lit_at(0.5, 0), 0);                        /* 2 m high: the shadow ends at x = 1 */
    EXPECT_NEAR(lit_at(1.6, 0), 0.5 * std::sqrt(0.5), 1e-3);   /* beyond it */
    EXPECT_NEAR(lit_at(0.5, 0.9), 0.5 * std::sqrt(0.5), 1e-3); /* beside it */
}

void expect_same(const Layers &a, const Layers &b, const char *where)
{
    EXPECT_EQ(a.sky, b.sky) << where;
    EXPECT_EQ(a.sun, b.sun) << where;
    EXPECT_EQ(a.lamp, b.lamp) << where;
}

class SceneKinds : public testing::TestWithParam<std::string>
{
};

TEST_P(SceneKinds, TracingWhatMovedIsTracingEverything)
{
    SceneOptions options;
    options.kind = GetParam();
    options.duration_s = 60;
    options.sun_hours = 0.05; /* a step every 20 s */
    LayoutOptions layout;
    layout.count = 3;
    const Scene scene = make_scene(options, layout);
    const Geometry geometry(scene.world);
    RayCaster caster(geometry);
    Camera camera = looking_down_y();
    camera.readout_us = 30'000;
    camera.distortion = {-0.15, 0.02, 0, 0};
    std::uint64_t traced = 0, pixels = 0;
    for (const Placement &placement : scene.placements) {
        camera.pose = look_at(placement.eye, placement.target);
        View kept(geometry, camera);
        for (const std::uint64_t time_s : {2, 9, 15, 16, 17, 22, 30, 31, 36, 37, 45, 52, 58, 59}) {
            const std::uint64_t before = kept.traced();
            const Layers &layers = kept.render(caster, time_s * 1'000'000);
            traced += kept.traced() - before;
            pixels += 40 * 30;
            View fresh(geometry, camera);
            expect_same(layers, fresh.render(caster, time_s * 1'000'000), placement.name.c_str());
            ASSERT_FALSE(HasFailure()) << GetParam() << " at " << time_s << " s";
        }
    }
    EXPECT_LT(traced, pixels * 8 / 10) << "nothing is saved";
}

TEST_P(SceneKinds, HasLightThingsAndEventsInOrder)
{
    SceneOptions options;
    options.kind = GetParam();
    const Scene scene = make_scene(options, {});
    EXPECT_GT(scene.world.objects.size(), 4u);
    EXPECT_FALSE(scene.world.events.empty());
    for (std::size_t i = 0; i < scene.world.events.size(); ++i) {
        EXPECT_LE(scene.world.events[i].time_us, 120'000'000u);
        EXPECT_TRUE(i == 0 || scene.world.events[i - 1].time_us <= scene.world.events[i].time_us);
    }
    std::size_t movers = 0;
    for (const Body &body : scene.world.bodies) {
        EXPECT_LT(body.object, scene.world.objects.size());
        movers += static_cast<std::size_t>(static_cast<bool>(body.motion));
    }
    EXPECT_GT(movers, 0u);
}

/* Two builds of a scene are the same, and seeds matter. */
TEST_P(SceneKinds, FollowsItsSeed)
{
    SceneOptions options;
    options.kind = GetParam();
    const auto vertices = [&](std::uint64_t seed) {
        options.seed = seed;
        std::vector<Eigen::Vector3f> all;
        for (const Body &body : make_scene(options, {}).world.bodies) {
            all.insert(all.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
        }
        return all;
    };
    EXPECT_EQ(vertices(3), vertices(3));
    EXPECT_NE(vertices(3), vertices(4));
}

INSTANTIATE_TEST_SUITE_P(All, SceneKinds, testing::ValuesIn(scene_kinds()),
                         [](const auto &info) { return info.param; });

} // namespace
