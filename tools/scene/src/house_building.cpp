/*
 * Walls, roof, porch and lean-to of the house.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "house_building.h"

#include <cmath>
#include <numbers>

#include "facade.h"

namespace tsr::scene
{

namespace
{

constexpr float kEaves = 2.7F, kRidge = 5.7F; /* heights */
constexpr float kOverhang = 0.45F, kVerge = 0.35F;
constexpr float kFoundation = -0.4F; /* the walls go into the ground */
constexpr float kSetBack = 0.14F;

struct HouseSurfaces {
    SurfaceId brick = 0, plinth = 0, pane = 0, trim = 0, leaf = 0, tiles = 0, ridge = 0, boards = 0, gable = 0,
              shutter = 0;
};

HouseSurfaces add_house_surfaces(World &world)
{
    HouseSurfaces all;
    all.brick = world.add_surface({Pattern::brick, 0.36F, 0.6F, 0.25F, 0.3F, 101});
    all.plinth = world.add_surface({Pattern::plain, 0.42F, 0, 0.3F, 0.4F, 102});
    all.pane = world.add_surface({Pattern::plain, 0.1F, 0, 0.8F, 0.6F, 103});
    all.trim = world.add_surface({Pattern::plain, 0.74F, 0, 0.3F, 0.2F, 104});
    all.leaf = world.add_surface({Pattern::planks, 0.24F, 0.08F, 0.16F, 0.4F, 105, Grain::z});
    all.tiles = world.add_surface({Pattern::shingles, 0.3F, 0.08F, 0.32F, 0.35F, 106});
    all.ridge = world.add_surface({Pattern::tiles, 0.34F, 0.12F, 0.4F, 0.3F, 107});
    all.boards = world.add_surface({Pattern::planks, 0.42F, 0.14F, 0.16F, 0.4F, 108, Grain::z});
    all.gable = world.add_surface({Pattern::plain, 0.64F, 0, 0.5F, 0.08F, 109}); /* plaster */
    all.shutter = world.add_surface({Pattern::planks, 0.3F, 0.1F, 0.08F, 0.3F, 110, Grain::z});
    return all;
}

/* A front from the foundation to the eaves, moved to its side: 0 front, 1 right, 2 back, 3 left. */
Eigen::Affine3f side_of(int side)
{
    const float angle = static_cast<float>(side) * std::numbers::pi_v<float> / 2;
    const float half_length = side % 2 == 0 ? kHouseX : kHouseY, away = side % 2 == 0 ? kHouseY : kHouseX;
    return Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()) * Eigen::Translation3f(-half_length, -away, 0);
}

void add_shutters(Mesh &trims, const Opening &window, SurfaceId surface)
{
    for (const float x : {window.x - 0.55F, window.x + window.width + 0.07F}) {
        trims.append(make_box({x, -0.05F, window.z}, {x + 0.48F, 0, window.z + window.height}, surface));
    }
}

FrontParts make_walls(const HouseSurfaces &surfaces)
{
    const auto window = [&](float x, float z, float width, float height, int columns) {
        return Opening{x, z, width, height, columns, 2, true, surfaces.pane};
    };
    const Opening front_door{kHouseX + kHouseDoorX - 0.55F, 0.2F, 1.1F, 2.15F, 1, 1, false, surfaces.leaf};
    const Opening back_door{1.0F, 0.2F, 1.0F, 2.1F, 1, 1, false, surfaces.leaf};
    const std::vector<std::vector<Opening>> openings = {
        {window(0.9F, 0.85F, 1.2F, 1.35F, 2), front_door, window(5.6F, 0.75F, 2.1F, 1.5F, 3)},
        {window(5.3F, 1.2F, 0.8F, 0.9F, 1)},
        {back_door, window(3.2F, 0.6F, 1.8F, 1.7F, 2), window(6.6F, 1.0F, 1.2F, 1.2F, 2)},
        {window(1.0F, 0.85F, 1.2F, 1.35F, 2), window(4.4F, 0.85F, 1.2F, 1.35F, 2)}};
    FrontParts walls;
    for (int side = 0; side < 4; ++side) {
        const float length = side % 2 == 0 ? 2 * kHouseX : 2 * kHouseY;
        FrontParts parts;
        add_band(parts, {length, kFoundation, kEaves, kSetBack, surfaces.brick, surfaces.trim, true,
                         openings[static_cast<std::size_t>(side)]});
        for (const Opening &opening : openings[static_cast<std::size_t>(side)]) {
            if (opening.sill && opening.columns == 2 && opening.height < 1.5F) {
                add_shutters(parts.trims, opening, surfaces.shutter);
            }
            /* A lintel of stone. */
            parts.trims.append(make_box({opening.x - 0.12F, -0.02F, opening.z + opening.height},
                                        {opening.x + opening.width + 0.12F, 0.02F, opening.z + opening.height + 0.16F},
                                        surfaces.plinth));
        }
        walls.walls.append(moved(std::move(parts.walls), side_of(side)));
        walls.backs.append(moved(std::move(parts.backs), side_of(side)));
        walls.trims.append(moved(std::move(parts.trims), side_of(side)));
    }
    return walls;
}

/* Gables and attic close the walls upwards; a bottom closes them in the ground. */
void close_walls(FrontParts &walls, const HouseSurfaces &surfaces)
{
    const float x = kHouseX, y = kHouseY;
    for (const float s : {-1.0F, 1.0F}) {
        walls.walls.add_triangle({s * x, -s * y, kEaves}, {s * x, s * y, kEaves}, {s * x, 0, kRidge - 0.1F},
                                 surfaces.gable);
        walls.walls.add_quad({s * x, s * y, kEaves}, {-s * x, s * y, kEaves}, {-s * x, 0, kRidge - 0.1F},
                             {s * x, 0, kRidge - 0.1F}, surfaces.gable);
        /* Attic windows stand in the gable. */
        const auto slab = [&](float half_width, float low, float high, float out, SurfaceId surface) {
            return make_box({s > 0 ? x - 0.02F : -x - out, -half_width, low},
                            {s > 0 ? x + out : -x + 0.02F, half_width, high}, surface);
        };
        walls.trims.append(slab(0.52F, 3.3F, 4.42F, 0.03F, surfaces.trim));
        walls.backs.append(slab(0.42F, 3.4F, 4.32F, 0.034F, surfaces.pane));
        walls.trims.append(slab(0.03F, 3.35F, 4.37F, 0.05F, surfaces.trim));
    }
    walls.walls.add_quad({-x, -y, kFoundation}, {-x, y, kFoundation}, {x, y, kFoundation}, {x, -y, kFoundation},
                         surfaces.plinth);
}

/* Two slabs with battens at their ends, a ridge, a chimney. */
Mesh make_roof(const HouseSurfaces &surfaces)
{
    const float slope = (kRidge - kEaves) / kHouseY, eaves_y = kHouseY + kOverhang,
                eaves_z = kEaves - slope * kOverhang;
    const float length = 2 * (kHouseX + kVerge), thick = 0.16F;
    Mesh roof;
    for (const float s : {-1.0F, 1.0F}) {
        /* Outlines in (y, z) of the slope to +y, in the prism's x-z plane. */
        const std::vector<Eigen::Vector2f> outline = {
            {0, kRidge}, {eaves_y, eaves_z}, {eaves_y, eaves_z + thick}, {0, kRidge + thick}};
        Mesh slab = make_prism(outline, length, surfaces.tiles);
        slab = shifted(turned(std::move(slab), 90), length / 2, 0, 0);
        Mesh verge = turned(make_prism({{0, kRidge - 0.03F},
                                        {eaves_y, eaves_z - 0.03F},
                                        {eaves_y, eaves_z + thick + 0.02F},
                                        {0, kRidge + thick + 0.02F}},
                                       0.05F, surfaces.trim),
                            90);
        slab.append(shifted(verge, length / 2 + 0.05F, 0, 0));
        slab.append(shifted(verge, -length / 2, 0, 0));
        roof.append(s > 0 ? slab : turned(std::move(slab), 180));
    }
    const auto rod = [](float radius, float reach, SurfaceId surface) {
        return shifted(turned(make_cylinder(radius, radius, reach, 10, surface), 90, Eigen::Vector3f::UnitY()),
                       -reach / 2, 0, 0);
    };
    roof.append(shifted(rod(0.14F, length + 0.1F, surfaces.ridge), 0, 0, kRidge + thick - 0.02F));
    roof.append(make_box({1.6F, 0.5F, 4.4F}, {2.3F, 1.2F, 6.6F}, surfaces.brick));
    roof.append(make_box({1.53F, 0.43F, 6.6F}, {2.37F, 1.27F, 6.72F}, surfaces.plinth));
    roof.append(shifted(make_cylinder(0.15F, 0.12F, 0.4F, 12, surfaces.ridge), 1.95F, 0.85F, 6.72F));
    /* Two windows in the front slope. */
    const float tilt = std::atan(slope) * 180 / std::numbers::pi_v<float>;
    for (const float x : {-2.6F, 2.4F}) {
        Mesh frame = make_box({-0.45F, -0.6F, 0}, {0.45F, 0.6F, 0.08F}, surfaces.trim);
        frame.append(make_box({-0.36F, -0.51F, 0.02F}, {0.36F, 0.51F, 0.085F}, surfaces.pane));
        roof.append(
            shifted(turned(std::move(frame), tilt, Eigen::Vector3f::UnitX()), x, -1.9F, kRidge - slope * 1.9F + 0.17F));
    }
    return roof;
}

Mesh make_gutters(const PropSurfaces &props)
{
    const float y = kHouseY + kOverhang + 0.03F, z = kEaves - 0.36F, length = 2 * (kHouseX + kVerge);
    Mesh mesh;
    for (const float s : {-1.0F, 1.0F}) {
        Mesh gutter = turned(make_cylinder(0.07F, 0.07F, length, 10, props.iron), 90, Eigen::Vector3f::UnitY());
        mesh.append(shifted(std::move(gutter), -length / 2, s * y, z));
        for (const float x : {-kHouseX + 0.15F, kHouseX - 0.15F}) {
            mesh.append(shifted(make_cylinder(0.045F, 0.045F, 2.3F, 8, props.iron), x, s * (kHouseY + 0.08F), -0.1F));
            Mesh bend = make_cylinder(0.045F, 0.045F, 0.42F, 8, props.iron);
            bend = turned(std::move(bend), -s * 70, Eigen::Vector3f::UnitX());
            mesh.append(shifted(std::move(bend), x, s * (kHouseY + 0.08F), 2.18F));
        }
    }
    return mesh;
}

/* Two steps, two posts and a small roof before the door. */
Mesh make_porch(const HouseSurfaces &surfaces, const PropSurfaces &props)
{
    const float x = kHouseDoorX, y = -kHouseY;
    Mesh mesh = make_box({x - 0.9F, y - 0.9F, -0.3F}, {x + 0.9F, y, 0.2F}, props.stone);
    mesh.append(make_box({x - 0.9F, y - 1.25F, -0.3F}, {x + 0.9F, y - 0.9F, 0.1F}, props.stone));
    for (const float side : {-0.8F, 0.75F}) {
        mesh.append(make_box({x + side, y - 0.85F, 0.2F}, {x + side + 0.09F, y - 0.76F, 2.42F}, surfaces.trim));
    }
    Mesh roof = make_prism({{0, 2.65F}, {1.15F, 2.42F}, {1.15F, 2.5F}, {0, 2.75F}}, 2.1F, surfaces.tiles);
    mesh.append(shifted(turned(std::move(roof), -90), x - 1.05F, y, 0));
    mesh.append(
        make_centred_box({x + 0.42F, y + kSetBack - 0.05F, 1.2F}, {0.05F, 0.06F, 0.16F}, props.iron)); /* handle */
    mesh.append(make_centred_box({x, y + kSetBack - 0.01F, 1.85F}, {0.5F, 0.03F, 0.5F}, surfaces.pane));
    mesh.append(shifted(make_ellipsoid({0.09F, 0.09F, 0.14F}, 10, props.white), x + 0.95F, y - 0.1F, 2.0F)); /* lamp */
    mesh.append(
        make_centred_box({x - 0.85F, y - 0.02F, 1.7F}, {0.3F, 0.04F, 0.22F}, props.print)); /* number, letter box */
    return mesh;
}

/* Boards under a roof that leans on the right gable. */
void add_shed(World &world, const HouseSurfaces &surfaces, const PropSurfaces &props)
{
    const ObjectId shed = world.add_object("shed");
    const float low = -1.4F, high = 2.0F;
    world.add(shed, make_box({kHouseX, low, kFoundation}, {kShedX, high, 2.05F}, surfaces.boards));
    Mesh roof = make_prism({{kHouseX, 2.55F}, {kShedX + 0.25F, 1.95F}, {kShedX + 0.25F, 2.05F}, {kHouseX, 2.65F}},
                           high - low + 0.5F, surfaces.ridge);
    world.add(shed, shifted(std::move(roof), 0, low - 0.25F, 0));
    for (const float y : {low, high - 0.04F}) { /* its own small gables */
        world.add(shed, shifted(make_prism({{kHouseX, 2.0F}, {kShedX, 2.0F}, {kHouseX, 2.52F}}, 0.04F, surfaces.boards),
                                0, y, 0));
    }
    world.add(shed, make_box({kShedX - 0.02F, -0.6F, 0.05F}, {kShedX + 0.04F, 0.5F, 1.85F}, surfaces.leaf));
    world.add(shed, make_box({kShedX, -0.66F, 0.4F}, {kShedX + 0.06F, 0.56F, 0.5F}, props.iron));
    world.add(shed, make_box({kShedX, -0.66F, 1.4F}, {kShedX + 0.06F, 0.56F, 1.5F}, props.iron));
    world.add(shed, make_box({4.9F, low - 0.03F, 0.9F}, {5.7F, low + 0.02F, 1.6F}, surfaces.pane));
    world.add(shed, make_box({4.82F, low - 0.05F, 0.8F}, {5.78F, low, 0.9F}, surfaces.trim));
}

} // namespace

void add_house(World &world, const PropSurfaces &props)
{
    const HouseSurfaces surfaces = add_house_surfaces(world);
    FrontParts walls = make_walls(surfaces);
    close_walls(walls, surfaces);
    world.add(world.add_object("wall"), std::move(walls.walls));
    world.add(world.add_object("window"), std::move(walls.backs));
    world.add(world.add_object("frame"), std::move(walls.trims));
    world.add(world.add_object("roof"), make_roof(surfaces));
    world.add(world.add_object("gutter"), make_gutters(props));
    world.add(world.add_object("porch"), make_porch(surfaces, props));
    add_shed(world, surfaces, props);
    const ObjectId plinth = world.add_object("plinth");
    const float x = kHouseX + 0.03F, y = kHouseY + 0.03F;
    world.add(plinth, make_box({-x, -y, kFoundation}, {x, -y + 0.06F, 0.2F}, surfaces.plinth));
    world.add(plinth, make_box({-x, y - 0.06F, kFoundation}, {x, y, 0.2F}, surfaces.plinth));
    world.add(plinth, make_box({-x, -y, kFoundation}, {-x + 0.06F, y, 0.2F}, surfaces.plinth));
    world.add(plinth, make_box({x - 0.06F, -y, kFoundation}, {x, y, 0.2F}, surfaces.plinth));
}

} // namespace tsr::scene
