/*
 * Solids of virtual scenes: closed, turned outwards, of the right volume.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <map>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

#include "tsr/scene/mesh.h"

namespace
{

using tsr::scene::Mesh;
using Point = std::tuple<long, long, long>;

Point rounded(const Eigen::Vector3f &v)
{
    return {std::lround(v.x() * 1e4F), std::lround(v.y() * 1e4F), std::lround(v.z() * 1e4F)};
}

/* Each edge of a closed, evenly turned surface is walked once in each direction. */
bool is_closed(const Mesh &mesh)
{
    std::map<std::pair<Point, Point>, int> walked;
    for (const auto &triangle : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Point a = rounded(mesh.vertices[triangle[i]]), b = rounded(mesh.vertices[triangle[(i + 1) % 3]]);
            if (a != b) {
                ++walked[{a, b}];
            }
        }
    }
    for (const auto &[edge, count] : walked) {
        const auto back = walked.find({edge.second, edge.first});
        if (back == walked.end() || back->second != count) {
            return false;
        }
    }
    return !walked.empty();
}

/* By the divergence theorem; positive if the triangles turn outwards. */
double volume(const Mesh &mesh)
{
    double sum = 0;
    for (const auto &triangle : mesh.triangles) {
        const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
        sum += a.dot(mesh.vertices[triangle[1]].cast<double>().cross(mesh.vertices[triangle[2]].cast<double>())) / 6;
    }
    return sum;
}

constexpr double kPi = std::numbers::pi;

TEST(SceneMesh, SolidsAreClosedAndTurnedOutwards)
{
    struct Case {
        const char *name;
        Mesh mesh;
        double volume;
        double tolerance; /* polygons have less than the round thing they stand for */
    };
    const Case cases[] = {
        {"box", tsr::scene::make_box({-1, 0, 2}, {1, 3, 2.5F}, 0), 3, 1e-5},
        {"centred box", tsr::scene::make_centred_box({5, 5, 5}, {1, 2, 3}, 0), 6, 1e-4},
        {"cylinder", tsr::scene::make_cylinder(0.5F, 0.5F, 2, 64, 0), kPi * 0.5, 0.01},
        {"cone", tsr::scene::make_cylinder(0.6F, 0, 1, 64, 0), kPi * 0.36 / 3, 0.01},
        {"ellipsoid", tsr::scene::make_ellipsoid({1, 0.5F, 0.25F}, 64, 0), 4 * kPi / 3 * 0.125, 0.02},
        {"limb", tsr::scene::make_limb(0.2F, 0.2F, 1, 64, 0), kPi * 0.04 + 4 * kPi / 3 * 0.008, 0.01},
        {"prism", tsr::scene::make_prism({{0, 0}, {4, 0}, {2, 3}}, 2, 0), 12, 1e-4},
        {"wall", tsr::scene::make_wall(5, 3, 0.2F, {}, 0), 3, 1e-4},
    };
    for (const Case &one : cases) {
        EXPECT_TRUE(is_closed(one.mesh)) << one.name;
        EXPECT_NEAR(volume(one.mesh), one.volume, one.tolerance) << one.name;
        EXPECT_EQ(one.mesh.surfaces.size(), one.mesh.triangles.size()) << one.name;
    }
}

TEST(SceneMesh, AWallHasItsWindowsLeftOut)
{
    const Mesh wall = tsr::scene::make_wall(5, 3, 0.2F, {{1, 1, 1, 1}, {3, 0, 1, 2}}, 0);
    EXPECT_NEAR(volume(wall), (15 - 1 - 2) * 0.2, 1e-4);
}

TEST(SceneMesh, MotionKeepsShapeAndAppendingKeepsBoth)
{
    Mesh mesh = tsr::scene::make_box({0, 0, 0}, {1, 2, 3}, 7);
    mesh.append(tsr::scene::shifted(tsr::scene::turned(tsr::scene::make_box({0, 0, 0}, {1, 1, 1}, 9), 30), 10, 0, 0));
    EXPECT_NEAR(volume(mesh), 7, 1e-3);
    EXPECT_EQ(mesh.surfaces.front(), 7);
    EXPECT_EQ(mesh.surfaces.back(), 9);
}

} // namespace
