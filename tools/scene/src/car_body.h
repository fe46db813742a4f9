/*
 * A car: a saloon of 4.3 x 1.8 x 1.5 m with a boot.
 *
 * Its own axes: x ahead, z up, the origin on the ground below its middle.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_CAR_BODY_H
#define TSR_SCENE_CAR_BODY_H

#include "scene_parts.h"

namespace tsr::scene
{

inline constexpr float kCarAxleM = 1.3F;   /* ahead of the middle, and behind it */
inline constexpr float kCarWheelM = 0.31F; /* radius */
inline constexpr float kCarHalfLengthM = 2.2F, kCarHalfWidthM = 0.9F;

struct CarSurfaces {
    SurfaceId paint = 0, dirt = 0, glass = 0, rubber = 0, rim = 0, lamp = 0, tail_lamp = 0, dark = 0, plate = 0;
};
/* Cars of different seeds differ in paint. */
CarSurfaces add_car_surfaces(World &world, std::uint32_t seed);

struct CarMeshes {
    Mesh body, panes;
    Mesh boot_lid; /* in the hinge's axes: opens by turning about y from 0 to 75 degrees */
    Mesh axle;     /* two wheels, middle at the origin */
};
/* coarse: for cars among many. */
CarMeshes make_car_meshes(const CarSurfaces &surfaces, bool coarse);
inline const Eigen::Vector3f kCarBootHinge(-1.46F, 0, 0.955F);
/* Where the floor of the boot is, and what fits on it: 0.42 x 0.9 x 0.4 m. */
inline const Eigen::Vector3f kCarBootFloor(-1.77F, 0, 0.43F);

/* The four of them in one. */
Mesh make_whole_car(const CarSurfaces &surfaces, bool coarse);

} // namespace tsr::scene

#endif
