/*
 * A number that changes when the matcher's maps change, so that a prior trained
 * for other maps is noticed (tests/unit/test_map_prior.cpp).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODING_MATCHER_FINGERPRINT_H
#define TSR_CODING_MATCHER_FINGERPRINT_H

#include <cstdint>

namespace tsr
{

/* CRC-16 of the node's map (mode sad, 3x3 median, defaults) of a made-up pair that has slopes, edges, occlusions, noise
 * and a plain wall. */
std::uint16_t matcher_fingerprint();

} // namespace tsr

#endif
