/*
 * Where in its image a camera may see something convex: a polygon. Everything errs to the larger side.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_SCREEN_HULL_H
#define TSR_SCENE_SCREEN_HULL_H

#include <vector>

#include <Eigen/Geometry>

namespace tsr::scene
{

class ScreenHull
{
  public:
    /* Of the part of the points' hull that lies before the camera (Z >= 1 cm), in x' = X / Z and y' = Y / Z, widened
     * by margin along both axes. */
    ScreenHull(const std::vector<Eigen::Vector3f> &points, const Eigen::Isometry3f &to_camera, float margin);

    /* Empty if nothing lies before the camera. */
    const Eigen::AlignedBox2f &bounds() const { return bounds_; }
    /* Whether a point within the bounds is in the polygon. */
    bool contains(const Eigen::Vector2f &point) const;

  private:
    struct Edge { /* inside: normal . p <= limit */
        Eigen::Vector2f normal;
        float limit;
    };

    Eigen::AlignedBox2f bounds_;
    std::vector<Edge> edges_;
};

} // namespace tsr::scene

#endif
