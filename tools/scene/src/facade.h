/*
 * Walls with windows and doors set back in them, and the houses of a street.
 *
 * A front stands in the x-z plane and faces -y; its own axes are those of make_wall.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_FACADE_H
#define TSR_SCENE_FACADE_H

#include <vector>

#include "scene_parts.h"

namespace tsr::scene
{

struct Opening {
    float x = 0, z = 0, width = 1, height = 1;
    int columns = 2, rows = 1; /* of panes, parted by bars */
    bool sill = true;
    SurfaceId back = 0; /* pane, or leaf of the door */
};

struct Band { /* of a front, one floor of it as a rule */
    float length = 1, low = 0, high = 1;
    float depth = 0.15F; /* by which openings are set back */
    SurfaceId wall = 0, trim = 0;
    bool frames = true;            /* around panes; without, bars and sills alone */
    std::vector<Opening> openings; /* from left to right, apart in x */
};

/* By label. The walls are closed by the backs and by what joins them. */
struct FrontParts {
    Mesh walls, backs, trims;
};
void add_band(FrontParts &parts, const Band &band);

struct StreetLabels {
    ObjectId wall = 0, window = 0, trim = 0, roof = 0, balcony = 0, awning = 0, sign = 0;
};
StreetLabels add_street_labels(World &world);

/* What the houses of a street are made of. */
struct StreetSurfaces {
    std::vector<SurfaceId> walls, grounds, awnings, signs; /* grounds: of the lowest floor */
    bool coarse = false;                                   /* for a long street */
    SurfaceId pane = 0, shop_pane = 0, door = 0, trim = 0, roof = 0, iron = 0;
};
StreetSurfaces add_street_surfaces(World &world, std::uint32_t seed);

/* A house 8 m deep, from x = 0 to width, its front at y = 0. Nothing stands out of the front within 0.9 m of its two
 * ends. Returns x of the middle of its door. */
float add_house_front(World &world, const StreetLabels &labels, const StreetSurfaces &surfaces,
                      const Eigen::Affine3f &place, float width, Chance &chance);

} // namespace tsr::scene

#endif
