/*
 * Prefilter of the matcher: the clipped horizontal Sobel derivative, in place.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_stages.h"
#include "prefilter_row.h"

void tsr_match_take_filtered_row(const struct tsr_match *match, unsigned y)
{
    uint8_t *first = match->right.pixels + (size_t)y * match->right.stride;
    uint8_t *last = first + (match->config.width - 1u);
    uint8_t max = (uint8_t)(2u * match->config.prefilter_cap);
    for (; first <= last; first++, last--) {
        uint8_t left = *first < max ? *first : max;
        *first = *last < max ? *last : max;
        *last = left;
    }
}

void tsr_match_prefilter_row(const struct tsr_match *match, unsigned y)
{
    unsigned width = match->config.width;
    int cap = match->config.prefilter_cap;
    uint8_t *left_above = tsr_match_share_scratch(match).columns;
    uint8_t *right_above = left_above + width;
    uint16_t *sums = (uint16_t *)(void *)(right_above + width);

    tsr_prefilter_row(&match->left, y, cap, false, left_above, sums);
    if (match->config.right_is_prefiltered) {
        tsr_match_take_filtered_row(match, y);
    } else {
        tsr_prefilter_row(&match->right, y, cap, true, right_above, sums);
    }
}
