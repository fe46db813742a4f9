/*
 * Restoring a decoded map, docs/math.md, 4.7.
 *
 * The 25 neighbours are taken one offset at a time over a whole row, without branches, so that a compiler can do
 * several pixels at once; sums are relative to the pixel's own decoded value and fit 16 bits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map_restore.h"

#include <stdbool.h>
#include <string.h>

#define ITERATIONS 8u /* even: the last one writes the map */
#define RADIUS 2
#define NEIGHBOURS_MAX ((2u * RADIUS + 1u) * (2u * RADIUS + 1u))
#define FINE 16u /* inside, px are UQ8.8: so many parts of a sixteenth */
/* A joined neighbour is at most a step off, and within half a step of its own decoded value. */
#define STEP_MAX (1u << TSR_MAP_STEP_LOG2_MAX)
#define OFFSET (FINE * (STEP_MAX + STEP_MAX / 2u)) /* makes no term negative */

_Static_assert(ITERATIONS % 2u == 0, "the last iteration writes the map");
_Static_assert(NEIGHBOURS_MAX * 2u * OFFSET <= UINT16_MAX, "sums fit 16 bits");
_Static_assert(FINE <= UINT16_MAX / TSR_DISPARITY_ONE_Q4 / TSR_DISPARITY_COUNT_MAX, "px fit UQ8.8");

struct restore {
    const uint16_t *decoded;
    uint16_t *sums; /* of a row: joined neighbours relative to FINE * decoded - OFFSET */
    uint16_t *counts;
    unsigned width;
    unsigned height;
    unsigned step;
    unsigned below; /* how far under and over its decoded value a pixel may lie, sixteenths */
    unsigned above;
};

static bool is_info_valid(const struct tsr_map_info *info)
{
    return info->width != 0 && info->width <= TSR_IMAGE_WIDTH_MAX && info->height != 0 &&
           info->height <= TSR_IMAGE_HEIGHT_MAX && info->disparities != 0 &&
           info->disparities <= TSR_DISPARITY_COUNT_MAX && info->step_log2 <= TSR_MAP_STEP_LOG2_MAX &&
           info->near <= TSR_MAP_NEAR_MAX;
}

static bool is_decoded(const struct tsr_map_info *info, const uint16_t *map, size_t count)
{
    const unsigned end = TSR_DISPARITY_ONE_Q4 * info->disparities;
    const unsigned within_step = (1u << info->step_log2) - 1u;
    for (size_t i = 0; i < count; i++) {
        if (map[i] != TSR_DISPARITY_INVALID && (map[i] >= end || (map[i] & within_step) != 0)) {
            return false;
        }
    }
    return true;
}

/* Add one neighbour of each of count pixels: other and fine are its decoded and its present value. */
static void add_neighbour(const uint16_t *restrict own, const uint16_t *restrict other, const uint16_t *restrict fine,
                          uint16_t *restrict sums, uint16_t *restrict counts, unsigned count, uint16_t step)
{
    for (unsigned i = 0; i < count; i++) {
        const uint16_t apart = (uint16_t)(other[i] - own[i] + step); /* 0 .. 2 step: joined */
        const uint16_t joined = (uint16_t)((apart <= 2u * step) & (other[i] != TSR_DISPARITY_INVALID));
        const uint16_t term = (uint16_t)(fine[i] - FINE * own[i] + OFFSET);
        sums[i] = (uint16_t)(sums[i] + (joined ? term : 0u));
        counts[i] = (uint16_t)(counts[i] + joined);
    }
}

static void add_row(const struct restore *restore, const uint16_t *fine, unsigned y, unsigned other_y)
{
    const uint16_t *own = restore->decoded + (size_t)y * restore->width;
    const uint16_t *other = restore->decoded + (size_t)other_y * restore->width;
    fine += (size_t)other_y * restore->width;
    for (unsigned shift = 0; shift <= RADIUS && shift < restore->width; shift++) {
        const unsigned count = restore->width - shift;
        add_neighbour(own, other + shift, fine + shift, restore->sums, restore->counts, count, (uint16_t)restore->step);
        if (shift > 0) {
            add_neighbour(own + shift, other, fine, restore->sums + shift, restore->counts + shift, count,
                          (uint16_t)restore->step);
        }
    }
}

/* Eq. (93): the mean, limited to what the decoded value allows. */
static uint16_t limited_mean(const struct restore *restore, unsigned decoded, unsigned sum, unsigned count)
{
    const unsigned least = FINE * (decoded > restore->below ? decoded - restore->below : 0u);
    const unsigned most = FINE * (decoded + restore->above);
    const unsigned mean = FINE * decoded + (2u * sum + count) / (2u * count); /* plus OFFSET */
    const unsigned value = mean < least + OFFSET ? least : mean - OFFSET;
    return (uint16_t)(value < most ? value : most);
}

static void smooth_row(const struct restore *restore, const uint16_t *from, uint16_t *to, unsigned y)
{
    memset(restore->sums, 0, restore->width * sizeof *restore->sums);
    memset(restore->counts, 0, restore->width * sizeof *restore->counts);
    const unsigned first = y > RADIUS ? y - RADIUS : 0u;
    for (unsigned other_y = first; other_y <= y + RADIUS && other_y < restore->height; other_y++) {
        add_row(restore, from, y, other_y);
    }
    const uint16_t *decoded = restore->decoded + (size_t)y * restore->width;
    to += (size_t)y * restore->width;
    for (unsigned x = 0; x < restore->width; x++) {
        to[x] = decoded[x] == TSR_DISPARITY_INVALID
                    ? TSR_DISPARITY_INVALID
                    : limited_mean(restore, decoded[x], restore->sums[x], restore->counts[x]);
    }
}

/* Eq. (92): the middle of the values that a pixel may have, but for 0, which a matcher gives exactly. */
static void start(const struct restore *restore, uint16_t *map, size_t count)
{
    const unsigned lower = (restore->below - restore->above) * FINE / 2u;
    for (size_t i = 0; i < count; i++) {
        const unsigned value = FINE * map[i];
        map[i] =
            map[i] == TSR_DISPARITY_INVALID ? TSR_DISPARITY_INVALID : (uint16_t)(value > lower ? value - lower : 0u);
    }
}

static void smooth(const struct restore *restore, uint16_t *map, uint16_t *second)
{
    uint16_t *from = map;
    uint16_t *to = second;
    for (unsigned i = 0; i < ITERATIONS; i++) {
        for (unsigned y = 0; y < restore->height; y++) {
            smooth_row(restore, from, to, y);
        }
        uint16_t *written = to;
        to = from;
        from = written;
    }
}

enum tsr_status tsr_map_restore(const struct tsr_map_info *info, uint16_t *map, size_t map_cap, uint16_t *scratch,
                                size_t scratch_cap)
{
    if (info == NULL || map == NULL || scratch == NULL || !is_info_valid(info)) {
        return TSR_ERR_ARG;
    }
    const size_t count = (size_t)info->width * info->height;
    if (map_cap < count || scratch_cap < TSR_MAP_RESTORE_SCRATCH_COUNT(info->width, info->height)) {
        return TSR_ERR_NOBUF;
    }
    if (!is_decoded(info, map, count)) {
        return TSR_ERR_ARG;
    }
    const unsigned step = 1u << info->step_log2;
    uint16_t *second = scratch + count;
    const struct restore restore = {
        .decoded = scratch,
        .sums = second + count,
        .counts = second + count + info->width,
        .width = info->width,
        .height = info->height,
        .step = step,
        .below = step / 2u,
        .above = (step - 1u) / 2u,
    };
    memcpy(scratch, map, count * sizeof *map);
    start(&restore, map, count);
    smooth(&restore, map, second);
    for (size_t i = 0; i < count; i++) {
        map[i] = map[i] == TSR_DISPARITY_INVALID ? TSR_DISPARITY_INVALID : (uint16_t)((map[i] + FINE / 2u) / FINE);
    }
    return TSR_OK;
}
