/*
 * What is where in the street, and who moves in it.
 *
 *      y
 *      ^   houses
 *   7.4 ---------------- fronts, doors, cameras
 *          pavement      who walks: about 6.2
 *   4.6 ---------------- kerb; trees, lamp posts and bins at 5.0
 *          parked cars, middle at 3.65
 *          lane to -x, middle at 1.5
 *   0   - - - - - - - -> x
 *          ...           the same with the lane to +x
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_STREET_PLAN_H
#define TSR_SCENE_STREET_PLAN_H

#include <vector>

#include "scene_parts.h"

namespace tsr::scene
{

inline constexpr float kFrontY = 7.4F, kKerbY = 4.6F, kPostY = 5.0F, kParkedY = 3.65F, kLaneY = 1.5F, kWalkY = 6.2F;
inline constexpr float kPavementZ = 0.13F;
inline constexpr float kHouseWidthM = 10;
inline constexpr float kCrossStreetM = 12; /* width of the streets across the ends, front to front */

struct StreetPlan {
    int houses = 6; /* a side */
    float half_length() const { return kHouseWidthM * static_cast<float>(houses) / 2; }
    /* x where house i begins. */
    float boundary(int i) const { return kHouseWidthM * static_cast<float>(i) - half_length(); }
    /* x of the zebra crossings, each in the middle before a house. */
    std::vector<float> crossings() const;
    bool is_by_crossing(float x, float reach) const;
};

struct Door {
    float x = 0, side = 1; /* side: of the street, the sign of its y */
};

/* A car on its lane. */
struct Drive {
    double start_s = 0;            /* when it comes in at the end of the street */
    float speed_m_s = 7, side = 1; /* of the lane; the lane with y < 0 goes to +x */
    /* When its middle is at x. */
    double time_at(const StreetPlan &plan, float x) const;
};

void add_road(World &world, const StreetPlan &plan);
void add_furniture(World &world, const SceneOptions &options, const StreetPlan &plan);
std::vector<Drive> add_traffic(World &world, const SceneOptions &options, const StreetPlan &plan);
/* They come out of doors and go into others; those who cross wait until no car comes. */
void add_pedestrians(World &world, const SceneOptions &options, const StreetPlan &plan, const std::vector<Door> &doors,
                     const std::vector<Drive> &drives);

} // namespace tsr::scene

#endif
