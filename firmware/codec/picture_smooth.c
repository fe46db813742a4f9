/*
 * The decoder's filter: each pixel gives in to its four neighbours, within a
 * limit that follows the quantiser and is wider where a block ends.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "picture_block.h"

static int within(int value, int limit)
{
    return value < -limit ? -limit : value > limit ? limit : value;
}

void tsr_picture_smooth_line(const struct tsr_picture_line *line, uint8_t *out)
{
    const uint8_t *const here = line->here;
    const unsigned last = line->count - 1u;
    const int inside = line->limit, across = 4 * inside;
    const int limit_above = line->y == 0 ? across : inside;
    const int limit_below = line->y == TSR_PICTURE_BLOCK - 1u ? across : inside;
    /* A pixel stands for its neighbours that are not there: it does not pull itself. */
    int left = line->has_left ? here[-1] : here[0];
    for (unsigned x = 0; x <= last; x++) {
        const int pixel = here[x], right = x < last || line->has_right ? here[x + 1u] : pixel;
        /* Each pulls by a quarter of the difference, in 1/8, within its limit. */
        const int sum = within(2 * (left - pixel), x == 0 ? across : inside) +
                        within(2 * (right - pixel), x == TSR_PICTURE_BLOCK - 1u ? across : inside) +
                        within(2 * (line->above[x] - pixel), limit_above) +
                        within(2 * (line->below[x] - pixel), limit_below);
        /* The pulls' weights sum to 1 at most, so this lies between the five pixels. */
        out[x] = (uint8_t)(pixel + ((sum + 4) >> 3));
        left = pixel;
    }
}

void tsr_picture_smooth_row(const struct tsr_picture_model *model, unsigned y, uint8_t *out)
{
    const struct tsr_picture_rows rows = tsr_picture_rows_of(model);
    /* model->band is the next one: its predecessor's limits are the "above" ones. Row 2 of the scratch is its first. */
    const unsigned first = TSR_PICTURE_BLOCK * (model->band - 1u);
    const uint8_t *const limits = y >= first ? rows.limits_above : rows.limits;
    const uint8_t *const here = rows.pixels + (size_t)(y + 2u - first) * rows.stride;
    const uint8_t *const above = y > 0 ? here - rows.stride : here;
    const uint8_t *const below = y + 1u < model->info.height ? here + rows.stride : here;
    const unsigned width = model->info.width;
    for (unsigned x = 0; x < width; x += TSR_PICTURE_BLOCK) {
        const unsigned left = width - x;
        const struct tsr_picture_line line = {
            .here = here + x,
            .above = above + x,
            .below = below + x,
            .has_left = x > 0,
            .has_right = left > TSR_PICTURE_BLOCK,
            .limit = limits[x / TSR_PICTURE_BLOCK],
            .y = (uint8_t)(y % TSR_PICTURE_BLOCK),
            .count = (uint8_t)(left < TSR_PICTURE_BLOCK ? left : TSR_PICTURE_BLOCK),
        };
        tsr_picture_smooth_line(&line, out + x);
    }
}
