/*
 * Sections along a car, and skin between them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "car_body.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tsr::scene
{

namespace
{

constexpr float kArchM = 0.39F;  /* radius of the wheel arches */
constexpr float kFloorM = 0.24F; /* of the body above the ground */
constexpr float kBootRear = -2.06F, kBootFront = -1.47F;
constexpr float kGapM = 0.02F; /* between doors */

/* Values at stations along x, straight between them. */
using Profile = std::vector<Eigen::Vector2f>;

float value_at(const Profile &profile, float x)
{
    if (x <= profile.front().x()) {
        return profile.front().y();
    }
    for (std::size_t i = 1; i < profile.size(); ++i) {
        if (x <= profile[i].x()) {
            const float share = (x - profile[i - 1].x()) / (profile[i].x() - profile[i - 1].x());
            return profile[i - 1].y() + share * (profile[i].y() - profile[i - 1].y());
        }
    }
    return profile.back().y();
}

const Profile kHalfWidth = {{-2.15F, 0.74F}, {-2.05F, 0.80F}, {-1.6F, 0.86F}, {-0.6F, 0.89F},
                            {0.9F, 0.89F},   {1.6F, 0.86F},   {2.0F, 0.78F},  {2.15F, 0.64F}};
const Profile kShoulder = {{-2.15F, 0.84F}, {-2.1F, 0.92F}, {-1.45F, 0.94F}, {0.0F, 0.92F},
                           {0.95F, 0.89F},  {1.6F, 0.82F},  {2.0F, 0.73F},   {2.15F, 0.60F}};
const Profile kCrown = {{-2.1F, 0.0F}, {-1.47F, 0.0F}, {-1.3F, 0.02F}, {0.95F, 0.04F}, {1.9F, 0.05F}, {2.15F, 0.03F}};
const Profile kSill = {{-2.15F, 0.34F}, {-2.0F, 0.28F}, {-1.6F, kFloorM}, {1.6F, kFloorM}, {2.15F, 0.3F}};
/* The roof line, from the foot of the rear pane to the foot of the windscreen. */
const Profile kRoof = {{-1.46F, 0.955F}, {-1.2F, 1.13F}, {-0.95F, 1.29F}, {-0.7F, 1.40F}, {-0.3F, 1.445F},
                       {0.05F, 1.44F},   {0.3F, 1.39F},  {0.65F, 1.16F},  {1.0F, 0.915F}};

/* Height of the body's lower edge, where wheel arches cut it. */
float lower_edge(float x)
{
    float z = value_at(kSill, x);
    for (const float axle : {-kCarAxleM, kCarAxleM}) {
        const float away = std::fabs(x - axle);
        if (away < kArchM) {
            z = kCarWheelM + std::sqrt(kArchM * kArchM - away * away);
        }
    }
    return z;
}

/* From the right half of a section, from the bottom's middle to the top's, the whole, counter-clockwise seen from
 * ahead. */
using Section = std::vector<Eigen::Vector3f>;

Section mirrored(const Section &half)
{
    Section whole = half; /* y >= 0: up on the left */
    for (std::size_t i = half.size() - 2; i > 0; --i) {
        whole.emplace_back(half[i].x(), -half[i].y(), half[i].z());
    }
    return whole;
}

/* Surface of the skin from section i to i + 1, and from half point j to j + 1. */
using Skin = std::function<SurfaceId(std::size_t i, std::size_t j)>;

Mesh make_loft(const std::vector<Section> &halves, const Skin &skin, SurfaceId ends)
{
    Mesh mesh;
    const std::size_t half = halves.front().size(), count = 2 * half - 2;
    std::vector<Section> sections;
    std::transform(halves.begin(), halves.end(), std::back_inserter(sections), mirrored);
    for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
        for (std::size_t j = 0; j < count; ++j) {
            const std::size_t next = (j + 1) % count;
            mesh.add_quad(sections[i][j], sections[i][next], sections[i + 1][next], sections[i + 1][j],
                          skin(i, j + 1 < half ? j : count - 1 - j));
        }
    }
    const auto close = [&](const Section &section, bool front) {
        Eigen::Vector3f middle = (section[0] + section[half - 1]) / 2;
        for (std::size_t j = 0; j < count; ++j) {
            const std::size_t next = (j + 1) % count;
            mesh.add_triangle(middle, section[front ? j : next], section[front ? next : j], ends);
        }
    };
    close(sections.front(), false);
    close(sections.back(), true);
    return mesh;
}

enum BodyPoint {
    kKeel,
    kInnerLow,
    kInnerHigh,
    kEdge,
    kWaist,
    kBelow,
    kShoulderLine,
    kRim,
    kDeep,
    kTop
};

Section body_section(float x)
{
    const float width = value_at(kHalfWidth, x), shoulder = value_at(kShoulder, x), edge = lower_edge(x);
    const float sill = value_at(kSill, x), top = shoulder + value_at(kCrown, x);
    const bool boot = x > kBootRear && x < kBootFront;
    const float waist = std::max(edge + 0.02F, 0.55F);
    const float deep = boot ? kCarBootFloor.z() : top - 0.01F;
    return {{x, 0, sill},
            {x, 0.60F, sill},
            {x, 0.60F, edge},
            {x, width - (edge > 0.4F ? 0.01F : 0.05F), edge},
            {x, width, std::min(waist, shoulder - 0.1F)},
            {x, width - 0.02F, std::max(shoulder - 0.08F, waist + 0.01F)},
            {x, width - 0.08F, shoulder},
            {x, std::min(width - 0.1F, 0.65F), shoulder},
            {x, boot ? 0.545F : 0.5F, deep},
            {x, 0, boot ? deep : top}};
}

/* Where sections of the body are: gaps between doors, arches and the boot need their own. */
std::vector<float> body_stations(bool coarse)
{
    std::vector<float> all = {-2.15F, -2.1F, 0.95F, 2.0F, 2.15F};
    const float step = coarse ? 0.4F : 0.15F;
    for (int i = 0; - 2.0F + step * static_cast<float>(i) < 2.1F; ++i) {
        all.push_back(-2.0F + step * static_cast<float>(i));
    }
    for (const float gap : {-0.98F, -0.12F, 0.82F}) {
        all.insert(all.end(), {gap, gap + kGapM});
    }
    const int arch_steps = coarse ? 4 : 12;
    for (const float axle : {-kCarAxleM, kCarAxleM}) {
        std::erase_if(all, [axle](float x) { return std::fabs(x - axle) < kArchM + 0.03F; });
        for (int i = 0; i <= arch_steps; ++i) {
            const float angle = 3.1415927F * static_cast<float>(i) / static_cast<float>(arch_steps);
            all.push_back(axle - 0.9999F * kArchM * std::cos(angle));
        }
        all.insert(all.end(), {axle - kArchM - 0.002F, axle + kArchM + 0.002F});
    }
    all.insert(all.end(), {kBootRear - 0.002F, kBootRear + 0.002F, kBootFront - 0.002F, kBootFront + 0.002F});
    std::sort(all.begin(), all.end());
    return all;
}

Mesh make_lower_body(const CarSurfaces &surfaces, bool coarse)
{
    const std::vector<float> stations = body_stations(coarse);
    std::vector<Section> sections;
    std::transform(stations.begin(), stations.end(), std::back_inserter(sections), body_section);
    const Skin skin = [&](std::size_t i, std::size_t j) {
        const float x = (stations[i] + stations[i + 1]) / 2;
        const bool gap = stations[i + 1] - stations[i] < kGapM + 0.003F && std::fabs(x) < 1.1F &&
                         std::fabs(x) > 0.05F && std::fabs(std::fabs(x) - kCarAxleM) > kArchM + 0.05F;
        if (j < kEdge || (j >= kRim && x > kBootRear && x < kBootFront)) {
            return surfaces.dark;
        }
        if (j < kShoulderLine && gap) {
            return surfaces.dark;
        }
        return j < kWaist ? surfaces.dirt : surfaces.paint;
    };
    return make_loft(sections, skin, surfaces.paint);
}

/* Its panes and its roof with pillars, one closed skin of two labels. */
void add_cabin(CarMeshes &car, const CarSurfaces &surfaces)
{
    const std::vector<float> stations = {-1.46F, -1.40F, -1.2F, -1.05F, -0.95F, -0.7F, -0.62F, -0.3F, -0.14F,
                                         -0.05F, 0.05F,  0.3F,  0.4F,   0.65F,  0.78F, 0.93F,  1.0F};
    std::vector<Section> sections;
    for (const float x : stations) {
        const float top = value_at(kRoof, x), base = 0.88F, rise = std::max(top - 0.93F, 0.0F);
        const float foot = value_at(kHalfWidth, x) - 0.11F, lean = 0.33F;
        const auto width = [&](float z) { return foot - lean * std::max(z - 0.93F, 0.0F); };
        const float low = 0.93F + 0.08F * rise, high = 0.93F + 0.84F * rise, edge = 0.93F + 0.95F * rise;
        sections.push_back({{x, 0, base},
                            {x, foot, base},
                            {x, width(low), low},
                            {x, width(high), high},
                            {x, width(edge) - 0.01F, edge},
                            {x, width(edge) - 0.06F, top},
                            {x, 0, top + 0.02F}});
    }
    const Mesh whole = make_loft(
        sections,
        [&](std::size_t i, std::size_t j) {
            const float x = (stations[i] + stations[i + 1]) / 2;
            const bool side_pane = j == 2 && x > -1.05F && x < 0.78F && (x < -0.14F || x > -0.05F);
            const bool end_pane = j == 5 && ((x > 0.3F && x < 0.93F) || (x < -0.7F && x > -1.40F));
            return side_pane || end_pane ? surfaces.glass : surfaces.paint;
        },
        surfaces.paint);
    for (std::size_t i = 0; i < whole.triangles.size(); ++i) {
        const auto &corners = whole.triangles[i];
        Mesh &part = whole.surfaces[i] == surfaces.glass ? car.panes : car.body;
        part.add_triangle(whole.vertices[corners[0]], whole.vertices[corners[1]], whole.vertices[corners[2]],
                          whole.surfaces[i]);
    }
}

void add_fittings(Mesh &body, const CarSurfaces &surfaces, bool coarse)
{
    const int sides = coarse ? 6 : 12;                                                /* of what is round */
    body.append(make_box({2.05F, -0.7F, 0.30F}, {2.2F, 0.7F, 0.42F}, surfaces.dark)); /* bumpers */
    body.append(make_box({-2.22F, -0.74F, 0.36F}, {-2.05F, 0.74F, 0.50F}, surfaces.dark));
    body.append(make_box({2.1F, -0.38F, 0.46F}, {2.165F, 0.38F, 0.56F}, surfaces.dark)); /* grille */
    body.append(make_box({2.18F, -0.26F, 0.31F}, {2.215F, 0.26F, 0.41F}, surfaces.plate));
    for (const float side : {-1.0F, 1.0F}) {
        const auto put = [&](const Eigen::Vector3f &centre, const Eigen::Vector3f &size, SurfaceId surface) {
            body.append(make_centred_box({centre.x(), side * centre.y(), centre.z()}, size, surface));
        };
        put({-0.02F, 0.885F, 0.80F}, {0.16F, 0.04F, 0.03F}, surfaces.dark); /* handles */
        put({-0.90F, 0.885F, 0.81F}, {0.14F, 0.04F, 0.03F}, surfaces.dark);
        put({-2.125F, 0.62F, 0.74F}, {0.08F, 0.22F, 0.16F}, surfaces.tail_lamp);
        put({0.0F, 0.885F, 0.50F}, {1.75F, 0.03F, 0.05F}, surfaces.dark); /* a strip along the doors */
        body.append(shifted(make_ellipsoid({0.13F, 0.15F, 0.075F}, sides, surfaces.lamp), 2.01F, side * 0.55F, 0.625F));
        body.append(shifted(make_ellipsoid({0.07F, 0.12F, 0.08F}, sides, surfaces.paint), 0.66F, side * 0.96F, 0.98F));
        put({0.66F, 0.85F, 0.95F}, {0.05F, 0.16F, 0.04F}, surfaces.dark);
        Mesh wiper = make_centred_box({0, 0, 0}, {0.03F, 0.5F, 0.015F}, surfaces.dark);
        body.append(shifted(turned(std::move(wiper), 12), 0.90F, side * 0.34F - 0.1F, 1.02F));
    }
    body.append(shifted(turned(make_cylinder(0.03F, 0.03F, 0.15F, 8, surfaces.rim), -90, Eigen::Vector3f::UnitY()),
                        -2.1F, -0.45F, 0.30F));
}

Mesh make_boot_lid(const CarSurfaces &surfaces)
{
    const float half = 0.64F;
    Mesh mesh =
        shifted(make_prism({{-0.69F, -0.025F}, {-0.66F, -0.03F}, {0, 0}, {0, 0.02F}, {-0.62F, 0.012F}, {-0.68F, 0.02F}},
                           2 * half, surfaces.paint),
                0, -half, 0);
    /* Its rear hangs before the body's: with the plate. */
    mesh.append(make_box({-0.712F, -0.48F, -0.29F}, {-0.67F, 0.48F, 0.0F}, surfaces.paint));
    mesh.append(make_box({-0.725F, -0.26F, -0.23F}, {-0.705F, 0.26F, -0.12F}, surfaces.plate));
    mesh.append(make_box({-0.73F, -0.4F, -0.09F}, {-0.71F, 0.4F, -0.06F}, surfaces.dark));
    return mesh;
}

Mesh make_axle(const CarSurfaces &surfaces, bool coarse)
{
    Mesh mesh;
    const int sides = coarse ? 10 : 22;
    const auto disc = [&](float radius, float outer_radius, float y, float width, float side, SurfaceId surface) {
        Mesh wheel =
            turned(make_cylinder(radius, outer_radius, width, sides, surface), -90 * side, Eigen::Vector3f::UnitX());
        mesh.append(shifted(std::move(wheel), 0, side * y, 0));
    };
    for (const float side : {-1.0F, 1.0F}) {
        disc(kCarWheelM, kCarWheelM, 0.66F, 0.15F, side, surfaces.rubber);
        if (!coarse) {
            disc(0.06F, 0.05F, 0.845F, 0.03F, side, surfaces.rim);
        }
        disc(kCarWheelM, kCarWheelM - 0.05F, 0.81F, 0.035F, side, surfaces.rubber);
        disc(0.21F, 0.20F, 0.845F, 0.006F, side, surfaces.dark);
        for (int i = 0; i < 5; ++i) {
            Mesh spoke = make_box({-0.035F, -0.012F, 0.02F}, {0.035F, 0.012F, 0.2F}, surfaces.rim);
            mesh.append(shifted(turned(std::move(spoke), 72 * static_cast<float>(i), Eigen::Vector3f::UnitY()), 0,
                                side * 0.855F, 0));
        }
    }
    return mesh;
}

} // namespace

CarSurfaces add_car_surfaces(World &world, std::uint32_t seed)
{
    const float shades[] = {0.5F, 0.2F, 0.58F, 0.34F, 0.14F, 0.64F, 0.27F, 0.42F};
    const float paint = shades[seed % 8];
    CarSurfaces all;
    all.paint = world.add_surface({Pattern::plain, paint, 0, 0.35F, 0.22F, seed + 50});
    all.dirt = world.add_surface({Pattern::plain, 0.6F * paint + 0.1F, 0, 0.2F, 0.45F, seed + 51});
    all.glass = world.add_surface({Pattern::plain, 0.07F, 0, 0.5F, 0.7F, seed + 52});
    all.rubber = world.add_surface({Pattern::plain, 0.07F, 0, 0.08F, 0.5F, seed + 53});
    all.rim = world.add_surface({Pattern::plain, 0.55F, 0, 0.1F, 0.3F, seed + 54});
    all.lamp = world.add_surface({Pattern::plain, 0.75F, 0, 0.06F, 0.4F, seed + 55});
    all.tail_lamp = world.add_surface({Pattern::plain, 0.22F, 0, 0.08F, 0.4F, seed + 56});
    all.dark = world.add_surface({Pattern::plain, 0.05F, 0, 0.1F, 0.5F, seed + 57});
    all.plate = world.add_surface({Pattern::patches, 0.85F, 0.08F, 0.045F, 0.1F, seed + 58});
    return all;
}

CarMeshes make_car_meshes(const CarSurfaces &surfaces, bool coarse)
{
    CarMeshes car;
    car.body = make_lower_body(surfaces, coarse);
    add_cabin(car, surfaces);
    add_fittings(car.body, surfaces, coarse);
    car.boot_lid = make_boot_lid(surfaces);
    car.axle = make_axle(surfaces, coarse);
    return car;
}

Mesh make_whole_car(const CarSurfaces &surfaces, bool coarse)
{
    const CarMeshes car = make_car_meshes(surfaces, coarse);
    Mesh whole = car.body;
    whole.append(car.panes);
    whole.append(moved(car.boot_lid, Eigen::Affine3f(Eigen::Translation3f(kCarBootHinge))));
    whole.append(shifted(car.axle, kCarAxleM, 0, kCarWheelM));
    whole.append(shifted(car.axle, -kCarAxleM, 0, kCarWheelM));
    return whole;
}

} // namespace tsr::scene
