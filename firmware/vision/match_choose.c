/*
 * One row of the map from the sums of its pixels, which come one after another:
 * the winner among the disparities that exist, the tests of uniqueness and of
 * left-right consistency, and the sub-pixel offset.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <string.h>

#include "match_smooth.h"

/* The disparities a pixel can search, lowest .. highest, and the best of them. */
struct winner {
    int lowest;
    int highest;
    int d;
};

/* docs/math.md, eq. (14). */
static struct winner find_winner(const struct tsr_match_config *config, const uint16_t *sums, unsigned x)
{
    int lane_of_first = (int)x - config->search_start_px;
    int lowest = lane_of_first - (config->width - 1);
    struct winner winner = {lowest > 0 ? lowest : 0, config->disparities - 1, 0};
    winner.highest = lane_of_first < winner.highest ? lane_of_first : winner.highest;
    winner.d = winner.lowest;
    for (int d = winner.lowest + 1; d <= winner.highest; d++) {
        winner.d = sums[d] < sums[winner.d] ? d : winner.d;
    }
    return winner;
}

/* docs/math.md, eq. (15). */
static bool is_unique(const struct tsr_match_config *config, const uint16_t *sums, struct winner winner)
{
    if (config->uniqueness_percent == TSR_MATCH_TEST_OFF) {
        return true;
    }
    unsigned limit = sums[winner.d] * (100u + config->uniqueness_percent) / 100u;
    bool unique = true;
    for (int d = winner.lowest; d <= winner.highest; d++) {
        bool own = d >= winner.d - 1 && d <= winner.d + 1;
        unique = unique && (own || sums[d] > limit);
    }
    return unique;
}

/* docs/math.md, eq. (16). */
static uint16_t interpolate_q4(const uint16_t *sums, struct winner winner)
{
    unsigned centre_q4 = (unsigned)winner.d * 16u;
    if (winner.d <= winner.lowest || winner.d >= winner.highest) {
        return (uint16_t)centre_q4;
    }
    unsigned below = sums[winner.d - 1];
    unsigned above = sums[winner.d + 1];
    unsigned slope = (below > above ? below : above) - sums[winner.d];
    unsigned lean = below > above ? below - above : above - below;
    unsigned offset_q4 = (16u * lean + slope) / (2u * slope);
    return (uint16_t)(below > above ? centre_q4 + offset_q4 : centre_q4 - offset_q4);
}

void tsr_match_begin_choice(const struct tsr_match *match)
{
    memset(tsr_match_share_smooth(match).right_cost, 0xff, sizeof(uint16_t) * match->config.width);
}

void tsr_match_choose(const struct tsr_match *match, unsigned x, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_smooth_scratch scratch = tsr_match_share_smooth(match);
    uint16_t *out = match->map + (size_t)y * config->width + x;
    struct winner winner = find_winner(config, scratch.sums, x);
    *out = TSR_DISPARITY_INVALID;
    if (winner.lowest > winner.highest) {
        return;
    }
    /* d grows with x, so the first of equal claims has the lowest d. */
    int right_x = (int)x - config->search_start_px - winner.d;
    scratch.left_d[x] = (uint8_t)winner.d;
    if (scratch.sums[winner.d] < scratch.right_cost[right_x]) {
        scratch.right_cost[right_x] = scratch.sums[winner.d];
        scratch.right_d[right_x] = (uint8_t)winner.d;
    }
    if (is_unique(config, scratch.sums, winner)) {
        *out = interpolate_q4(scratch.sums, winner);
    }
}

/* docs/math.md, eq. (17). */
void tsr_match_finish_choice(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_smooth_scratch scratch = tsr_match_share_smooth(match);
    uint16_t *row = match->map + (size_t)y * config->width;
    if (config->lr_tolerance_px == TSR_MATCH_TEST_OFF) {
        return;
    }
    for (unsigned x = 0; x < config->width; x++) {
        if (row[x] == TSR_DISPARITY_INVALID) {
            continue;
        }
        int d = scratch.left_d[x];
        int apart = scratch.right_d[(int)x - config->search_start_px - d] - d;
        if (apart > config->lr_tolerance_px || -apart > config->lr_tolerance_px) {
            row[x] = TSR_DISPARITY_INVALID;
        }
    }
}
