/*
 * Census descriptors in vectors over x, and their distances in vectors over d.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_CENSUS_H
#define TSR_VISION_MATCH_VECTOR_CENSUS_H

#include "match_vector.h"

#define CENSUS_REACH 2 /* rows and columns around the pixel */
#define CENSUS_ROWS (2 * CENSUS_REACH + 1)

/* Rows of a frame with copies of their ends on both sides, and room for a vector behind. */
struct census_rows {
    uint8_t at[CENSUS_ROWS][CENSUS_REACH + PIXELS_MAX + VECTOR_LEN];
};

/* Rows y - 2 .. y + 2, or the nearest inside. */
static void gather_rows(const struct tsr_gray *frame, unsigned y, struct census_rows *rows)
{
    for (int i = 0; i < CENSUS_ROWS; i++) {
        int row = (int)y + i - CENSUS_REACH;
        row = row < 0 ? 0 : row < frame->height ? row : frame->height - 1;
        const uint8_t *pixels = frame->pixels + (size_t)frame->stride * (unsigned)row;
        uint8_t *padded = rows->at[i];
        memset(padded, pixels[0], CENSUS_REACH);
        memcpy(padded + CENSUS_REACH, pixels, frame->width);
        memset(padded + CENSUS_REACH + frame->width, pixels[frame->width - 1u], CENSUS_REACH);
    }
}

/* Bits of the neighbours that do not exceed the centre: the complement of eq. (40), which has the same distances. */
INLINE vec8 describe8(const struct census_rows *rows, unsigned x, const int8_t neighbours[8][2])
{
    vec8 centre = load8(rows->at[CENSUS_REACH] + CENSUS_REACH + x);
    vec8 bits = splat8(0);
    for (unsigned i = 0; i < 8; i++) {
        vec8 value = load8(rows->at[CENSUS_REACH + neighbours[i][1]] + CENSUS_REACH + (int)x + neighbours[i][0]);
        bits = subtract8(add8(bits, bits), at_most8(value, centre));
    }
    return bits;
}

/* Both planes of a row of width pixels, and anything up to the next vector. */
static void describe_frame(const struct tsr_gray *frame, unsigned y, uint8_t planes[2][PIXELS_MAX])
{
    static const int8_t cross[8][2] = {{0, -2}, {0, -1}, {-2, 0}, {-1, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}};
    static const int8_t knight[8][2] = {{-1, -2}, {1, -2}, {-2, -1}, {2, -1}, {-2, 1}, {2, 1}, {-1, 2}, {1, 2}};
    struct census_rows rows;
    gather_rows(frame, y, &rows);
    for (unsigned x = 0; x < frame->width; x += VECTOR_LEN) {
        store8(planes[0] + x, describe8(&rows, x, cross));
        store8(planes[1] + x, describe8(&rows, x, knight));
    }
}

static void describe_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    unsigned width = config->width;
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    uint8_t described[2][PIXELS_MAX];
    describe_frame(&match->left, y, described);
    for (unsigned i = 0; i < TSR_MATCH_CENSUS_PLANES; i++) {
        memcpy(planes.left[i], described[i], width);
    }
    describe_frame(&match->right, y, described);
    for (unsigned i = 0; i < TSR_MATCH_CENSUS_PLANES; i++) {
        uint8_t mirrored[PIXELS_MAX];
        for (unsigned x = 0; x < width; x++) {
            mirrored[x] = described[i][width - 1u - x];
        }
        clip_row(mirrored, width, config->search_start_px, planes.right[i], width + config->disparities);
    }
}

/* The planes of a row, with room for a vector behind. */
struct census_lanes {
    const uint8_t *left[TSR_MATCH_CENSUS_PLANES];
    uint8_t right[TSR_MATCH_CENSUS_PLANES][LANES_MAX];
};

static void lay_out_planes(const struct tsr_match *match, unsigned y, struct census_lanes *lanes)
{
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    for (unsigned i = 0; i < TSR_MATCH_CENSUS_PLANES; i++) {
        lanes->left[i] = planes.left[i];
        memcpy(lanes->right[i], planes.right[i], (size_t)match->config.width + match->config.disparities);
    }
}

/* Eq. (41): lanes from .. from + VECTOR_LEN - 1 of what column x, mirrored, meets. */
INLINE vec8 distances8(const struct census_lanes *lanes, const vec8 left[2], size_t from)
{
    vec8 cross = count_bits8(xor8(left[0], load8(lanes->right[0] + from)));
    return add8(cross, count_bits8(xor8(left[1], load8(lanes->right[1] + from))));
}

/* The first count bytes of a vector. */
INLINE void store_first8(uint8_t *at, vec8 a, unsigned count)
{
    uint8_t whole[VECTOR_LEN];
    store8(whole, a);
    memcpy(at, whole, count);
}

INLINE void store_lanes8(uint8_t *at, vec8 a, unsigned left)
{
    if (left >= VECTOR_LEN) {
        store8(at, a);
    } else {
        store_first8(at, a, left);
    }
}

static void cost_row(const struct tsr_match *match, unsigned y)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *costs = tsr_match_costs_at(match, y);
    struct census_lanes lanes;
    lay_out_planes(match, y, &lanes);
    for (unsigned x = 0; x < width; x++) {
        const vec8 left[2] = {splat8(lanes.left[0][x]), splat8(lanes.left[1][x])};
        for (unsigned d = 0; d < disparities; d += VECTOR_LEN) {
            store_lanes8(costs + d, distances8(&lanes, left, width - 1u - x + d), disparities - d);
        }
        costs += disparities;
    }
}

static void add_census(const struct tsr_match *match, unsigned y, unsigned times)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *column = tsr_match_share_scratch(match).columns;
    struct census_lanes lanes;
    lay_out_planes(match, y, &lanes);
    for (unsigned x = 0; x < width; x++) {
        const vec8 left[2] = {splat8(lanes.left[0][x]), splat8(lanes.left[1][x])};
        for (unsigned d = 0; d < disparities; d += VECTOR_LEN) {
            vec8 sums = load8(column + d);
            vec8 costs = distances8(&lanes, left, width - 1u - x + d);
            for (unsigned i = 0; i < times; i++) {
                sums = add8(sums, costs);
            }
            store_lanes8(column + d, sums, disparities - d);
        }
        column += disparities;
    }
}

/* Columns in vectors, the window and the choice as the portable kernel has them: sums take all 16 bits. */
static void census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *column = tsr_match_share_scratch(match).columns;
    struct census_lanes enter;
    struct census_lanes leave;
    lay_out_planes(match, y_new, &enter);
    lay_out_planes(match, y_old, &leave);
    for (unsigned x = 0; x < width; x++) {
        const vec8 left_new[2] = {splat8(enter.left[0][x]), splat8(enter.left[1][x])};
        const vec8 left_old[2] = {splat8(leave.left[0][x]), splat8(leave.left[1][x])};
        for (unsigned d = 0; d < disparities; d += VECTOR_LEN) {
            vec8 added = distances8(&enter, left_new, width - 1u - x + d);
            vec8 taken = distances8(&leave, left_old, width - 1u - x + d);
            store_lanes8(column + d, subtract8(add8(load8(column + d), added), taken), disparities - d);
        }
        column += disparities;
    }
    tsr_match_finish_row(match, y);
}

#endif
