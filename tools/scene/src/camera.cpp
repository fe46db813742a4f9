/*
 * Projection and its inverse.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/camera.h"

namespace tsr::scene
{

namespace
{

constexpr int kIterations = 20;
constexpr int kCheckedPx = 4; /* every so many pixels */
constexpr double kTolerancePx = 0.01;

Eigen::Vector2d distorted(const std::array<double, 4> &k, const Eigen::Vector2d &p)
{
    const double r2 = p.squaredNorm();
    const double radial = 1 + r2 * (k[0] + r2 * k[1]);
    return {p.x() * radial + 2 * k[2] * p.x() * p.y() + k[3] * (r2 + 2 * p.x() * p.x()),
            p.y() * radial + k[2] * (r2 + 2 * p.y() * p.y()) + 2 * k[3] * p.x() * p.y()};
}

} // namespace

Eigen::Isometry3d look_at(const Eigen::Vector3d &eye, const Eigen::Vector3d &target)
{
    const Eigen::Vector3d forward = (target - eye).normalized();
    const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear().col(0) = right;
    pose.linear().col(1) = forward.cross(right);
    pose.linear().col(2) = forward;
    pose.translation() = eye;
    return pose;
}

Eigen::Vector2d undistorted(const Camera &camera, double u, double v)
{
    const Eigen::Vector2d seen = (Eigen::Vector2d(u, v) - camera.principal_px) / camera.focal_px;
    Eigen::Vector2d point = seen;
    for (int i = 0; i < kIterations && camera.distortion != std::array<double, 4>{}; ++i) {
        point += seen - distorted(camera.distortion, point);
    }
    return point;
}

Eigen::Vector2d projected(const Camera &camera, const Eigen::Vector3d &point)
{
    return camera.principal_px + camera.focal_px * distorted(camera.distortion, point.head<2>() / point.z());
}

bool is_invertible(const Camera &camera)
{
    for (int v = 0; v < camera.height; v += kCheckedPx) {
        for (int u = 0; u < camera.width; u += kCheckedPx) {
            const Eigen::Vector2d point = undistorted(camera, u, v);
            const Eigen::Vector2d back = projected(camera, {point.x(), point.y(), 1});
            if (!((back - Eigen::Vector2d(u, v)).norm() < kTolerancePx)) { /* also if it is not a number */
                return false;
            }
        }
    }
    return true;
}

} // namespace tsr::scene
