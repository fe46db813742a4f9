/*
 * Fronts with openings, houses of a street.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "facade.h"

namespace tsr::scene
{

namespace
{

constexpr float kHouseDepthM = 8;
constexpr float kGroundFloorM = 3.5F, kUpperFloorM = 2.9F;

void add_opening(FrontParts &parts, const Band &band, const Opening &opening)
{
    const float a = opening.x, b = opening.x + opening.width, z0 = opening.z, z1 = opening.z + opening.height;
    const float d = band.depth;
    parts.walls.add_quad({a, 0, z0}, {a, d, z0}, {a, d, z1}, {a, 0, z1}, band.wall);
    parts.walls.add_quad({b, d, z0}, {b, 0, z0}, {b, 0, z1}, {b, d, z1}, band.wall);
    parts.walls.add_quad({a, 0, z0}, {b, 0, z0}, {b, d, z0}, {a, d, z0}, band.wall);
    parts.walls.add_quad({a, 0, z1}, {a, d, z1}, {b, d, z1}, {b, 0, z1}, band.wall);
    parts.backs.add_quad({a, d, z0}, {b, d, z0}, {b, d, z1}, {a, d, z1}, opening.back);
    const auto bar = [&](float x0, float zz0, float x1, float zz1) {
        parts.trims.append(make_box({x0, d - 0.06F, zz0}, {x1, d + 0.02F, zz1}, band.trim));
    };
    if (band.frames) {
        bar(a, z0, a + 0.06F, z1);
        bar(b - 0.06F, z0, b, z1);
        bar(a + 0.06F, z1 - 0.06F, b - 0.06F, z1);
    }
    if (band.frames && opening.sill) {
        bar(a + 0.06F, z0, b - 0.06F, z0 + 0.06F);
    }
    if (opening.sill) {
        parts.trims.append(make_box({a - 0.08F, -0.07F, z0 - 0.07F}, {b + 0.08F, d, z0}, band.trim));
    }
    for (int i = 1; i < opening.columns; ++i) {
        const float x = a + opening.width * static_cast<float>(i) / static_cast<float>(opening.columns);
        bar(x - 0.03F, z0, x + 0.03F, z1 - 0.06F);
    }
    for (int i = 1; i < opening.rows; ++i) {
        const float z = z0 + opening.height * static_cast<float>(i) / static_cast<float>(opening.rows);
        bar(a + 0.06F, z - 0.02F, b - 0.06F, z + 0.02F);
    }
}

/* Closes a front to a block: sides, back, lid; the bottom is in the ground. */
void add_block(Mesh &walls, float width, float depth, float height, SurfaceId wall)
{
    walls.add_quad({0, depth, 0}, {0, 0, 0}, {0, 0, height}, {0, depth, height}, wall);
    walls.add_quad({width, 0, 0}, {width, depth, 0}, {width, depth, height}, {width, 0, height}, wall);
    walls.add_quad({width, depth, 0}, {0, depth, 0}, {0, depth, height}, {width, depth, height}, wall);
    walls.add_quad({0, 0, height}, {width, 0, height}, {width, depth, height}, {0, depth, height}, wall);
    walls.add_quad({0, 0, 0}, {0, depth, 0}, {width, depth, 0}, {width, 0, 0}, wall);
}

SurfaceId one_of(const std::vector<SurfaceId> &surfaces, Chance &chance)
{
    return surfaces[static_cast<std::size_t>(chance.whole(0, static_cast<int>(surfaces.size()) - 1))];
}

/* What one house is like. */
struct Style {
    float width = 10;
    int floors = 2, bays = 4; /* floors above the lowest */
    bool shop = false, balconies = false, gable = false;
    SurfaceId wall = 0, ground = 0;
    float height() const { return kGroundFloorM + kUpperFloorM * static_cast<float>(floors); }
};

struct HouseMeshes {
    FrontParts front;
    Mesh roof, balconies, awning, sign;
};

/* Returns x of the middle of the door. */
float add_shop(HouseMeshes &house, const Style &style, const StreetSurfaces &surfaces, Chance &chance)
{
    const float door = 1.1F, margin = 1.0F, w = style.width;
    const bool door_left = chance.whole(0, 1) == 0;
    Band band{w, 0, kGroundFloorM, 0.25F, style.ground, surfaces.trim, !surfaces.coarse, {}};
    const Opening leaf{door_left ? margin : w - margin - door, 0, door, 2.3F, 1, 2, false, surfaces.door};
    const float first = door_left ? margin + door + 0.3F : margin,
                last = door_left ? w - margin : w - margin - door - 0.3F;
    const Opening pane{first, 0.5F, last - first, 2.0F, 3, 1, true, surfaces.shop_pane};
    band.openings = door_left ? std::vector<Opening>{leaf, pane} : std::vector<Opening>{pane, leaf};
    add_band(house.front, band);
    /* Goods in the window: what is printed on the pane's inside would be flat. */
    const int goods = static_cast<int>((last - first - 0.6F) / 0.75F);
    for (int i = 0; i < goods; ++i) {
        const Eigen::Vector3f low(first + 0.3F + 0.75F * static_cast<float>(i), 0.12F, 0.5F);
        const Eigen::Vector3f size = chance.within({0.2F, 0.12F, 0.3F}, {0.6F, 0.12F, 1.3F});
        house.front.trims.append(make_box(low, low + size, one_of(surfaces.signs, chance)));
    }
    house.sign = make_box({margin, -0.08F, 2.75F}, {w - margin, 0, 3.3F}, one_of(surfaces.signs, chance));
    if (chance.whole(0, 2) > 0) { /* an awning, in front of the sign's lower edge */
        const float reach = chance.between(0.8F, 1.2F);
        Mesh cloth = make_prism({{0, 0}, {reach, -0.5F}, {reach, -0.44F}, {0, 0.06F}}, last - first,
                                one_of(surfaces.awnings, chance));
        house.awning = shifted(turned(std::move(cloth), -90), first, 0, 2.72F);
    }
    return leaf.x + door / 2;
}

float add_ground_floor(HouseMeshes &house, const Style &style, const StreetSurfaces &surfaces, Chance &chance)
{
    const float bay = style.width / static_cast<float>(style.bays);
    const int door_bay = chance.whole(1, style.bays - 2);
    Band band{style.width, 0, kGroundFloorM, 0.18F, style.ground, surfaces.trim, !surfaces.coarse, {}};
    for (int i = 0; i < style.bays; ++i) {
        const float middle = bay * (static_cast<float>(i) + 0.5F);
        if (i == door_bay) {
            band.openings.push_back({middle - 0.6F, 0, 1.2F, 2.5F, 2, 1, false, surfaces.door});
        } else {
            band.openings.push_back({middle - 0.5F, 1.1F, 1.0F, 1.5F, 2, 2, true, surfaces.pane});
        }
    }
    add_band(house.front, band);
    const float door = bay * (static_cast<float>(door_bay) + 0.5F);
    house.front.trims.append(make_box({door - 0.9F, -0.3F, 2.65F}, {door + 0.9F, 0, 2.75F}, surfaces.trim));
    return door;
}

void add_balcony(Mesh &mesh, float middle, float z, const StreetSurfaces &surfaces)
{
    const float half = 1.0F, reach = 0.9F;
    mesh.append(make_box({middle - half, -reach, z - 0.12F}, {middle + half, 0, z}, surfaces.trim));
    mesh.append(make_box({middle - half, -reach, z + 0.9F}, {middle + half, -reach + 0.05F, z + 0.95F}, surfaces.iron));
    for (int i = 0; i <= 10; ++i) {
        const float x = middle - half + 0.02F + 0.196F * static_cast<float>(i);
        mesh.append(make_centred_box({x, -reach + 0.025F, z + 0.45F}, {0.03F, 0.03F, 0.9F}, surfaces.iron));
    }
    for (const float x : {middle - half, middle + half - 0.04F}) {
        mesh.append(make_box({x, -reach, z + 0.9F}, {x + 0.04F, 0, z + 0.95F}, surfaces.iron));
        mesh.append(make_box({x, -reach / 2, z}, {x + 0.03F, -reach / 2 + 0.03F, z + 0.9F}, surfaces.iron));
    }
}

void add_upper_floors(HouseMeshes &house, const Style &style, const StreetSurfaces &surfaces)
{
    const float bay = style.width / static_cast<float>(style.bays);
    for (int floor = 0; floor < style.floors; ++floor) {
        const float low = kGroundFloorM + kUpperFloorM * static_cast<float>(floor);
        Band band{style.width, low, low + kUpperFloorM, 0.18F, style.wall, surfaces.trim, !surfaces.coarse, {}};
        for (int i = 0; i < style.bays; ++i) {
            const float middle = bay * (static_cast<float>(i) + 0.5F);
            const bool balcony = style.balconies && i > 0 && i + 1 < style.bays;
            if (balcony) {
                band.openings.push_back({middle - 0.6F, low + 0.1F, 1.2F, 2.2F, 2, 1, false, surfaces.pane});
                add_balcony(house.balconies, middle, low + 0.1F, surfaces);
            } else {
                band.openings.push_back({middle - 0.5F, low + 0.7F, 1.0F, 1.6F, 2, 2, true, surfaces.pane});
            }
        }
        add_band(house.front, band);
    }
    house.front.trims.append(
        make_box({0, -0.1F, kGroundFloorM - 0.1F}, {style.width, 0, kGroundFloorM + 0.08F}, surfaces.trim));
}

void add_roof(HouseMeshes &house, const Style &style, const StreetSurfaces &surfaces, Chance &chance)
{
    const float w = style.width, h = style.height();
    house.front.trims.append(make_box({0, -0.25F, h - 0.15F}, {w, 0.1F, h + 0.1F}, surfaces.trim));
    const float rise = style.gable ? 2.6F : 1.2F;
    Mesh roof = make_prism({{0, 0}, {kHouseDepthM + 0.3F, 0}, {kHouseDepthM / 2, rise}}, w, surfaces.roof);
    house.roof.append(
        shifted(moved(std::move(roof), Eigen::Affine3f(Eigen::AngleAxisf(1.5707964F, Eigen::Vector3f::UnitZ()))), w,
                -0.2F, h + 0.1F));
    const float x = chance.between(1, w - 2);
    house.roof.append(make_box({x, 3.2F, h + 0.2F}, {x + 0.7F, 4.2F, h + rise + 1.1F}, style.ground));
}

} // namespace

void add_band(FrontParts &parts, const Band &band)
{
    const auto face = [&](float x0, float z0, float x1, float z1) {
        if (x1 > x0 && z1 > z0) {
            parts.walls.add_quad({x0, 0, z0}, {x1, 0, z0}, {x1, 0, z1}, {x0, 0, z1}, band.wall);
        }
    };
    float x = 0;
    for (const Opening &opening : band.openings) {
        const float end = opening.x + opening.width;
        face(x, band.low, opening.x, band.high);
        face(opening.x, band.low, end, opening.z);
        face(opening.x, opening.z + opening.height, end, band.high);
        add_opening(parts, band, opening);
        x = end;
    }
    face(x, band.low, band.length, band.high);
}

StreetLabels add_street_labels(World &world)
{
    return {world.add_object("wall"), world.add_object("window"),  world.add_object("frame"),
            world.add_object("roof"), world.add_object("balcony"), world.add_object("awning"),
            world.add_object("sign")};
}

StreetSurfaces add_street_surfaces(World &world, std::uint32_t seed)
{
    StreetSurfaces all;
    all.walls = {world.add_surface({Pattern::brick, 0.34F, 0.55F, 0.26F, 0.3F, seed}),
                 world.add_surface({Pattern::plain, 0.62F, 0, 0.45F, 0.2F, seed + 1}),
                 world.add_surface({Pattern::brick, 0.5F, 0.38F, 0.26F, 0.3F, seed + 2}),
                 world.add_surface({Pattern::plain, 0.7F, 0, 0.5F, 0.05F, seed + 3}), /* plain plaster: hard to match */
                 world.add_surface({Pattern::planks, 0.48F, 0.2F, 0.2F, 0.35F, seed + 4}),
                 world.add_surface({Pattern::plain, 0.4F, 0, 0.4F, 0.3F, seed + 5})};
    all.grounds = {world.add_surface({Pattern::plain, 0.45F, 0, 0.4F, 0.28F, seed + 6}),
                   world.add_surface({Pattern::tiles, 0.38F, 0.22F, 0.6F, 0.3F, seed + 7}),
                   world.add_surface({Pattern::brick, 0.28F, 0.45F, 0.4F, 0.3F, seed + 8})};
    all.awnings = {world.add_surface({Pattern::stripes, 0.75F, 0.2F, 0.35F, 0.15F, seed + 9, Grain::y}),
                   world.add_surface({Pattern::plain, 0.3F, 0, 0.3F, 0.4F, seed + 10})};
    all.signs = {world.add_surface({Pattern::patches, 0.8F, 0.12F, 0.16F, 0.2F, seed + 11}),
                 world.add_surface({Pattern::patches, 0.2F, 0.65F, 0.22F, 0.2F, seed + 12}),
                 world.add_surface({Pattern::plain, 0.5F, 0, 0.2F, 0.5F, seed + 13})};
    all.pane = world.add_surface({Pattern::plain, 0.11F, 0, 0.7F, 0.6F, seed + 14});
    all.shop_pane = world.add_surface({Pattern::patches, 0.2F, 0.08F, 0.5F, 0.5F, seed + 15});
    all.door = world.add_surface({Pattern::planks, 0.22F, 0.08F, 0.18F, 0.35F, seed + 16, Grain::z});
    all.trim = world.add_surface({Pattern::plain, 0.66F, 0, 0.25F, 0.3F, seed + 17});
    all.roof = world.add_surface({Pattern::shingles, 0.26F, 0.1F, 0.35F, 0.3F, seed + 18});
    all.iron = world.add_surface({Pattern::plain, 0.1F, 0, 0.1F, 0.4F, seed + 19});
    return all;
}

float add_house_front(World &world, const StreetLabels &labels, const StreetSurfaces &surfaces,
                      const Eigen::Affine3f &place, float width, Chance &chance)
{
    Style style;
    style.width = width;
    style.floors = chance.whole(1, 3);
    style.bays = width < 8 ? 3 : chance.whole(3, 4);
    style.shop = chance.whole(0, 2) == 0;
    style.balconies = chance.whole(0, 2) == 0;
    style.gable = chance.whole(0, 1) == 0;
    style.wall = one_of(surfaces.walls, chance);
    style.ground = chance.whole(0, 1) == 0 ? style.wall : one_of(surfaces.grounds, chance);
    HouseMeshes house;
    const float door =
        style.shop ? add_shop(house, style, surfaces, chance) : add_ground_floor(house, style, surfaces, chance);
    add_upper_floors(house, style, surfaces);
    add_roof(house, style, surfaces, chance);
    add_block(house.front.walls, width, kHouseDepthM, style.height(), style.wall);
    world.add(labels.wall, moved(std::move(house.front.walls), place));
    world.add(labels.window, moved(std::move(house.front.backs), place));
    world.add(labels.trim, moved(std::move(house.front.trims), place));
    world.add(labels.roof, moved(std::move(house.roof), place));
    const auto add_if_any = [&](ObjectId label, Mesh mesh) {
        if (!mesh.triangles.empty()) {
            world.add(label, moved(std::move(mesh), place));
        }
    };
    add_if_any(labels.balcony, std::move(house.balconies));
    add_if_any(labels.awning, std::move(house.awning));
    add_if_any(labels.sign, std::move(house.sign));
    return door;
}

} // namespace tsr::scene
