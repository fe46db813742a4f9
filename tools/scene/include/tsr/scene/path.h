/*
 * Where something is over time: straight from key to key.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_PATH_H
#define TSR_SCENE_PATH_H

#include <cstdint>
#include <optional>
#include <vector>

#include "tsr/scene/world.h"

namespace tsr::scene
{

struct PathKey {
    double time_s = 0;
    Eigen::Vector3f position{0, 0, 0};
    float heading_deg = 0; /* about z, 0: along x; turned the shorter way between keys */
};

class Path
{
  public:
    /* keys in order of time, at least one. stays: it is there before the first and after the last key too. */
    Path(std::vector<PathKey> keys, bool stays);

    struct Place {
        Eigen::Vector3f position{0, 0, 0};
        float heading_deg = 0;
        float travelled_m = 0; /* since the first key */
        float speed_m_s = 0;
        std::size_t key = 0; /* the last one passed */
        float share = 0;     /* of the way to the next, 0 .. 1 */
    };
    std::optional<Place> at(std::uint64_t time_us) const;
    const std::vector<PathKey> &keys() const { return keys_; }

  private:
    std::vector<PathKey> keys_;
    std::vector<float> travelled_m_; /* at each key */
    bool stays_;
};

/* The pose of a body whose own x axis points along the heading. */
Eigen::Affine3f pose_of(const Path::Place &place);
/* A body that follows a path. */
Motion follow(Path path);

} // namespace tsr::scene

#endif
