/*
 * A scenario made concrete: the scene built, cameras placed, the tree of nodes
 * joined.
 *
 * Pairs become nodes 1, 2, ... (lead and wing of two boards follow each other), the gateway is the last. The
 * tree is binary: from the gateway outwards each node takes up to two of the nearest that are left and within
 * kReachM; what no node reaches is joined to the nearest all the same.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_STAGING_H
#define TSR_SCENARIO_STAGING_H

#include <memory>
#include <vector>

#include "tsr/scenario/scenario.h"
#include "tsr/scene/camera.h"
#include "tsr/scene/ray_caster.h"

namespace tsr
{

inline constexpr double kReachM = 40; /* two boards with 0 dBm hear each other well within it */

struct StagedCamera {
    std::uint16_t node = kNodeNone;
    bool right = false;
    scene::Camera camera;
};

struct Staging {
    std::unique_ptr<scene::Scene> scene;
    std::unique_ptr<scene::Geometry> geometry; /* keeps scene->world */
    std::vector<StagedCamera> cameras;         /* left and right of each pair, one after the other */
    Site site;                                 /* without folders of frames */
};

/* Throws InputError for a geometry that cannot be: a camera inside a thing, a pair whose views share nothing, a lens
 * that folds. */
Staging stage_scenario(const Scenario &scenario);

} // namespace tsr

#endif
