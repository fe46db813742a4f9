/*
 * Meshes of solids.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/mesh.h"

#include <cmath>
#include <numbers>

namespace tsr::scene
{

namespace
{

constexpr float kPi = std::numbers::pi_v<float>;

/* A closed surface of rings around the z axis, from the lowest up; a radius of 0 is a point. */
struct Ring {
    float radius_x, radius_y, z;
};

Mesh revolve(const std::vector<Ring> &rings, int sides, SurfaceId surface)
{
    const auto corner = [&](const Ring &ring, int i) {
        const float angle = 2 * kPi * static_cast<float>(i % sides) / static_cast<float>(sides);
        return Eigen::Vector3f(ring.radius_x * std::cos(angle), ring.radius_y * std::sin(angle), ring.z);
    };
    Mesh mesh;
    const auto close = [&](const Ring &ring, bool top) {
        const Eigen::Vector3f centre(0, 0, ring.z);
        for (int i = 0; i < sides && ring.radius_x > 0; ++i) {
            mesh.add_triangle(centre, corner(ring, top ? i : i + 1), corner(ring, top ? i + 1 : i), surface);
        }
    };
    close(rings.front(), false);
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
        for (int i = 0; i < sides; ++i) {
            const Eigen::Vector3f a = corner(rings[r], i), b = corner(rings[r], i + 1);
            const Eigen::Vector3f c = corner(rings[r + 1], i + 1), d = corner(rings[r + 1], i);
            if (rings[r].radius_x > 0) {
                mesh.add_triangle(a, b, c, surface);
            }
            if (rings[r + 1].radius_x > 0) {
                mesh.add_triangle(a, c, d, surface);
            }
        }
    }
    close(rings.back(), true);
    return mesh;
}

/* Rings of a half sphere that ends, or begins, at z. */
void add_half_sphere(std::vector<Ring> &rings, float radius, float z, bool upper, int steps)
{
    for (int i = 0; i < steps; ++i) {
        const float angle = kPi / 2 * static_cast<float>(upper ? i + 1 : i) / static_cast<float>(steps);
        const float away = upper ? radius * std::sin(angle) : -radius * std::cos(angle);
        float across = upper ? radius * std::cos(angle) : radius * std::sin(angle);
        if ((upper && i + 1 == steps) || (!upper && i == 0)) {
            across = 0;
        }
        rings.push_back({across, across, z + away});
    }
}

} // namespace

void Mesh::append(const Mesh &other)
{
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto &triangle : other.triangles) {
        triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
    }
    surfaces.insert(surfaces.end(), other.surfaces.begin(), other.surfaces.end());
}

void Mesh::add_triangle(const Eigen::Vector3f &a, const Eigen::Vector3f &b, const Eigen::Vector3f &c, SurfaceId surface)
{
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
    surfaces.push_back(surface);
}

void Mesh::add_quad(const Eigen::Vector3f &a, const Eigen::Vector3f &b, const Eigen::Vector3f &c,
                    const Eigen::Vector3f &d, SurfaceId surface)
{
    add_triangle(a, b, c, surface);
    add_triangle(a, c, d, surface);
}

Mesh make_box(const Eigen::Vector3f &low, const Eigen::Vector3f &high, SurfaceId surface)
{
    const auto corner = [&](int x, int y, int z) {
        return Eigen::Vector3f(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
    };
    Mesh mesh;
    mesh.add_quad(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0), surface);
    mesh.add_quad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1), surface);
    mesh.add_quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1), surface);
    mesh.add_quad(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), surface);
    mesh.add_quad(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0), surface);
    mesh.add_quad(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1), surface);
    return mesh;
}

Mesh make_centred_box(const Eigen::Vector3f &centre, const Eigen::Vector3f &size, SurfaceId surface)
{
    return make_box(centre - size / 2, centre + size / 2, surface);
}

Mesh make_cylinder(float radius, float top_radius, float height, int sides, SurfaceId surface)
{
    return revolve({{radius, radius, 0}, {top_radius, top_radius, height}}, sides, surface);
}

Mesh make_ellipsoid(const Eigen::Vector3f &radii, int sides, SurfaceId surface)
{
    std::vector<Ring> rings;
    const int steps = sides / 2;
    for (int i = 0; i <= steps; ++i) {
        const float angle = kPi * static_cast<float>(i) / static_cast<float>(steps);
        const float across = i == 0 || i == steps ? 0 : std::sin(angle);
        rings.push_back({radii.x() * across, radii.y() * across, -radii.z() * std::cos(angle)});
    }
    return revolve(rings, sides, surface);
}

Mesh make_limb(float radius, float end_radius, float length, int sides, SurfaceId surface)
{
    std::vector<Ring> rings;
    const int steps = sides / 4 + 1;
    add_half_sphere(rings, end_radius, -length, false, steps);
    rings.push_back({end_radius, end_radius, -length});
    rings.push_back({radius, radius, 0});
    add_half_sphere(rings, radius, 0, true, steps);
    return revolve(rings, sides, surface);
}

Mesh make_prism(const std::vector<Eigen::Vector2f> &outline, float depth, SurfaceId surface)
{
    const auto at = [&](std::size_t i, float y) {
        const Eigen::Vector2f &corner = outline[i % outline.size()];
        return Eigen::Vector3f(corner.x(), y, corner.y());
    };
    Mesh mesh;
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        mesh.add_triangle(at(0, 0), at(i, 0), at(i + 1, 0), surface);
        mesh.add_triangle(at(0, depth), at(i + 1, depth), at(i, depth), surface);
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
        mesh.add_quad(at(i, 0), at(i, depth), at(i + 1, depth), at(i + 1, 0), surface);
    }
    return mesh;
}

Mesh make_wall(float length, float height, float thickness, const std::vector<Eigen::Vector4f> &windows,
               SurfaceId surface)
{
    Mesh mesh;
    const auto block = [&](float x0, float z0, float x1, float z1) {
        if (x1 > x0 && z1 > z0) {
            mesh.append(make_box({x0, 0, z0}, {x1, thickness, z1}, surface));
        }
    };
    float x = 0;
    for (const Eigen::Vector4f &window : windows) {
        const float x1 = window[0] + window[2], z1 = window[1] + window[3];
        block(x, 0, window[0], height);
        block(window[0], 0, x1, window[1]);
        block(window[0], z1, x1, height);
        x = x1;
    }
    block(x, 0, length, height);
    return mesh;
}

Mesh moved(Mesh mesh, const Eigen::Affine3f &motion)
{
    for (Eigen::Vector3f &vertex : mesh.vertices) {
        vertex = motion * vertex;
    }
    return mesh;
}

Mesh shifted(Mesh mesh, float x, float y, float z)
{
    return moved(std::move(mesh), Eigen::Affine3f(Eigen::Translation3f(x, y, z)));
}

Mesh turned(Mesh mesh, float degrees, const Eigen::Vector3f &axis)
{
    return moved(std::move(mesh), Eigen::Affine3f(Eigen::AngleAxisf(degrees * kPi / 180, axis)));
}

} // namespace tsr::scene
