/*
 * What several scenes are made of.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_SCENE_PARTS_H
#define TSR_SCENE_SCENE_PARTS_H

#include <cstdint>
#include <functional>

#include "tsr/scene/scene.h"

namespace tsr::scene
{

Scene make_house(const SceneOptions &options, const LayoutOptions &layout);
Scene make_car(const SceneOptions &options, const LayoutOptions &layout);
Scene make_bedroom(const SceneOptions &options, const LayoutOptions &layout);
Scene make_street(const SceneOptions &options, const LayoutOptions &layout);
Scene make_tank(const SceneOptions &options, const LayoutOptions &layout);

/* Numbers from a seed, one after the other: xorshift64* (Vigna, ACM TOMS 42(4), 2016). */
class Chance
{
  public:
    explicit Chance(std::uint64_t seed);
    float between(float low, float high);
    int whole(int low, int high); /* both ends included */
    /* x, y and z one after the other: C++ leaves the order of arguments to the compiler. */
    Eigen::Vector3f within(const Eigen::Vector3f &low, const Eigen::Vector3f &high);

  private:
    std::uint64_t state_;
};

/* Light that grows and fades: a triangle of the period, smoothed, between 1 - drift and 1 + drift. */
float drift_at(const SceneOptions &options, std::uint64_t time_us);

/* Daylight of the given irradiances with the drift of options; the sun begins at azimuth and elevation (degrees) and
 * goes west by 15 degrees an hour. */
std::function<Light(std::uint64_t)> make_daylight(const SceneOptions &options, float sky, float sun, float azimuth_deg,
                                                  float elevation_deg);

/* count placements evenly around a centre, from angle_deg over span_deg, heights taking turns between low and high. */
std::vector<Placement> make_ring(const LayoutOptions &layout, const Eigen::Vector3d &centre, double distance_m,
                                 double height_low_m, double height_high_m, double angle_deg, double span_deg);

/* Uneven ground, a square of the size around the origin, in steps; rolls by up to height_m, or is as high as it is
 * told. */
Mesh make_terrain(float size_m, int steps, const std::function<float(float x, float y)> &height, SurfaceId surface);
Mesh make_ground(float size_m, int steps, float height_m, SurfaceId surface, std::uint32_t seed);
/* A trunk and leaves, about height_m high, from the origin. */
Mesh make_tree(float height_m, SurfaceId bark, SurfaceId leaves, Chance &chance);
/* Leaves about the origin, within radius. */
Mesh make_bush(float radius_m, SurfaceId leaves, Chance &chance);

} // namespace tsr::scene

#endif
