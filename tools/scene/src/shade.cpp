/*
 * Lambertian surfaces under a sky, a sun and a lamp.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "shade.h"

#include <algorithm>
#include <limits>

namespace tsr::scene
{

namespace
{

/* Clouds in the sky: as bright as a white surface under it, a third of that more or less. */
Shade sky_shade(const Eigen::Vector3f &direction, const Eigen::Vector3f &to_sun, float pixel_rad)
{
    const float clouds = noise_at(direction * 3, 3 * pixel_rad, 4, 0x5c7u);
    const float near_sun = std::max(direction.dot(to_sun), 0.0F);
    const float glow = near_sun * near_sun * near_sun * near_sun;
    return {1.0F + 0.35F * clouds, 0.2F * glow, 0};
}

} // namespace

Shade shade(const RayCaster &caster, const World &world, const Eigen::Vector3f &eye, const Eigen::Vector3f &direction,
            const Eigen::Vector3f &to_sun, float pixel_rad, float moment)
{
    const auto hit = caster.trace(eye, direction, moment);
    if (!hit) {
        return sky_shade(direction, to_sun, pixel_rad);
    }
    const float reflectance = reflectance_at(world.surfaces[hit->surface], hit->body_point, hit->distance * pixel_rad);
    const Eigen::Vector3f point = eye + hit->distance * direction;
    Shade result;
    result.sky = reflectance * (0.5F + 0.5F * hit->normal.z());
    const float facing_sun = world.has_sun ? hit->normal.dot(to_sun) : 0;
    if (facing_sun > 0 && !caster.is_blocked(point, to_sun, std::numeric_limits<float>::infinity(), moment)) {
        result.sun = reflectance * facing_sun;
    }
    if (!world.lamp_position) {
        return result;
    }
    const Eigen::Vector3f to_lamp = *world.lamp_position - point;
    const float distance2 = std::max(to_lamp.squaredNorm(), 0.01F);
    const float distance = std::sqrt(distance2);
    const float facing_lamp = hit->normal.dot(to_lamp) / distance;
    if (facing_lamp > 0 && !caster.is_blocked(point, to_lamp / distance, distance, moment)) {
        result.lamp = reflectance * facing_lamp / distance2;
    }
    return result;
}

} // namespace tsr::scene
