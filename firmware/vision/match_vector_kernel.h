/*
 * The functions of a kernel in vectors, from the pieces.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_KERNEL_H
#define TSR_VISION_MATCH_VECTOR_KERNEL_H

#include "match_vector_choose.h"
#include "match_vector_prefilter.h"
#include "match_vector_sums.h"

INLINE void find_winners_of(const struct row_input *input, unsigned vectors, unsigned percent, struct winners *winners)
{
    struct shape shape = {vectors, false, vectors <= HELD_MAX, least_lanes(vectors)};
    if (input->disparities == vectors * VECTOR_LEN) {
        struct row_input same = *input;
        same.disparities = vectors * VECTOR_LEN;
        find_winners(&same, shape, percent, winners);
    } else {
        shape.excess = true;
        find_winners(input, shape, percent, winners);
    }
}

static void find_winners_for(const struct row_input *input, unsigned percent, struct winners *winners)
{
    switch ((input->disparities + VECTOR_LEN - 1u) / VECTOR_LEN) {
    case 1: find_winners_of(input, 1, percent, winners); break;
    case 2: find_winners_of(input, 2, percent, winners); break;
    case 3: find_winners_of(input, 3, percent, winners); break;
    case 4: find_winners_of(input, 4, percent, winners); break;
#if VECTOR_LEN < 32
    case 5: find_winners_of(input, 5, percent, winners); break;
    case 6: find_winners_of(input, 6, percent, winners); break;
    case 7: find_winners_of(input, 7, percent, winners); break;
    default: find_winners_of(input, 8, percent, winners); break;
#endif
    }
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    const struct tsr_match_config *config = &match->config;
    struct frame_rows rows;
    lay_out_row(match, y_new, rows.left[ENTERS], rows.right[ENTERS]);
    lay_out_row(match, y_old, rows.left[LEAVES], rows.right[LEAVES]);
    struct row_input input = {
        &rows, columns_of(match), config->width, config->disparities, config->window / 2u, config->search_start_px};
    struct winners winners;
    find_winners_for(&input, config->uniqueness_percent, &winners);
    struct verdicts verdicts;
    judge_texture(match, y_new, y_old, &verdicts);
    struct choices choices;
    choose(config, &winners, &verdicts, &choices);
    write_row(match, y, &winners, &choices);
}

/* As the portable one, for texture as well. */
static void warm_up_row(const struct tsr_match *match, unsigned y, unsigned times)
{
    add_row(match, y, times);
    const uint8_t *left = match->left.pixels + (size_t)y * match->left.stride;
    uint8_t *texture = tsr_match_share_scratch(match).texture;
    uint8_t cap = match->config.prefilter_cap;
    for (unsigned x = 0; x < match->config.width; x++) {
        unsigned apart = left[x] > cap ? left[x] - cap : cap - left[x];
        texture[x] = (uint8_t)(texture[x] + times * apart);
    }
}

#endif
