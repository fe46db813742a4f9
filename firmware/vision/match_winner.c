/*
 * Searches among the sums of one pixel: passes of equal lanes rather than one
 * with branches, which compilers turn into vector code.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_stages.h"

/* The key of a lane orders by sum and then by d. */
#define KEY_SCALE 128
_Static_assert(TSR_DISPARITY_COUNT_MAX <= KEY_SCALE, "d fits below the sum in a key");

struct tsr_match_winner tsr_match_find_winner(const int16_t *sums, unsigned disparities)
{
    int32_t least = INT32_MAX;
    for (unsigned d = 0; d < disparities; d += TSR_MATCH_LANES) {
        for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
            int32_t key = sums[d + i] * KEY_SCALE + (int32_t)(d + i);
            least = key < least ? key : least;
        }
    }
    struct tsr_match_winner winner = {(int16_t)(least / KEY_SCALE), (uint8_t)(least % KEY_SCALE)};
    return winner;
}

unsigned tsr_match_count_within(const int16_t *sums, unsigned disparities, int16_t limit)
{
    int16_t lanes[TSR_MATCH_LANES] = {0};
    for (unsigned d = 0; d < disparities; d += TSR_MATCH_LANES) {
        for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
            lanes[i] = (int16_t)(lanes[i] + (sums[d + i] <= limit ? 1 : 0));
        }
    }
    unsigned count = 0;
    for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
        count += (unsigned)lanes[i];
    }
    return count;
}
