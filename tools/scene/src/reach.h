/*
 * What a moving body can reach: its hull on the way, and its shadows. Everything errs to the larger side.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_REACH_H
#define TSR_SCENE_REACH_H

#include <vector>

#include <Eigen/Geometry>

namespace tsr::scene
{

/* Points whose hull holds a box that goes straight from one pose to another. */
std::vector<Eigen::Vector3f> swept_corners(const Eigen::AlignedBox3f &box, const Eigen::Affine3f &begin,
                                           const Eigen::Affine3f &end);

/* Points whose hull holds the shadow of the body's hull on whatever is within bounds. */
std::vector<Eigen::Vector3f> with_sun_shadow(const std::vector<Eigen::Vector3f> &body, const Eigen::Vector3f &to_sun,
                                             const Eigen::AlignedBox3f &bounds);
std::vector<Eigen::Vector3f> with_lamp_shadow(const std::vector<Eigen::Vector3f> &body, const Eigen::Vector3f &lamp,
                                              const Eigen::AlignedBox3f &bounds);

} // namespace tsr::scene

#endif
