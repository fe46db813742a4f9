/* Lenses as OpenCV models them. SPDX-License-Identifier: Apache-2.0 */
#include <algorithm>
#include <cmath>
#include <limits>

#include "tsr/host/calibration.h"

namespace tsr
{
namespace
{

constexpr double kRadiusStep = 1e-3;
constexpr double kRadiusEnd = 4.0; /* 76 degrees off the axis */
constexpr int kIterations = 50;

struct RadialTerms {
    double numerator;
    double denominator;
};

RadialTerms radial_terms(const std::array<double, 12> &d, double r2)
{
    return {1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4])), 1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7]))};
}

double equidistant_angle(const std::array<double, 12> &d, double radius)
{
    const double theta = std::atan(radius);
    const double t2 = theta * theta;
    return theta * (1 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
}

/* The ray after the lens. */
Point2 bend(const Camera &camera, Point2 ray)
{
    const auto &d = camera.distortion;
    const double r2 = ray.x * ray.x + ray.y * ray.y;
    if (camera.lens == LensModel::equidistant) {
        const double radius = std::sqrt(r2);
        const double scale = radius > 1e-12 ? equidistant_angle(d, radius) / radius : 1.0;
        return {ray.x * scale, ray.y * scale};
    }
    const RadialTerms terms = radial_terms(d, r2);
    const double radial = terms.numerator / terms.denominator;
    const double xy2 = 2 * ray.x * ray.y;
    return {ray.x * radial + d[2] * xy2 + d[3] * (r2 + 2 * ray.x * ray.x) + r2 * (d[8] + r2 * d[9]),
            ray.y * radial + d[2] * (r2 + 2 * ray.y * ray.y) + d[3] * xy2 + r2 * (d[10] + r2 * d[11])};
}

double bent_radius(const Camera &camera, double radius)
{
    if (camera.lens == LensModel::equidistant) {
        return equidistant_angle(camera.distortion, radius);
    }
    const RadialTerms terms = radial_terms(camera.distortion, radius * radius);
    return terms.denominator > 0 ? radius * terms.numerator / terms.denominator : -1;
}

} // namespace

Point2 Camera::project(Point2 ray) const
{
    const Point2 bent = bend(*this, ray);
    return {fx * bent.x + cx, fy * bent.y + cy};
}

Point2 Camera::unproject(Point2 pixel) const
{
    const Point2 goal{(pixel.x - cx) / fx, (pixel.y - cy) / fy};
    Point2 ray = goal;
    for (int i = 0; i < kIterations; i++) {
        const Point2 seen = bend(*this, ray);
        ray = {ray.x + goal.x - seen.x, ray.y + goal.y - seen.y};
    }
    return ray;
}

double Camera::radius_max() const
{
    double last = 0;
    for (double radius = kRadiusStep; radius < kRadiusEnd; radius += kRadiusStep) {
        const double bent = bent_radius(*this, radius);
        if (!(bent > last)) {
            return radius - kRadiusStep;
        }
        last = bent;
    }
    return std::numeric_limits<double>::infinity();
}

Camera Camera::resized(ImageSize frame) const
{
    const double scale =
        std::max(static_cast<double>(frame.width) / size.width, static_cast<double>(frame.height) / size.height);
    Camera camera = *this;
    camera.size = frame;
    camera.fx *= scale;
    camera.fy *= scale;
    camera.cx = (cx + 0.5 - 0.5 * size.width) * scale + 0.5 * frame.width - 0.5;
    camera.cy = (cy + 0.5 - 0.5 * size.height) * scale + 0.5 * frame.height - 0.5;
    return camera;
}

} // namespace tsr
