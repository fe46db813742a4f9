/*
 * Searches among the sums of one pixel. Three short passes of equal lanes
 * rather than one with branches: compilers turn them into vector code.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_stages.h"

static inline int16_t least(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static int16_t least_of_lanes(const int16_t *lanes)
{
    int16_t result = lanes[0];
    for (unsigned i = 1; i < TSR_MATCH_LANES; i++) {
        result = least(result, lanes[i]);
    }
    return result;
}

struct tsr_match_winner tsr_match_find_winner(const int16_t *sums, unsigned disparities)
{
    int16_t lanes[TSR_MATCH_LANES];
    for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
        lanes[i] = TSR_MATCH_SUM_NONE;
    }
    for (unsigned d = 0; d < disparities; d += TSR_MATCH_LANES) {
        for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
            lanes[i] = least(lanes[i], sums[d + i]);
        }
    }
    struct tsr_match_winner winner = {least_of_lanes(lanes), 0};
    for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
        lanes[i] = TSR_MATCH_SUM_NONE;
    }
    for (unsigned d = 0; d < disparities; d += TSR_MATCH_LANES) {
        for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
            int16_t candidate = sums[d + i] == winner.sum ? (int16_t)(d + i) : TSR_MATCH_SUM_NONE;
            lanes[i] = least(lanes[i], candidate);
        }
    }
    winner.d = (uint8_t)least_of_lanes(lanes);
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
