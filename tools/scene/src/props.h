/*
 * Small things that stand about. Each stands on z = 0 at the origin.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_PROPS_H
#define TSR_SCENE_PROPS_H

#include "scene_parts.h"

namespace tsr::scene
{

/* What they are made of. */
struct PropSurfaces {
    SurfaceId wood = 0, bark = 0, stone = 0, clay = 0, iron = 0, paint = 0, white = 0, dark = 0, print = 0, leaves = 0;
};
PropSurfaces add_prop_surfaces(World &world, std::uint32_t seed);

/* A box whose top is of another size than its foot. */
Mesh make_frustum(const Eigen::Vector2f &foot, const Eigen::Vector2f &top, float height, SurfaceId surface);

Mesh make_bench(const PropSurfaces &surfaces);
Mesh make_wheelie_bin(const PropSurfaces &surfaces);
Mesh make_litter_bin(const PropSurfaces &surfaces);
/* Without its plant: a bush of 3/4 of its height, 0.95 of its height up. Leaves are not solid and have a label of their
 * own. */
Mesh make_flower_pot(float height_m, const PropSurfaces &surfaces);
/* Logs along y, the pile along x. */
Mesh make_wood_pile(float length_m, float height_m, const PropSurfaces &surfaces, Chance &chance);
Mesh make_wheelbarrow(const PropSurfaces &surfaces);
Mesh make_crate(const Eigen::Vector3f &size, const PropSurfaces &surfaces);
Mesh make_cone(const PropSurfaces &surfaces);
Mesh make_barrel(const PropSurfaces &surfaces);
/* Pickets along x from the origin. */
Mesh make_fence(float length_m, float height_m, float step_m, SurfaceId wood);
/* Its arm reaches along +y. */
Mesh make_lamp_post(float height_m, const PropSurfaces &surfaces);
/* Faces -y. */
Mesh make_road_sign(const PropSurfaces &surfaces, bool round);

} // namespace tsr::scene

#endif
