/*
 * Projection of convex hulls.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "screen_hull.h"

#include <algorithm>

namespace tsr::scene
{

namespace
{

using Point = Eigen::Vector2d;

constexpr float kNear = 0.01F;
/* Of the edges' own arithmetic, in x', y': a hundredth of a pixel. */
constexpr double kRounding = 1e-4;

/* Images of the points before the camera and of where the hull's edges cross the near plane. */
std::vector<Point> project(const std::vector<Eigen::Vector3f> &points, const Eigen::Isometry3f &to_camera)
{
    std::vector<Eigen::Vector3f> seen;
    seen.reserve(points.size());
    for (const Eigen::Vector3f &point : points) {
        seen.push_back(to_camera * point);
    }
    std::vector<Point> image;
    for (const Eigen::Vector3f &a : seen) {
        if (a.z() >= kNear) {
            image.push_back((a.head<2>() / a.z()).cast<double>());
            continue;
        }
        /* Every edge of the hull is among the segments between two points. */
        for (const Eigen::Vector3f &b : seen) {
            if (b.z() > kNear) {
                const Eigen::Vector3f crossing = a + (b - a) * ((kNear - a.z()) / (b.z() - a.z()));
                image.push_back((crossing.head<2>() / kNear).cast<double>());
            }
        }
    }
    return image;
}

/* Twice the area of a triangle, positive if it turns left. */
double turn(const Point &a, const Point &b, const Point &c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/* Corners, counter-clockwise (A. M. Andrew, Information Processing Letters 9(5), 1979: two monotone chains). */
std::vector<Point> convex_hull(std::vector<Point> points)
{
    std::sort(points.begin(), points.end(),
              [](const Point &a, const Point &b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    std::vector<Point> hull;
    for (int chain = 0; chain < 2; ++chain) {
        const std::size_t start = hull.size();
        for (const Point &point : points) {
            while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
                hull.pop_back();
            }
            hull.push_back(point);
        }
        hull.pop_back(); /* the other chain begins with it */
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

} // namespace

ScreenHull::ScreenHull(const std::vector<Eigen::Vector3f> &points, const Eigen::Isometry3f &to_camera, float margin)
{
    const std::vector<Point> image = project(points, to_camera);
    if (image.empty()) {
        return;
    }
    for (const Point &point : image) {
        bounds_.extend(point.cast<float>());
    }
    const double widened = static_cast<double>(margin) + kRounding;
    bounds_.min().array() -= static_cast<float>(widened);
    bounds_.max().array() += static_cast<float>(widened);
    const std::vector<Point> corners = convex_hull(image);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point along = corners[(i + 1) % corners.size()] - corners[i];
        if (along.norm() > 0) {
            const Point normal = Point(along.y(), -along.x()) / along.norm();
            const double limit = normal.dot(corners[i]) + widened * normal.cwiseAbs().sum();
            edges_.push_back({normal.cast<float>(), static_cast<float>(limit)});
        }
    }
}

bool ScreenHull::contains(const Eigen::Vector2f &point) const
{
    return std::all_of(edges_.begin(), edges_.end(),
                       [&point](const Edge &edge) { return edge.normal.dot(point) <= edge.limit; });
}

} // namespace tsr::scene
