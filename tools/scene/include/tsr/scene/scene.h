/*
 * The five virtual scenes: a world, where pairs of cameras stand in it, and
 * what happens.
 *
 *   house    from outdoors, pairs around it at several heights; somebody walks by
 *   car      a parked car within a ring of pairs; somebody opens the boot
 *   bedroom  a person walks in, sits, walks, falls, gets up and leaves
 *   street   people and cars pass, the sun moves
 *   tank     a level rises and falls
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_SCENE_H
#define TSR_SCENE_SCENE_H

#include <string>
#include <vector>

#include "tsr/scene/world.h"

namespace tsr::scene
{

struct SceneOptions {
    std::string kind;             /* one of scene_kinds() */
    std::uint64_t seed = 1;       /* of clutter, clothes, who comes when */
    double duration_s = 120;      /* events are spread over it; 10 .. 86,400 */
    double clutter = 1;           /* how many small things stand about, 0 .. 3 */
    double light_drift = 0.2;     /* the light grows and fades by this part, 0 .. 0.9 */
    double light_period_s = 90;   /* so long from bright to bright, 1 .. 86,400 */
    int people = 2;               /* who come by, 0 .. 20: house, car, bedroom, street */
    int cars = 2;                 /* that pass, 0 .. 20: street */
    double sun_hours = 0;         /* of the sun's way while the scene lasts, 0 .. 6: house, car, street */
    double level_step_m = 0.2;    /* by which the level rises and falls, 0.01 .. 0.8: tank */
    double level_rate_m_s = 0.01; /* how fast, 0.0001 .. 1: tank */
};

/* Where pairs stand. */
struct LayoutOptions {
    int count = 7;                              /* 1 .. 2,000 */
    double distance_m = 0;                      /* to what they watch; 0: the scene's own */
    double height_low_m = 0, height_high_m = 0; /* of the cameras; 0: the scene's own */
};

struct Placement { /* of the middle of a pair */
    std::string name;
    Eigen::Vector3d eye{0, 0, 0};
    Eigen::Vector3d target{0, 0, 0};
};

struct Scene {
    World world;
    std::vector<Placement> placements;
    double fov_deg = 60; /* that suits its placements, horizontal */
    Eigen::Vector3d gateway{0, 0, 0};
};

const std::vector<std::string> &scene_kinds();

/* options are in range and kind is one of scene_kinds(): the parser of scenario files has seen to that. */
Scene make_scene(const SceneOptions &options, const LayoutOptions &layout);

} // namespace tsr::scene

#endif
