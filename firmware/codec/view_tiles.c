/*
 * Which tiles of a fresh view differ from the held one by more than noise.
 *
 * A derivative of noise of one gray level has a deviation of .87, a difference of
 * two 1.2, so 1 is taken off every difference and the rest added up over the tile:
 * an edge that moved outweighs what all pixels of a tile tremble.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/view.h"

#define THRESHOLD_MIN 20u
#define THRESHOLD_MAX 120u
#define MEDIANS 3u
#define EXCESS_MAX 255u
#define LEANING_MIN 32u
#define TILE_PIXELS (TSR_VIEW_TILE_PX * TSR_VIEW_TILE_PX)

/* |v| as it is decoded, of an exact and of a coarse view. */
static const uint8_t decoded_of[2][TSR_VIEW_CAP_MAX + 1] = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 2, 4, 4, 7, 7}};

struct tile {
    unsigned excess;
    int contrast; /* above that of the held one */
};

/* Add a row of a tile, columns x .. end - 1. */
static void add_row(struct tile *tile, const struct tsr_view_info *info, const uint8_t *pixels, const uint8_t *packed,
                    unsigned x, unsigned end)
{
    const int cap = info->cap;
    const uint8_t *decoded = decoded_of[info->coarse ? 1 : 0];
    for (; x < end; x++) {
        const int held = (int)((unsigned)packed[x / 2u] >> 4u * (x % 2u) & 15u) - cap;
        const int fresh = (pixels[x] < 2 * cap ? pixels[x] : 2 * cap) - cap;
        const int difference = fresh > held ? fresh - held : held - fresh;
        const int magnitude = fresh < 0 ? -fresh : fresh;
        tile->excess += difference > 0 ? (unsigned)difference - 1u : 0u;
        tile->contrast += decoded[magnitude] - (held < 0 ? -held : held);
    }
}

static unsigned rest_of(unsigned side, unsigned from)
{
    return side - from < TSR_VIEW_TILE_PX ? side - from : TSR_VIEW_TILE_PX;
}

/* The tile at (x, y), of which pixels holds rows y and on. */
static void measure_tile(const struct tsr_view_held *held, const uint8_t *pixels, size_t stride, unsigned x, unsigned y,
                         uint8_t *excess, struct tsr_view_change *change)
{
    const size_t packed_stride = ((size_t)held->info.width + 1u) / 2u;
    const uint8_t *packed = held->packed + y * packed_stride;
    const unsigned width = rest_of(held->info.width, x), height = rest_of(held->info.height, y);
    const unsigned count = width * height;
    struct tile tile = {0, 0};
    for (unsigned i = 0; i < height; i++) {
        add_row(&tile, &held->info, pixels + i * stride, packed + i * packed_stride, x, x + width);
    }
    if (count > 0 && count < TILE_PIXELS) {
        tile.excess = tile.excess * TILE_PIXELS / count;
    }
    *excess = (uint8_t)(tile.excess < EXCESS_MAX ? tile.excess : EXCESS_MAX);
    change->stronger = (uint16_t)(change->stronger + (tile.contrast > 0 ? 1u : 0u));
    change->weaker = (uint16_t)(change->weaker + (tile.contrast < 0 ? 1u : 0u));
}

enum tsr_status tsr_view_compare(const struct tsr_view_held *held, const uint8_t *rows, size_t stride,
                                 uint16_t first_row, uint16_t row_count, struct tsr_view_change *change)
{
    if (held == NULL || held->packed == NULL || !held->full || rows == NULL || change == NULL ||
        change->tiles == NULL) {
        return TSR_ERR_ARG;
    }
    const unsigned width = held->info.width, height = held->info.height;
    const unsigned end = (unsigned)first_row + row_count;
    if (stride < width || end > height || first_row % TSR_VIEW_TILE_PX != 0 ||
        (end % TSR_VIEW_TILE_PX != 0 && end != height)) {
        return TSR_ERR_SIZE;
    }
    if (change->tiles_cap < TSR_VIEW_TILE_COUNT(width, height)) {
        return TSR_ERR_NOBUF;
    }
    if (first_row == 0) {
        change->stronger = 0;
        change->weaker = 0;
    }
    uint8_t *excess = change->tiles + first_row / TSR_VIEW_TILE_PX * TSR_VIEW_TILES_ACROSS(width);
    for (unsigned y = first_row; y < end; y += TSR_VIEW_TILE_PX) {
        for (unsigned x = 0; x < width; x += TSR_VIEW_TILE_PX) {
            measure_tile(held, rows + (y - first_row) * stride, stride, x, y, excess++, change);
        }
    }
    return TSR_OK;
}

/* The least value that half of the tiles do not exceed, its bits from the top. */
static unsigned find_median(const uint8_t *tiles, size_t count)
{
    unsigned median = 0;
    for (unsigned bit = 128; bit > 0; bit /= 2u) {
        size_t below = 0;
        for (size_t i = 0; i < count; i++) {
            below += tiles[i] < median + bit ? 1u : 0u;
        }
        median += 2u * below < count ? bit : 0u;
    }
    return median;
}

/* More than two thirds of the tiles whose contrast differs lean to one side. */
static bool light_has_changed(const struct tsr_view_change *change)
{
    const unsigned all = (unsigned)change->stronger + change->weaker;
    const unsigned most = change->stronger > change->weaker ? change->stronger : change->weaker;
    return all >= LEANING_MIN && 3u * most > 2u * all;
}

size_t tsr_view_choose(struct tsr_view_change *change, size_t count, uint8_t threshold)
{
    if (change == NULL || change->tiles == NULL) {
        return 0;
    }
    uint8_t *tiles = change->tiles;
    unsigned limit = threshold;
    if (limit == 0) {
        limit = MEDIANS * find_median(tiles, count);
        limit = limit < THRESHOLD_MIN ? THRESHOLD_MIN : limit > THRESHOLD_MAX ? THRESHOLD_MAX : limit;
    }
    const bool all = light_has_changed(change);
    size_t coded = 0;
    for (size_t i = 0; i < count; i++) {
        tiles[i] = all || tiles[i] > limit ? 1u : 0u;
        coded += tiles[i];
    }
    return coded;
}
