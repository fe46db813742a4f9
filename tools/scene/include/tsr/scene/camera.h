/*
 * Where a virtual camera is and how it projects.
 *
 *   u = cx + f x'' ,  v = cy + f y''                 pinhole
 *   x'' = x' (1 + k1 r2 + k2 r2^2) + 2 p1 x' y' + p2 (r2 + 2 x'^2), x' = X / Z, r2 = x'^2 + y'^2, and y'' likewise:
 *   Brown, "Decentering distortion of lenses", 1966, in OpenCV's order of coefficients
 *
 * Camera axes: x right, y down, z forward. Pixel centres are whole numbers.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_CAMERA_H
#define TSR_SCENE_CAMERA_H

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace tsr::scene
{

struct Camera {
    int width = 160;
    int height = 120;
    double focal_px = 160;
    Eigen::Vector2d principal_px{79.5, 59.5};
    std::array<double, 4> distortion{};                    /* k1, k2, p1, p2 */
    Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()}; /* camera axes to site axes */
    std::uint32_t readout_us = 0; /* from the first row's exposure to the last row's; 0: all rows at once */
};

/* A camera at `eye` that looks at `target`, upright. The two differ, and not in z alone. */
Eigen::Isometry3d look_at(const Eigen::Vector3d &eye, const Eigen::Vector3d &target);

/*
 * (x', y') of what falls on image point (u, v): the distortion undone by fixed-point
 * iteration, 20 steps.
 */
Eigen::Vector2d undistorted(const Camera &camera, double u, double v);

/* The image point of a point in camera axes, z > 0. */
Eigen::Vector2d projected(const Camera &camera, const Eigen::Vector3d &point);

/* False where the distortion folds the image: its iteration does not come back to some pixel within 0.01 px. */
bool is_invertible(const Camera &camera);

} // namespace tsr::scene

#endif
