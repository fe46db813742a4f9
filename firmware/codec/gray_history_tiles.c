/*
 * Which tiles of a fresh gray image differ from the held one by more than noise.
 *
 * A difference of two captures with noise of one gray level has a deviation of 1.4;
 * 1 is taken off every difference, as of views, so that what moved outweighs what all
 * pixels of a tile tremble. tsr_view_choose learns the rest from the tiles' median.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray_history.h"

#define EXCESS_MAX 255u
#define TILE_PIXELS (TSR_VIEW_TILE_PX * TSR_VIEW_TILE_PX)
#define LEANING 2 /* a tile leans if its mean changes by half a level or more: 2.8 deviations of that noise */

static unsigned rest_of(unsigned side, unsigned from)
{
    return side - from < TSR_VIEW_TILE_PX ? side - from : TSR_VIEW_TILE_PX;
}

/* The tile at (x, y), of which pixels holds rows y and on. */
static void measure_tile(const struct tsr_gray_held *held, const uint8_t *pixels, size_t stride, unsigned x, unsigned y,
                         uint8_t *excess, struct tsr_view_change *change)
{
    const unsigned width = rest_of(held->width, x), height = rest_of(held->height, y), count = width * height;
    unsigned beyond = 0;
    int growth = 0;
    for (unsigned i = 0; i < height; i++) {
        const uint8_t *fresh = pixels + i * stride + x, *before = held->pixels + (size_t)(y + i) * held->width + x;
        for (unsigned j = 0; j < width; j++) {
            const int difference = fresh[j] - before[j], size = difference < 0 ? -difference : difference;
            growth += difference;
            beyond += size > 0 ? (unsigned)size - 1u : 0u;
        }
    }
    if (count > 0 && count < TILE_PIXELS) {
        beyond = beyond * TILE_PIXELS / count;
    }
    *excess = (uint8_t)(beyond < EXCESS_MAX ? beyond : EXCESS_MAX);
    /* One that does not lean counts on both sides: an object's tiles alone do not outweigh what stays. */
    change->stronger = (uint16_t)(change->stronger + (LEANING * growth > -(int)count ? 1u : 0u));
    change->weaker = (uint16_t)(change->weaker + (LEANING * growth < (int)count ? 1u : 0u));
}

enum tsr_status tsr_gray_history_compare(const struct tsr_gray_held *held, const uint8_t *rows, size_t stride,
                                         uint16_t first_row, uint16_t row_count, struct tsr_view_change *change)
{
    if (held == NULL || held->pixels == NULL || !held->full || rows == NULL || change == NULL ||
        change->tiles == NULL) {
        return TSR_ERR_ARG;
    }
    const unsigned end = (unsigned)first_row + row_count;
    if (stride < held->width || end > held->height || first_row % TSR_VIEW_TILE_PX != 0 ||
        (end % TSR_VIEW_TILE_PX != 0 && end != held->height)) {
        return TSR_ERR_SIZE;
    }
    if (change->tiles_cap < TSR_VIEW_TILE_COUNT(held->width, held->height)) {
        return TSR_ERR_NOBUF;
    }
    if (first_row == 0) {
        change->stronger = 0;
        change->weaker = 0;
    }
    uint8_t *excess = change->tiles + first_row / TSR_VIEW_TILE_PX * TSR_VIEW_TILES_ACROSS(held->width);
    for (unsigned y = first_row; y < end; y += TSR_VIEW_TILE_PX) {
        for (unsigned x = 0; x < held->width; x += TSR_VIEW_TILE_PX) {
            measure_tile(held, rows + (y - first_row) * stride, stride, x, y, excess++, change);
        }
    }
    return TSR_OK;
}
