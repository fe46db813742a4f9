/*
 * Many pairs from few recorded ones: a site whose cameras see what others saw.
 *
 * Pair i of the crowd is a copy of pair i mod n of the recorded site's n: calibration, roles, watched rectangles and
 * frames are the same, shared by all its copies. It plays the recording in rounds, entered at an instant of its own,
 * and is switched on at one, from the gateway outwards: both drawn from the seed.
 *
 * Pairs become nodes 1, 2, ... (lead and wing of two boards follow each other), the gateway is the last and stands in
 * the middle. The tree is that of a virtual scene (tsr/scenario/staging.h).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_CROWD_H
#define TSR_SCENARIO_CROWD_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tsr/scenario/scenario.h"

namespace tsr
{

struct CrowdPair {
    std::size_t original = 0;    /* of recorded.pairs */
    std::uint64_t offset_ms = 0; /* into its rounds, modulo their length */
};

struct Crowd {
    Site recorded;                /* with folders of frames */
    Site site;                    /* without */
    std::vector<CrowdPair> pairs; /* for each of site.pairs */
    std::uint64_t pause_ms = 0;   /* between two rounds */
};

/* scenario.recorded is there. Throws InputError if the recorded site has no pairs or no frames for one. */
Crowd stage_crowd(const Scenario &scenario);

} // namespace tsr

#endif
