/*
 * One row of the map from the column sums: window sums, winner, the tests of
 * texture, uniqueness and left-right consistency, and the sub-pixel offset.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
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

/* sums += the column that enters the window, - the column that leaves it */
static void move_sums(int16_t *restrict sums, const uint8_t *restrict enter, const uint8_t *restrict leave,
                      unsigned disparities)
{
    for (unsigned d = 0; d < disparities; d += TSR_MATCH_LANES) {
        for (unsigned i = 0; i < TSR_MATCH_LANES; i++) {
            sums[d + i] = (int16_t)(sums[d + i] + enter[d + i] - leave[d + i]);
        }
    }
}

/* The window one column left of the image, so that moving it to x = 0 is a
 * step like every other: radius + 2 times column 0, once 1 .. radius - 1. */
static unsigned begin_sums(const struct tsr_match_scratch *scratch, unsigned disparities, unsigned radius)
{
    unsigned texture = (radius + 2u) * scratch->texture[0];
    for (unsigned d = 0; d < disparities; d++) {
        scratch->sums[d] = (int16_t)((radius + 2u) * scratch->columns[d]);
    }
    for (unsigned x = 1; x < radius; x++) {
        for (unsigned d = 0; d < disparities; d++) {
            scratch->sums[d] = (int16_t)(scratch->sums[d] + scratch->columns[x * disparities + d]);
        }
        texture += scratch->texture[x];
    }
    return texture;
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

static void claim_right(const struct tsr_match_scratch *scratch, int right_x, struct tsr_match_winner winner)
{
    uint16_t claim = TSR_MATCH_CLAIM(winner.sum, winner.d);
    if (claim < scratch->claims[right_x]) {
        scratch->claims[right_x] = claim;
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

static uint16_t match_pixel(const struct tsr_match_config *config, const struct tsr_match_scratch *scratch, unsigned x,
                            unsigned texture)
{
    struct offer offer = offer_at(config, x);
    if (offer.lowest > offer.highest) {
        return TSR_MATCH_CHOICE_NONE;
    }
    const int16_t *sums = mask_sums(scratch, config->disparities, offer);
    struct tsr_match_winner winner = tsr_match_find_winner(sums, config->disparities);
    claim_right(scratch, (int)x - config->search_start_px - winner.d, winner);
    bool textured = config->texture_min == TSR_MATCH_TEST_OFF ||
                    texture >= (unsigned)config->texture_min * config->window; /* eq. (13) */
    if (!textured || !is_unique(config, sums, winner)) {
        return TSR_MATCH_CHOICE_NONE;
    }
    return TSR_MATCH_CHOICE(winner.d, find_offset_q4(sums, winner, offer));
}

void tsr_match_finish_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned disparities = config->disparities;
    unsigned last = config->width - 1u;
    unsigned radius = config->window / 2u;
    unsigned texture = begin_sums(&scratch, disparities, radius);
    memset(scratch.claims, 0xff, sizeof(uint16_t) * config->width);
    for (unsigned x = 0; x <= last; x++) {
        unsigned enter = x + radius < last ? x + radius : last;
        unsigned leave = x > radius ? x - radius - 1u : 0u;
        move_sums(scratch.sums, scratch.columns + (size_t)enter * disparities,
                  scratch.columns + (size_t)leave * disparities, disparities);
        texture = texture + scratch.texture[enter] - scratch.texture[leave];
        scratch.choices[x] = match_pixel(config, &scratch, x, texture);
    }
    tsr_match_write_row(match, y);
}
