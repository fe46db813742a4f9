/*
 * The matcher's kernels in vectors over disparities, for any instruction set
 * with the operations of vector_sse2.h; a source file includes them first.
 *
 *     match_vector.h            what a row is made from; warm-up rows
 *     match_vector_sums.h       window sums and their least
 *     match_vector_choose.h     tests, offset, and the row of the map
 *     match_vector_prefilter.h
 *     match_vector_kernel.h     the three functions of a kernel
 *
 * A row of the right picture is copied with its ends repeated as far as any lane
 * of any pixel reaches, so that no lane is a special case: eq. (11).
 *
 * A column has D bytes while vectors may end behind it. Columns are moved in
 * ascending order and the first vector of the next one is loaded before this one
 * is stored, so bytes behind a column may be overwritten: those of the last one
 * are what the portable kernel uses for claims.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_H
#define TSR_VISION_MATCH_VECTOR_H

#include <stdbool.h>
#include <string.h>

#include "match_kernels.h"

#define VECTORS_MAX (TSR_DISPARITY_COUNT_MAX / VECTOR_LEN)
#define LANES16 (VECTOR_LEN / 2u)
/* Pixels of a row in whole vectors, with one to spare. */
#define PIXELS_MAX (TSR_IMAGE_WIDTH_MAX + 2u * VECTOR_LEN)
#define LANES_MAX (TSR_IMAGE_WIDTH_MAX + TSR_DISPARITY_COUNT_MAX + VECTOR_LEN)

/* The frame rows that enter and leave, as columns are moved by them. One after the other, so that one pointer finds
 * both. */
enum {
    ENTERS,
    LEAVES
};
struct frame_rows {
    _Alignas(32) uint8_t left[2][PIXELS_MAX];      /* probes, probe_index8() */
    _Alignas(32) uint8_t right[2][2u * LANES_MAX]; /* what lanes meet: ascending with d, descending with x */
};

/* What a row of sums is made from. */
struct row_input {
    const struct frame_rows *rows;
    uint8_t *columns;
    unsigned width;
    unsigned disparities;
    unsigned radius;
    int start;
};

/* What is found out about the pixels of a row, one number each. */
struct winners {
    _Alignas(32) int16_t kept[PIXELS_MAX * KEPT_LANES]; /* as keep_least16() gives it */
    _Alignas(32) int16_t sum[PIXELS_MAX]; /* 16 S, or less than 0 where nothing may be chosen; low bits undefined */
    _Alignas(32) int16_t d[PIXELS_MAX];
    _Alignas(32) int16_t below[PIXELS_MAX]; /* 16 S - 2^15 of d - 1, of d + 1; not negative if not to be chosen */
    _Alignas(32) int16_t above[PIXELS_MAX];
    _Alignas(32) int16_t bound[PIXELS_MAX];                /* what sums are below that eq. (15) counts */
    _Alignas(32) int16_t counts[PIXELS_MAX * KEPT_COUNTS]; /* how many are: as keep_counts16() gives it */
};

/* Columns start at a multiple of VECTOR_LEN: there is room for sums in front of them that vectors do not use. */
INLINE uint8_t *columns_of(const struct tsr_match *match)
{
    uint8_t *columns = tsr_match_share_scratch(match).columns;
    return columns - (uintptr_t)columns % VECTOR_LEN;
}
_Static_assert(4u * TSR_MATCH_DISPARITIES_MIN >= 32u, "room in front of the columns");

/* Whether columns and right pixels lie in pairs of lanes, ready to be widened. */
INLINE bool has_pairs(const struct tsr_match_config *config)
{
    return LANE_PAIR > 1u && config->disparities % VECTOR_LEN == 0;
}

/* The mirrored row from pixel start on, with its ends repeated. */
static void clip_row(const uint8_t *row, unsigned width, int start, uint8_t *clipped, size_t count)
{
    size_t before = start < 0 ? (size_t)-start : 0u;
    size_t from = start < 0 ? 0u : (size_t)start;
    size_t inside = width - from < count - before ? width - from : count - before;
    memset(clipped, row[0], before);
    memcpy(clipped + before, row + from, inside);
    memset(clipped + before + inside, row[width - 1u], count - before - inside);
}

/* One of the frame rows. */
static void lay_out_row(const struct tsr_match *match, unsigned y, uint8_t *left, uint8_t *right)
{
    const struct tsr_match_config *config = &match->config;
    const uint8_t *right_row = match->right.pixels + (size_t)y * match->right.stride;
    memcpy(left, match->left.pixels + (size_t)y * match->left.stride, config->width);
    for (unsigned x = 0; x < config->width; x += VECTOR_LEN) {
        store8(left + x, probe_index8(load8(left + x)));
    }
    size_t count = config->width + config->disparities + VECTOR_LEN;
    if (!has_pairs(config)) {
        clip_row(right_row, config->width, config->search_start_px, right, count);
        return;
    }
    uint8_t clipped[LANES_MAX + LANE_PAIR];
    clip_row(right_row, config->width, config->search_start_px, clipped, count + LANE_PAIR);
    for (size_t i = 0; i < count; i++) {
        right[2u * i] = clipped[i];
        right[2u * i + 1u] = clipped[i + LANE_PAIR];
    }
}

/* Column sums times + one more row. */
static void add_row(const struct tsr_match *match, unsigned y, unsigned times)
{
    const struct tsr_match_config *config = &match->config;
    struct frame_rows rows;
    lay_out_row(match, y, rows.left[ENTERS], rows.right[ENTERS]);
    unsigned step = has_pairs(config) ? 2u : 1u;
    uint8_t *column = columns_of(match);
    vec8 first = load8(column);
    for (unsigned x = 0; x < config->width; x++) {
        const uint8_t *right = rows.right[ENTERS] + (config->width - 1u - x) * step;
        vec8 probe = probe4(rows.left[ENTERS][x]);
        vec8 next = load8(column + config->disparities);
        for (unsigned d = 0; d < config->disparities; d += VECTOR_LEN) {
            vec8 sums = d == 0 ? first : load8(column + d);
            vec8 added = probe_difference4(probe, load8(right + d * step));
            for (unsigned i = 0; i < times; i++) {
                sums = add8(sums, added);
            }
            store8(column + d, sums);
        }
        first = next;
        column += config->disparities;
    }
}

#endif
