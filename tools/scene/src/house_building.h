/*
 * A detached house, 9 x 7 m, its middle at the origin, its front to -y.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_HOUSE_BUILDING_H
#define TSR_SCENE_HOUSE_BUILDING_H

#include "props.h"

namespace tsr::scene
{

inline constexpr float kHouseX = 4.5F, kHouseY = 3.5F; /* half lengths of the walls */
inline constexpr float kShedX = 6.4F;                  /* how far the lean-to reaches */
inline constexpr float kHouseDoorX = -0.9F;            /* middle of the front door */

void add_house(World &world, const PropSurfaces &props);

} // namespace tsr::scene

#endif
