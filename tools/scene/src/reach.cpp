/*
 * Bounds of bodies and shadows.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "reach.h"

#include <algorithm>
#include <limits>

namespace tsr::scene
{

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/* A shadow that never leaves the bounds, as a lamp's inside of its body, goes this far. */
constexpr float kFarthestM = 1e4F;

Eigen::AlignedBox3f with_points(Eigen::AlignedBox3f box, const std::vector<Eigen::Vector3f> &points)
{
    for (const Eigen::Vector3f &point : points) {
        box.extend(point);
    }
    return box;
}

} // namespace

std::vector<Eigen::Vector3f> swept_corners(const Eigen::AlignedBox3f &box, const Eigen::Affine3f &begin,
                                           const Eigen::Affine3f &end)
{
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Affine3f *pose : {&begin, &end}) {
        for (int i = 0; i < 8; ++i) {
            points.push_back(*pose * box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)));
        }
    }
    return points;
}

/* Along one axis a point p leaves the box after t(p), linear in p; a point of the hull leaves it when the first axis
 * does, and for that axis not later than the last of the corners. */
std::vector<Eigen::Vector3f> with_sun_shadow(const std::vector<Eigen::Vector3f> &body, const Eigen::Vector3f &to_sun,
                                             const Eigen::AlignedBox3f &bounds)
{
    const Eigen::AlignedBox3f all = with_points(bounds, body);
    float reach = kFarthestM;
    for (int axis = 0; axis < 3; ++axis) {
        const float step = -to_sun[axis];
        const float wall = step > 0 ? all.max()[axis] : all.min()[axis];
        float last = step == 0 ? kInfinity : 0;
        for (const Eigen::Vector3f &point : body) {
            last = std::max(last, (wall - point[axis]) / step);
        }
        reach = std::min(reach, last);
    }
    std::vector<Eigen::Vector3f> points = body;
    for (const Eigen::Vector3f &point : body) {
        points.push_back(point - reach * to_sun);
    }
    return points;
}

/* The same for lamp + s (p - lamp), s >= 1, as long as all corners lie on one side of the lamp. */
std::vector<Eigen::Vector3f> with_lamp_shadow(const std::vector<Eigen::Vector3f> &body, const Eigen::Vector3f &lamp,
                                              const Eigen::AlignedBox3f &bounds)
{
    const Eigen::AlignedBox3f all = with_points(bounds, body);
    float reach = kFarthestM;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            const float wall = side > 0 ? all.max()[axis] : all.min()[axis];
            float last = 1;
            for (const Eigen::Vector3f &point : body) {
                const float away = point[axis] - lamp[axis];
                last = std::max(last, away * side > 0 ? (wall - lamp[axis]) / away : kInfinity);
            }
            reach = std::min(reach, last);
        }
    }
    std::vector<Eigen::Vector3f> points = body;
    for (const Eigen::Vector3f &point : body) {
        points.push_back(lamp + reach * (point - lamp));
    }
    return points;
}

} // namespace tsr::scene
