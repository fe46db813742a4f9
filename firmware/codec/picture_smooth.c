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

/* A neighbour's pull, in 1/8: a quarter of the difference, within the limit. */
static int pull(int difference, int limit, bool across)
{
    return within(2 * difference, across ? 4 * limit : limit);
}

void tsr_picture_smooth_row(const struct tsr_picture_model *model, unsigned y, uint8_t *out)
{
    const struct tsr_picture_rows rows = tsr_picture_rows_of(model);
    /* model->band is the next one: its predecessor's limits are the "above" ones. Row 2 of the scratch is its first. */
    const unsigned first = TSR_PICTURE_BLOCK * (model->band - 1u);
    const uint8_t *const limits = y >= first ? rows.limits_above : rows.limits;
    const uint8_t *const here = rows.pixels + (size_t)(y + 2u - first) * rows.stride;
    const unsigned width = model->info.width, last_row = model->info.height - 1u;
    const unsigned in_block = y % TSR_PICTURE_BLOCK;
    for (unsigned x = 0; x < width; x++) {
        const int pixel = here[x], limit = limits[x / TSR_PICTURE_BLOCK];
        const unsigned column = x % TSR_PICTURE_BLOCK;
        int sum = 4;
        if (x > 0) {
            sum += pull(here[x - 1u] - pixel, limit, column == 0);
        }
        if (x + 1u < width) {
            sum += pull(here[x + 1u] - pixel, limit, column == TSR_PICTURE_BLOCK - 1u);
        }
        if (y > 0) {
            sum += pull(*(here + x - rows.stride) - pixel, limit, in_block == 0);
        }
        if (y < last_row) {
            sum += pull(here[x + rows.stride] - pixel, limit, in_block == TSR_PICTURE_BLOCK - 1u);
        }
        /* The pulls' weights sum to 1 at most, so this lies between the five pixels. */
        out[x] = (uint8_t)(pixel + (sum >> 3));
    }
}
