/*
 * What a surface returns to a camera, by source of light.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_SHADE_H
#define TSR_SCENE_SHADE_H

#include "tsr/scene/ray_caster.h"

namespace tsr::scene
{

struct Shade {
    float sky = 0, sun = 0, lamp = 0;
};

/* Of what a ray from eye meets first. pixel_rad: the angle a pixel covers. to_sun is of length 1. */
Shade shade(const RayCaster &caster, const World &world, const Eigen::Vector3f &eye, const Eigen::Vector3f &direction,
            const Eigen::Vector3f &to_sun, float pixel_rad, float moment);

} // namespace tsr::scene

#endif
