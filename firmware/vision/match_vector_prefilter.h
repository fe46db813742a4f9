/*
 * Prefilter of the matcher, eq. (10), in vectors over x.
 *
 * As in the portable one, the unfiltered rows above wait in the room of the
 * columns.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_PREFILTER_H
#define TSR_VISION_MATCH_VECTOR_PREFILTER_H

#include "match_vector.h"

_Static_assert(LANES16 <= TSR_MATCH_DISPARITIES_MIN, "a row has a vector of pixels");

/* sums[x + 1] = above + 2 row + below of column x; the columns at both ends are replicated. */
static void add_vertically(const struct tsr_gray *frame, unsigned y, uint8_t *row_above, int16_t *sums)
{
    unsigned width = frame->width;
    const uint8_t *row = frame->pixels + (size_t)y * frame->stride;
    const uint8_t *above = y > 0 ? row_above : row;
    const uint8_t *below = y + 1u < frame->height ? row + frame->stride : row;
    for (unsigned i = 0; i < width; i += LANES16) {
        unsigned x = i + LANES16 <= width ? i : width - LANES16; /* the last vector ends with the row */
        vec16 twice = SHIFT_LEFT16(load_wide(row + x), 1);
        store16_anywhere(sums + 1u + x, add16(twice, add16(load_wide(above + x), load_wide(below + x))));
    }
    memcpy(row_above, row, width);
    sums[0] = sums[1];
    sums[width + 1u] = sums[width];
}

/* Derivatives of LANES16 columns, rounded, clipped and made positive. */
INLINE vec16 clip_derivatives(const int16_t *sums, vec16 cap)
{
    vec16 twice_apart = subtract16(load16_anywhere(sums + 2), load16_anywhere(sums));
    vec16 quarter = SHIFT_RIGHT16(add16(twice_apart, splat16(2)), 2);
    return add16(min16(max16(quarter, subtract16(splat16(0), cap)), cap), cap);
}

static void filter_row(const struct tsr_gray *frame, unsigned y, uint8_t *row_above, int cap, bool mirrored)
{
    int16_t sums[PIXELS_MAX + 2u];
    uint8_t filtered[PIXELS_MAX];
    add_vertically(frame, y, row_above, sums);
    vec16 caps = splat16((int16_t)cap);
    uint8_t *ends = filtered + PIXELS_MAX; /* the mirrored row ends the buffer */
    for (unsigned x = 0; x < frame->width; x += VECTOR_LEN) {
        vec8 pixels = narrow(clip_derivatives(sums + x, caps), clip_derivatives(sums + x + LANES16, caps));
        if (mirrored) {
            store8(ends - x - VECTOR_LEN, reverse8(pixels));
        } else {
            store8(filtered + x, pixels);
        }
    }
    memcpy(frame->pixels + (size_t)y * frame->stride, mirrored ? ends - frame->width : filtered, frame->width);
}

static void prefilter_row(const struct tsr_match *match, unsigned y)
{
    uint8_t *left_above = tsr_match_share_scratch(match).columns;
    uint8_t *right_above = left_above + match->config.width;
    filter_row(&match->left, y, left_above, match->config.prefilter_cap, false);
    if (match->config.right_is_prefiltered) {
        tsr_match_take_filtered_row(match, y);
    } else {
        filter_row(&match->right, y, right_above, match->config.prefilter_cap, true);
    }
}

#endif
