/*
 * The choice of one pixel from its sums: winner, the tests of uniqueness and of
 * left-right consistency, and the sub-pixel offset. For every mode with sums
 * that fit 16 bits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "match_stages.h"

/* The disparities a pixel can search: lowest .. highest, or none. */
struct offer {
    int lowest;
    int highest;
};

static struct offer offer_at(const struct tsr_match_config *config, unsigned x)
{
    int lane_of_first = (int)x - config->search_start_px;
    int lowest = lane_of_first - (config->width - 1);
    struct offer offer = {lowest > 0 ? lowest : 0, config->disparities - 1};
    offer.highest = lane_of_first < offer.highest ? lane_of_first : offer.highest;
    return offer;
}

/* The sums with what this pixel cannot search masked. */
static const int16_t *mask_sums(const struct tsr_match_scratch *scratch, unsigned disparities, struct offer offer)
{
    if (offer.lowest == 0 && offer.highest == (int)disparities - 1) {
        return scratch->sums;
    }
    for (int d = 0; d < (int)disparities; d++) {
        scratch->offered[d] = d >= offer.lowest && d <= offer.highest ? scratch->sums[d] : TSR_MATCH_SUM_NONE;
    }
    return scratch->offered;
}

/* docs/math.md, eq. (15). Sums within the limit beside d* are its own slope. */
static bool is_unique(const struct tsr_match_config *config, const int16_t *sums, struct tsr_match_winner winner)
{
    if (config->uniqueness_percent == TSR_MATCH_TEST_OFF) {
        return true;
    }
    int16_t limit = (int16_t)((unsigned)winner.sum * (100u + config->uniqueness_percent) / 100u);
    unsigned own = 1;
    own += winner.d > 0 && sums[winner.d - 1] <= limit ? 1u : 0u;
    own += winner.d + 1u < config->disparities && sums[winner.d + 1] <= limit ? 1u : 0u;
    return tsr_match_count_within(sums, config->disparities, limit) == own;
}

/* docs/math.md, eq. (16): 16 d* plus the apex of two lines of equal and opposite
 * slope. The sum at d* - 1 exceeds the least one, so the slope is not 0. */
static int find_offset_q4(const int16_t *sums, struct tsr_match_winner winner, struct offer offer)
{
    if (winner.d <= offer.lowest || winner.d >= offer.highest) {
        return 0;
    }
    unsigned below = (unsigned)sums[winner.d - 1];
    unsigned above = (unsigned)sums[winner.d + 1];
    unsigned slope = (below > above ? below : above) - (unsigned)winner.sum;
    unsigned lean = below > above ? below - above : above - below;
    unsigned offset_q4 = (16u * lean + slope) / (2u * slope);
    return below > above ? (int)offset_q4 : -(int)offset_q4;
}

static void claim_right(const struct tsr_match *match, const struct tsr_match_scratch *scratch, int right_x,
                        struct tsr_match_winner winner)
{
    uint16_t claim = TSR_MATCH_CLAIM_OF(winner.sum, tsr_match_claim_shift(match->config.mode), winner.d);
    if (claim < scratch->claims[right_x]) {
        scratch->claims[right_x] = claim;
    }
}

void tsr_match_begin_choice(const struct tsr_match *match)
{
    memset(tsr_match_share_scratch(match).claims, 0xff, sizeof(uint16_t) * match->config.width);
}

void tsr_match_choose(const struct tsr_match *match, unsigned x, bool textured)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    struct offer offer = offer_at(config, x);
    scratch.choices[x] = TSR_MATCH_CHOICE_NONE;
    if (offer.lowest > offer.highest) {
        return;
    }
    const int16_t *sums = mask_sums(&scratch, config->disparities, offer);
    struct tsr_match_winner winner = tsr_match_find_winner(sums, config->disparities);
    claim_right(match, &scratch, (int)x - config->search_start_px - winner.d, winner);
    if (textured && is_unique(config, sums, winner)) {
        scratch.choices[x] = TSR_MATCH_CHOICE(winner.d, find_offset_q4(sums, winner, offer));
    }
}

/* docs/math.md, eq. (17). */
void tsr_match_write_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    uint16_t *map_row = match->map + (size_t)y * config->width;
    bool off = config->lr_tolerance_px == TSR_MATCH_TEST_OFF;
    unsigned tolerance = off ? TSR_DISPARITY_COUNT_MAX : config->lr_tolerance_px;
    const uint16_t *claims = scratch.claims - config->search_start_px; /* of column x - d, d as in the map */
    for (unsigned x = 0; x < config->width; x++) {
        unsigned choice = scratch.choices[x];
        unsigned value = TSR_DISPARITY_INVALID;
        if (choice != TSR_MATCH_CHOICE_NONE) {
            int d = (int)(choice >> 5);
            unsigned apart = (unsigned)(TSR_MATCH_CLAIM_D(claims[(int)x - d]) - d) + tolerance;
            value = apart <= 2u * tolerance ? 16u * (unsigned)d + (choice & 31u) - 8u : value;
        }
        map_row[x] = (uint16_t)value;
    }
}
