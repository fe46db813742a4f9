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

void tsr_picture_smooth_row(const struct tsr_picture_model *model, unsigned y, uint8_t *out)
{
    const struct tsr_picture_rows rows = tsr_picture_rows_of(model);
    /* model->band is the next one: its predecessor's limits are the "above" ones. Row 2 of the scratch is its first. */
    const unsigned first = TSR_PICTURE_BLOCK * (model->band - 1u);
    const uint8_t *const limits = y >= first ? rows.limits_above : rows.limits;
    const uint8_t *const here = rows.pixels + (size_t)(y + 2u - first) * rows.stride;
    /* A pixel stands for its neighbours outside the picture: it does not pull itself. */
    const uint8_t *const above = y > 0 ? here - rows.stride : here;
    const uint8_t *const below = y + 1u < model->info.height ? here + rows.stride : here;
    const unsigned width = model->info.width, line = y % TSR_PICTURE_BLOCK;
    int left = here[0];
    for (unsigned x = 0; x < width; x++) {
        const int inside = limits[x / TSR_PICTURE_BLOCK], across = 4 * inside;
        const unsigned column = x % TSR_PICTURE_BLOCK;
        const int pixel = here[x], right = x + 1u < width ? here[x + 1u] : pixel;
        /* Each pulls by a quarter of the difference, in 1/8, within its limit. */
        const int sum = within(2 * (left - pixel), column == 0 ? across : inside) +
                        within(2 * (right - pixel), column == TSR_PICTURE_BLOCK - 1u ? across : inside) +
                        within(2 * (above[x] - pixel), line == 0 ? across : inside) +
                        within(2 * (below[x] - pixel), line == TSR_PICTURE_BLOCK - 1u ? across : inside);
        /* The pulls' weights sum to 1 at most, so this lies between the five pixels. */
        out[x] = (uint8_t)(pixel + ((sum + 4) >> 3));
        left = pixel;
    }
}
