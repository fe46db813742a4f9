/*
 * Things of gardens, yards and streets.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "props.h"

namespace tsr::scene
{

namespace
{

/* A wheel about the y axis, its middle at the origin. */
Mesh make_disc(float radius, float width, int sides, SurfaceId surface)
{
    return shifted(turned(make_cylinder(radius, radius, width, sides, surface), -90, Eigen::Vector3f::UnitX()), 0,
                   -width / 2, 0);
}

/* A rod along x. */
Mesh make_rod(float radius, float length, SurfaceId surface)
{
    return turned(make_cylinder(radius, radius, length, 8, surface), 90, Eigen::Vector3f::UnitY());
}

} // namespace

PropSurfaces add_prop_surfaces(World &world, std::uint32_t seed)
{
    PropSurfaces all;
    all.wood = world.add_surface({Pattern::planks, 0.4F, 0.12F, 0.12F, 0.45F, seed});
    all.bark = world.add_surface({Pattern::plain, 0.22F, 0, 0.1F, 0.6F, seed + 1});
    all.stone = world.add_surface({Pattern::plain, 0.5F, 0, 0.2F, 0.4F, seed + 2});
    all.clay = world.add_surface({Pattern::plain, 0.36F, 0, 0.15F, 0.35F, seed + 3});
    all.iron = world.add_surface({Pattern::plain, 0.16F, 0, 0.12F, 0.45F, seed + 4});
    all.paint = world.add_surface({Pattern::plain, 0.42F, 0, 0.2F, 0.3F, seed + 5});
    all.white = world.add_surface({Pattern::plain, 0.8F, 0, 0.15F, 0.15F, seed + 6});
    all.dark = world.add_surface({Pattern::plain, 0.09F, 0, 0.1F, 0.4F, seed + 7});
    all.print = world.add_surface({Pattern::patches, 0.75F, 0.15F, 0.12F, 0.2F, seed + 8});
    all.leaves = world.add_surface({Pattern::patches, 0.34F, 0.12F, 0.12F, 0.4F, seed + 9});
    return all;
}

Mesh make_frustum(const Eigen::Vector2f &foot, const Eigen::Vector2f &top, float height, SurfaceId surface)
{
    Mesh mesh = make_box({-0.5F, -0.5F, 0}, {0.5F, 0.5F, height}, surface);
    for (Eigen::Vector3f &vertex : mesh.vertices) {
        vertex.head<2>() = vertex.head<2>().cwiseProduct(vertex.z() > height / 2 ? top : foot);
    }
    return mesh;
}

Mesh make_bench(const PropSurfaces &surfaces)
{
    Mesh mesh;
    for (int i = 0; i < 4; ++i) {
        mesh.append(
            make_centred_box({0, -0.2F + 0.13F * static_cast<float>(i), 0.45F}, {1.6F, 0.1F, 0.04F}, surfaces.wood));
    }
    for (int i = 0; i < 3; ++i) {
        mesh.append(
            make_centred_box({0, 0.28F, 0.57F + 0.14F * static_cast<float>(i)}, {1.6F, 0.035F, 0.1F}, surfaces.wood));
    }
    for (const float x : {-0.65F, 0.65F}) {
        mesh.append(make_centred_box({x, -0.2F, 0.22F}, {0.06F, 0.06F, 0.44F}, surfaces.iron));
        mesh.append(make_centred_box({x, 0.24F, 0.46F}, {0.06F, 0.05F, 0.92F}, surfaces.iron));
        mesh.append(make_centred_box({x, 0, 0.62F}, {0.06F, 0.5F, 0.04F}, surfaces.iron));
    }
    return mesh;
}

Mesh make_wheelie_bin(const PropSurfaces &surfaces)
{
    Mesh mesh = shifted(make_frustum({0.42F, 0.45F}, {0.58F, 0.62F}, 0.92F, surfaces.paint), 0, 0, 0.06F);
    mesh.append(make_box({-0.3F, -0.36F, 0.98F}, {0.3F, 0.34F, 1.06F}, surfaces.dark));
    mesh.append(shifted(make_rod(0.03F, 0.5F, surfaces.dark), -0.25F, 0.36F, 0.95F));
    mesh.append(make_centred_box({0, -0.28F, 0.62F}, {0.22F, 0.04F, 0.2F}, surfaces.print));
    for (const float x : {-0.22F, 0.22F}) {
        mesh.append(shifted(turned(make_disc(0.11F, 0.06F, 12, surfaces.dark), 90), x, 0.24F, 0.11F));
    }
    return mesh;
}

Mesh make_litter_bin(const PropSurfaces &surfaces)
{
    Mesh mesh = make_cylinder(0.2F, 0.26F, 0.8F, 14, surfaces.iron);
    mesh.append(shifted(make_cylinder(0.28F, 0.28F, 0.05F, 14, surfaces.dark), 0, 0, 0.8F));
    mesh.append(make_centred_box({0, -0.24F, 0.5F}, {0.18F, 0.05F, 0.16F}, surfaces.print));
    return mesh;
}

Mesh make_flower_pot(float height_m, const PropSurfaces &surfaces)
{
    Mesh mesh = make_cylinder(0.32F * height_m, 0.45F * height_m, 0.85F * height_m, 14, surfaces.clay);
    mesh.append(shifted(make_cylinder(0.5F * height_m, 0.5F * height_m, 0.15F * height_m, 14, surfaces.clay), 0, 0,
                        0.85F * height_m));
    return mesh;
}

Mesh make_wood_pile(float length_m, float height_m, const PropSurfaces &surfaces, Chance &chance)
{
    Mesh mesh;
    const int rows = static_cast<int>(height_m / 0.16F), columns = static_cast<int>(length_m / 0.185F);
    for (int log = 0; log < rows * columns; ++log) {
        /* Across from its place, radius, half length. */
        const Eigen::Vector3f drawn = chance.within({-0.02F, 0.07F, 0.2F}, {0.02F, 0.095F, 0.25F});
        const int row = log / columns;
        const float x = (row % 2 == 0 ? 0.07F : 0.12F) + 0.185F * static_cast<float>(log % columns);
        const float z = 0.09F + 0.16F * static_cast<float>(row);
        mesh.append(shifted(make_disc(drawn.y(), 2 * drawn.z(), 8, surfaces.bark), x, drawn.x(), z));
        /* The cut is lighter than the bark. */
        mesh.append(shifted(make_disc(0.85F * drawn.y(), 2 * drawn.z() + 0.01F, 8, surfaces.clay), x, drawn.x(), z));
    }
    for (const float x : {0.0F, length_m}) {
        mesh.append(make_centred_box({x, 0, height_m / 2}, {0.06F, 0.3F, height_m + 0.2F}, surfaces.wood));
    }
    return mesh;
}

Mesh make_wheelbarrow(const PropSurfaces &surfaces)
{
    Mesh mesh = shifted(make_frustum({0.6F, 0.35F}, {0.95F, 0.65F}, 0.3F, surfaces.paint), 0, 0, 0.32F);
    mesh.append(shifted(make_ellipsoid({0.4F, 0.26F, 0.16F}, 12, surfaces.bark), 0, 0, 0.62F)); /* earth */
    mesh.append(shifted(make_disc(0.2F, 0.1F, 16, surfaces.dark), 0.55F, 0, 0.2F));
    for (const float y : {-0.25F, 0.25F}) {
        mesh.append(shifted(turned(make_rod(0.025F, 1.6F, surfaces.iron), -12, Eigen::Vector3f::UnitY()), -0.95F, y,
                            0.62F - 0.3F));
        mesh.append(make_centred_box({-0.35F, y, 0.17F}, {0.04F, 0.04F, 0.34F}, surfaces.iron));
    }
    return mesh;
}

Mesh make_crate(const Eigen::Vector3f &size, const PropSurfaces &surfaces)
{
    const float x = size.x() / 2, y = size.y() / 2, post = 0.05F;
    Mesh mesh = make_box({-x + 0.02F, -y + 0.02F, 0.02F}, {x - 0.02F, y - 0.02F, size.z() - 0.02F}, surfaces.wood);
    for (const float sx : {-x, x - post}) {
        for (const float sy : {-y, y - post}) {
            mesh.append(make_box({sx, sy, 0}, {sx + post, sy + post, size.z()}, surfaces.bark));
        }
    }
    for (const float z : {0.0F, size.z() - post}) {
        mesh.append(make_box({-x, -y, z}, {x, -y + 0.03F, z + post}, surfaces.bark));
        mesh.append(make_box({-x, y - 0.03F, z}, {x, y, z + post}, surfaces.bark));
        mesh.append(make_box({-x, -y, z}, {-x + 0.03F, y, z + post}, surfaces.bark));
        mesh.append(make_box({x - 0.03F, -y, z}, {x, y, z + post}, surfaces.bark));
    }
    return mesh;
}

Mesh make_cone(const PropSurfaces &surfaces)
{
    Mesh mesh = make_box({-0.19F, -0.19F, 0}, {0.19F, 0.19F, 0.04F}, surfaces.dark);
    const float radii[] = {0.14F, 0.112F, 0.084F, 0.056F, 0.025F};
    for (int i = 0; i < 4; ++i) {
        mesh.append(
            shifted(make_cylinder(radii[i], radii[i + 1], 0.135F, 14, i % 2 == 0 ? surfaces.clay : surfaces.white), 0,
                    0, 0.04F + 0.135F * static_cast<float>(i)));
    }
    return mesh;
}

Mesh make_barrel(const PropSurfaces &surfaces)
{
    Mesh mesh = make_cylinder(0.26F, 0.31F, 0.45F, 16, surfaces.wood);
    mesh.append(shifted(make_cylinder(0.31F, 0.26F, 0.45F, 16, surfaces.wood), 0, 0, 0.45F));
    for (const float z : {0.1F, 0.4F, 0.7F}) {
        mesh.append(shifted(make_cylinder(0.315F, 0.315F, 0.05F, 16, surfaces.iron), 0, 0, z));
    }
    return mesh;
}

Mesh make_fence(float length_m, float height_m, float step_m, SurfaceId wood)
{
    Mesh mesh;
    const int count = static_cast<int>(length_m / step_m);
    for (int i = 0; i <= count; ++i) {
        const float x = step_m * static_cast<float>(i), width = 0.62F * step_m;
        mesh.append(make_prism({{x, -0.2F},
                                {x + width, -0.2F},
                                {x + width, height_m - 0.06F},
                                {x + width / 2, height_m},
                                {x, height_m - 0.06F}},
                               0.025F, wood));
    }
    for (const float z : {0.25F * height_m, 0.75F * height_m}) {
        mesh.append(make_box({0, 0.025F, z}, {length_m, 0.07F, z + 0.08F}, wood));
    }
    for (int i = 0; 2.4F * static_cast<float>(i) <= length_m; ++i) {
        const float x = 2.4F * static_cast<float>(i);
        mesh.append(make_box({x, 0.03F, -0.3F}, {x + 0.09F, 0.12F, height_m - 0.05F}, wood));
    }
    return mesh;
}

Mesh make_lamp_post(float height_m, const PropSurfaces &surfaces)
{
    Mesh mesh = make_cylinder(0.11F, 0.1F, 0.9F, 10, surfaces.iron);
    mesh.append(make_cylinder(0.065F, 0.045F, height_m, 10, surfaces.iron));
    mesh.append(make_box({-0.03F, 0, height_m - 0.08F}, {0.03F, 1.2F, height_m}, surfaces.iron));
    mesh.append(make_box({-0.12F, 0.8F, height_m - 0.14F}, {0.12F, 1.4F, height_m - 0.04F}, surfaces.white));
    return mesh;
}

Mesh make_road_sign(const PropSurfaces &surfaces, bool round)
{
    Mesh mesh = make_cylinder(0.03F, 0.03F, 2.7F, 8, surfaces.iron);
    const float middle = 2.35F;
    if (round) {
        mesh.append(shifted(make_disc(0.32F, 0.02F, 18, surfaces.clay), 0, -0.04F, middle));
        mesh.append(shifted(make_disc(0.25F, 0.03F, 18, surfaces.print), 0, -0.045F, middle));
    } else {
        mesh.append(make_centred_box({0, -0.04F, middle}, {0.6F, 0.02F, 0.6F}, surfaces.paint));
        mesh.append(make_centred_box({0, -0.045F, middle}, {0.5F, 0.03F, 0.5F}, surfaces.print));
    }
    return mesh;
}

} // namespace tsr::scene
