/*
 * Who comes by, and along which way.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_WALK_H
#define TSR_SCENE_WALK_H

#include <string>
#include <vector>

#include "tsr/scene/person.h"

namespace tsr::scene
{

struct Waypoint {
    float x = 0, y = 0;
    float wait_s = 0; /* here, before going on */
    float z = 0;      /* of the ground */
};

struct Walk {
    double start_s = 0; /* may lie before power-on */
    float speed_m_s = 1.3F;
    std::vector<Waypoint> way; /* two at least, each apart from the one before */
    float corner_m = 0.4F;     /* corners are cut by so much, at most by half a leg */
};

/* A body that goes that way, its x axis ahead, z above the ground. */
std::vector<PathKey> path_keys(const Walk &walk, float z);
std::vector<PersonKey> person_keys(const Walk &walk);
/* When it is there: at the end of the way. */
double end_of(const Walk &walk);
/* When it first comes within the box that low and high span in x and y; negative if never. */
double time_within(const Walk &walk, const Eigen::Vector2f &low, const Eigen::Vector2f &high);

/* Nothing is told of what has happened before power-on. */
void tell(World &world, double time_s, std::string what);
/* Events in order of time, without those after the end of the scene. */
void settle_events(World &world, double duration_s);

} // namespace tsr::scene

#endif
