/*
 * Pictures that are traced again where something moved.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/view.h"

#include <algorithm>
#include <array>

#include "reach.h"
#include "screen_hull.h"
#include "shade.h"

namespace tsr::scene
{

namespace
{

constexpr std::size_t kSamples = 4;
/* A rotated grid: no two samples share a row or column. */
constexpr std::array<std::array<double, 2>, kSamples> kOffsets = {
    {{-0.375, -0.125}, {0.125, -0.375}, {0.375, 0.125}, {-0.125, 0.375}}};
/* Of a pixel: what four samples leave unresolved. */
constexpr float kSampleFootprint = 0.7F;

} // namespace

bool View::Shown::operator==(const Shown &other) const
{
    return there == other.there &&
           (!there || (begin.matrix() == other.begin.matrix() && end.matrix() == other.end.matrix()));
}

View::View(const Geometry &geometry, const Camera &camera)
    : geometry_(geometry), camera_(camera), eye_(camera.pose.translation().cast<float>()),
      shown_(geometry.movers().size())
{
    const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    layers_.sky.resize(pixels);
    layers_.sun.resize(pixels);
    layers_.lamp.resize(pixels);
    dirty_.resize(pixels);
    image_points_.reserve(pixels);
    directions_.reserve(kSamples * pixels);
    row_bounds_.resize(static_cast<std::size_t>(camera.height));
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            const Eigen::Vector2f centre = undistorted(camera, x, y).cast<float>();
            image_points_.push_back(centre);
            row_bounds_[static_cast<std::size_t>(y)].extend(centre);
            for (const auto &offset : kOffsets) {
                const double u = x + offset[0], v = y + offset[1];
                directions_.push_back(direction_of(u, v));
                margin_ = std::max(margin_, (undistorted(camera, u, v).cast<float>() - centre).cwiseAbs().maxCoeff());
            }
        }
    }
    margin_ *= 1.01F; /* against rounding of the bounds */
}

Eigen::Vector3f View::direction_of(double u, double v) const
{
    const Eigen::Vector2d point = undistorted(camera_, u, v);
    return (camera_.pose.linear() * Eigen::Vector3d(point.x(), point.y(), 1).normalized()).cast<float>();
}

void View::trace_pixel(const RayCaster &caster, std::size_t pixel)
{
    const std::size_t row = pixel / static_cast<std::size_t>(camera_.width);
    const float moment = static_cast<float>(row) / static_cast<float>(camera_.height);
    const float pixel_rad = kSampleFootprint / static_cast<float>(camera_.focal_px);
    Shade sum;
    for (std::size_t i = 0; i < kSamples; ++i) {
        const Shade sample =
            shade(caster, geometry_.world(), eye_, directions_[pixel * kSamples + i], to_sun_, pixel_rad, moment);
        sum.sky += sample.sky;
        sum.sun += sample.sun;
        sum.lamp += sample.lamp;
    }
    layers_.sky[pixel] = sum.sky / kSamples;
    layers_.sun[pixel] = sum.sun / kSamples;
    layers_.lamp[pixel] = sum.lamp / kSamples;
    ++traced_;
}

void View::mark(const std::vector<Eigen::Vector3f> &hull)
{
    const ScreenHull seen(hull, camera_.pose.inverse().cast<float>(), margin_);
    const auto width = static_cast<std::size_t>(camera_.width);
    for (std::size_t row = 0; row < row_bounds_.size(); ++row) {
        if (!seen.bounds().intersects(row_bounds_[row])) {
            continue;
        }
        for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
            if (dirty_[i] == 0 && seen.bounds().contains(image_points_[i]) && seen.contains(image_points_[i])) {
                dirty_[i] = 1;
            }
        }
    }
}

/* Pixels that can see the mover, or a shadow of it, somewhere between its two poses. */
void View::mark(const Geometry::Mover &mover, const Shown &shown)
{
    if (!shown.there) {
        return;
    }
    const World &world = geometry_.world();
    const std::vector<Eigen::Vector3f> body = swept_corners(mover.box, shown.begin, shown.end);
    if (!world.has_sun && !world.lamp_position) {
        mark(body); /* otherwise in its shadow's hull */
    }
    if (world.has_sun) {
        mark(with_sun_shadow(body, to_sun_, geometry_.bounds()));
    }
    if (world.lamp_position) {
        mark(with_lamp_shadow(body, *world.lamp_position, geometry_.bounds()));
    }
}

const Layers &View::render(RayCaster &caster, std::uint64_t time_us)
{
    const World &world = geometry_.world();
    caster.set_time(time_us, camera_.readout_us);
    const std::uint64_t sun_moment = time_us / world.sun_step_us;
    std::fill(dirty_.begin(), dirty_.end(), static_cast<std::uint8_t>(sun_moment != sun_moment_));
    if (sun_moment != sun_moment_) {
        to_sun_ = world.light_at(sun_moment * world.sun_step_us).to_sun.normalized();
    }
    for (std::size_t i = 0; i < shown_.size(); ++i) {
        const Geometry::Mover &mover = geometry_.movers()[i];
        const auto begin = world.pose_of(world.bodies[mover.body], time_us);
        const auto end = world.pose_of(world.bodies[mover.body], time_us + camera_.readout_us);
        Shown now;
        now.there = begin || end;
        if (now.there) {
            now.begin = begin ? *begin : *end;
            now.end = end ? *end : *begin;
        }
        if (!(now == shown_[i])) {
            if (sun_moment == sun_moment_) {
                mark(mover, shown_[i]);
                mark(mover, now);
            }
            shown_[i] = now;
        }
    }
    sun_moment_ = sun_moment;
    for (std::size_t i = 0; i < dirty_.size(); ++i) {
        if (dirty_[i] != 0) {
            trace_pixel(caster, i);
        }
    }
    return layers_;
}

Truth View::truth(RayCaster &caster, std::uint64_t time_us) const
{
    caster.set_time(time_us, camera_.readout_us);
    Truth truth;
    const Eigen::Vector3f forward = camera_.pose.linear().col(2).cast<float>();
    for (int y = 0; y < camera_.height; ++y) {
        for (int x = 0; x < camera_.width; ++x) {
            const Eigen::Vector3f direction = direction_of(x, y);
            const auto hit = caster.trace(eye_, direction, static_cast<float>(y) / static_cast<float>(camera_.height));
            truth.depth_m.push_back(hit ? hit->distance * direction.dot(forward) : 0);
            truth.objects.push_back(hit ? hit->object : ObjectId{0});
        }
    }
    return truth;
}

} // namespace tsr::scene
