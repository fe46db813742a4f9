/*
 * Light, rings of cameras, ground and plants.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "scene_parts.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "tsr/scene/surface.h"

namespace tsr::scene
{

namespace
{

constexpr double kPi = std::numbers::pi;
constexpr double kSunDegreesPerHour = 15;

/* Levels of height from one place of a ring to the next; without a common factor, so that every level occurs once. */
int height_stride(int count)
{
    for (const int stride : {7, 3, 5, 11}) {
        if (std::gcd(stride, count) == 1) {
            return stride;
        }
    }
    return 1;
}

/* A leaf, or a twig with leaves: a quad that faces anywhere. */
void add_leaf(Mesh &mesh, const Eigen::Vector3f &at, float size, SurfaceId leaves, Chance &chance)
{
    const Eigen::Vector3f along = chance.within({-1, -1, -1}, {1, 1, 1});
    const Eigen::Vector3f across = chance.within({-1, -1, -1}, {1, 1, 1});
    const Eigen::Vector3f u = along.normalized() * size, v = along.cross(across).normalized() * size * 0.7F;
    mesh.add_quad(at - u - v, at + u - v, at + u + v, at - u + v, leaves);
}

void add_crown(Mesh &mesh, const Eigen::Vector3f &centre, float radius, int leaf_count, SurfaceId leaves,
               Chance &chance)
{
    for (int i = 0; i < leaf_count; ++i) {
        Eigen::Vector3f away;
        do {
            away = chance.within({-1, -1, -1}, {1, 1, 1});
        } while (away.squaredNorm() > 1);
        add_leaf(mesh, centre + radius * away, radius * chance.between(0.10F, 0.22F), leaves, chance);
    }
}

} // namespace

Chance::Chance(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15U + 1)
{
    between(0, 1);
}

float Chance::between(float low, float high)
{
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    const auto drawn = static_cast<std::uint32_t>(state_ * 0x2545f4914f6cdd1dU >> 40);
    return low + (high - low) * static_cast<float>(drawn) * (1.0F / 16777216.0F);
}

Eigen::Vector3f Chance::within(const Eigen::Vector3f &low, const Eigen::Vector3f &high)
{
    Eigen::Vector3f drawn;
    for (int axis = 0; axis < 3; ++axis) {
        drawn[axis] = between(low[axis], high[axis]);
    }
    return drawn;
}

int Chance::whole(int low, int high)
{
    const int drawn = low + static_cast<int>(between(0, 1) * static_cast<float>(high - low + 1));
    return drawn > high ? high : drawn;
}

float drift_at(const SceneOptions &options, std::uint64_t time_us)
{
    const double periods = static_cast<double>(time_us) / 1e6 / options.light_period_s;
    const double within = periods - std::floor(periods);
    const double triangle = within < 0.5 ? 2 * within : 2 - 2 * within;
    const double smooth = triangle * triangle * (3 - 2 * triangle);
    return static_cast<float>(1 + options.light_drift * (2 * smooth - 1));
}

std::function<Light(std::uint64_t)> make_daylight(const SceneOptions &options, float sky, float sun, float azimuth_deg,
                                                  float elevation_deg)
{
    return [=](std::uint64_t time_us) {
        const double share = static_cast<double>(time_us) / 1e6 / options.duration_s;
        const double azimuth = (azimuth_deg - kSunDegreesPerHour * options.sun_hours * share) * kPi / 180;
        const double elevation = elevation_deg * kPi / 180;
        const float drift = drift_at(options, time_us);
        Light light;
        light.sky = sky * drift;
        light.sun = sun * drift;
        light.to_sun = {static_cast<float>(std::cos(azimuth) * std::cos(elevation)),
                        static_cast<float>(std::sin(azimuth) * std::cos(elevation)),
                        static_cast<float>(std::sin(elevation))};
        light.to_sun = light.to_sun.unaryExpr([](float v) { return std::nearbyint(v * 65536.0F) / 65536.0F; });
        return light;
    };
}

std::vector<Placement> make_ring(const LayoutOptions &layout, const Eigen::Vector3d &centre, double distance_m,
                                 double height_low_m, double height_high_m, double angle_deg, double span_deg)
{
    const double distance = layout.distance_m > 0 ? layout.distance_m : distance_m;
    const bool own = layout.height_high_m <= 0;
    const double low = own ? height_low_m : layout.height_low_m, high = own ? height_high_m : layout.height_high_m;
    std::vector<Placement> ring;
    for (int i = 0; i < layout.count; ++i) {
        const double angle = (angle_deg + span_deg * (i + 0.5) / layout.count) * kPi / 180;
        const int level = i * height_stride(layout.count) % layout.count;
        const double share = layout.count > 1 ? level / static_cast<double>(layout.count - 1) : 0;
        Placement placement;
        placement.name = "pair " + std::to_string(i + 1);
        placement.eye = centre + Eigen::Vector3d(distance * std::cos(angle), distance * std::sin(angle), 0);
        placement.eye.z() = low + (high - low) * share;
        placement.target = centre;
        ring.push_back(placement);
    }
    return ring;
}

Mesh make_terrain(float size_m, int steps, const std::function<float(float x, float y)> &height, SurfaceId surface)
{
    const float step = size_m / static_cast<float>(steps);
    const auto at = [&](int i, int j) {
        const float x = static_cast<float>(i) * step - size_m / 2, y = static_cast<float>(j) * step - size_m / 2;
        return Eigen::Vector3f(x, y, height(x, y));
    };
    Mesh mesh;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            mesh.add_quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), surface);
        }
    }
    return mesh;
}

Mesh make_ground(float size_m, int steps, float height_m, SurfaceId surface, std::uint32_t seed)
{
    const auto rolls = [=](float x, float y) {
        return height_m * noise_at(Eigen::Vector3f(x, y, 0) * 0.2F, 0, 2, seed);
    };
    return make_terrain(size_m, steps, rolls, surface);
}

Mesh make_tree(float height_m, SurfaceId bark, SurfaceId leaves, Chance &chance)
{
    Mesh mesh = make_cylinder(0.035F * height_m, 0.02F * height_m, 0.55F * height_m, 10, bark);
    for (int i = 0; i < 5; ++i) {
        const Eigen::Vector3f centre = height_m * chance.within({-0.16F, -0.16F, 0.55F}, {0.16F, 0.16F, 0.85F});
        add_crown(mesh, centre, chance.between(0.14F, 0.22F) * height_m, 140, leaves, chance);
    }
    return mesh;
}

Mesh make_bush(float radius_m, SurfaceId leaves, Chance &chance)
{
    Mesh mesh;
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3f centre = radius_m * chance.within({-0.4F, -0.4F, 0.5F}, {0.4F, 0.4F, 0.5F});
        add_crown(mesh, centre, 0.6F * radius_m, 90, leaves, chance);
    }
    return mesh;
}

} // namespace tsr::scene
