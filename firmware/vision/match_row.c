/*
 * One row of the map from column sums: window sums, the test of texture (in the
 * SAD modes), and each pixel's choice.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_stages.h"

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

void tsr_match_finish_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned disparities = config->disparities;
    unsigned last = config->width - 1u;
    unsigned radius = config->window / 2u;
    bool tests_texture = config->mode != TSR_MATCH_CENSUS && config->texture_min != TSR_MATCH_TEST_OFF;
    unsigned texture = begin_sums(&scratch, disparities, radius);
    tsr_match_begin_choice(match);
    for (unsigned x = 0; x <= last; x++) {
        unsigned enter = x + radius < last ? x + radius : last;
        unsigned leave = x > radius ? x - radius - 1u : 0u;
        move_sums(scratch.sums, scratch.columns + (size_t)enter * disparities,
                  scratch.columns + (size_t)leave * disparities, disparities);
        texture = texture + scratch.texture[enter] - scratch.texture[leave];
        bool textured = texture >= (unsigned)config->texture_min * config->window; /* eq. (13) */
        tsr_match_choose(match, x, textured || !tests_texture);
    }
    tsr_match_write_row(match, y);
}
