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
#define TILE_PIXELS (TSR_VIEW_TILE_PX * TSR_VIEW_TILE_PX)

/* Of one tile at column x: width and height are what of it lies in the view. */
static uint8_t measure_tile(const uint8_t *pixels, size_t stride, const uint8_t *packed, size_t packed_stride,
                            unsigned x, unsigned width, unsigned height)
{
    unsigned sum = 0;
    for (unsigned y = 0; y < height; y++) {
        for (unsigned i = x; i < x + width; i++) {
            const unsigned held = packed[i / 2u] >> 4u * (i % 2u) & 15u;
            const unsigned fresh = pixels[i];
            const unsigned difference = fresh > held ? fresh - held : held - fresh;
            sum += difference > 0 ? difference - 1u : 0u;
        }
        pixels += stride;
        packed += packed_stride;
    }
    const unsigned count = width * height;
    if (count > 0 && count < TILE_PIXELS) {
        sum = sum * TILE_PIXELS / count;
    }
    return (uint8_t)(sum < EXCESS_MAX ? sum : EXCESS_MAX);
}

static unsigned rest_of(unsigned side, unsigned from)
{
    return side - from < TSR_VIEW_TILE_PX ? side - from : TSR_VIEW_TILE_PX;
}

enum tsr_status tsr_view_compare(const struct tsr_view_held *held, const uint8_t *rows, size_t stride,
                                 uint16_t first_row, uint16_t row_count, uint8_t *tiles, size_t tiles_cap)
{
    if (held == NULL || held->packed == NULL || !held->full || rows == NULL || tiles == NULL) {
        return TSR_ERR_ARG;
    }
    const unsigned width = held->info.width, height = held->info.height;
    const unsigned end = (unsigned)first_row + row_count;
    if (stride < width || end > height || first_row % TSR_VIEW_TILE_PX != 0 ||
        (end % TSR_VIEW_TILE_PX != 0 && end != height)) {
        return TSR_ERR_SIZE;
    }
    if (tiles_cap < TSR_VIEW_TILE_COUNT(width, height)) {
        return TSR_ERR_NOBUF;
    }
    const size_t packed_stride = ((size_t)width + 1u) / 2u;
    uint8_t *tile = tiles + first_row / TSR_VIEW_TILE_PX * TSR_VIEW_TILES_ACROSS(width);
    for (unsigned y = first_row; y < end; y += TSR_VIEW_TILE_PX) {
        for (unsigned x = 0; x < width; x += TSR_VIEW_TILE_PX) {
            *tile++ = measure_tile(rows + (y - first_row) * stride, stride, held->packed + y * packed_stride,
                                   packed_stride, x, rest_of(width, x), rest_of(height, y));
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

size_t tsr_view_choose(uint8_t *tiles, size_t count, uint8_t threshold)
{
    if (tiles == NULL) {
        return 0;
    }
    unsigned limit = threshold;
    if (limit == 0) {
        limit = MEDIANS * find_median(tiles, count);
        limit = limit < THRESHOLD_MIN ? THRESHOLD_MIN : limit > THRESHOLD_MAX ? THRESHOLD_MAX : limit;
    }
    size_t coded = 0;
    for (size_t i = 0; i < count; i++) {
        tiles[i] = tiles[i] > limit ? 1u : 0u;
        coded += tiles[i];
    }
    return coded;
}
