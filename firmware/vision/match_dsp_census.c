/*
 * Census descriptors and their Hamming distances with the DSP extension, four
 * pixels or four disparities in a word.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include <string.h>

#include "match_dsp.h"

#define REACH 2 /* rows and columns around the pixel */
#define ROWS (2 * REACH + 1)
#define ONES UINT32_C(0x01010101)

/* Twice acc, plus 1 in each byte where neighbours > centre. */
static inline uint32_t compare(uint32_t acc, uint32_t neighbours, uint32_t centre)
{
    uint32_t bit;
    __asm("usub8 %0, %1, %2\n\tsel %0, %3, %4" : "=&r"(bit) : "r"(centre), "r"(neighbours), "r"(0), "r"(ONES));
    return acc << 1 | bit;
}

/* Both planes of the four pixels from x on: docs/math.md, eq. (40). Which bit is whose does not matter. */
static inline void describe(const uint8_t *const rows[ROWS], unsigned x, uint32_t planes[TSR_MATCH_CENSUS_PLANES])
{
    const uint8_t *const row = rows[REACH] + x;
    uint32_t centre = tsr_dsp_load(row);
    uint32_t cross = compare(0, tsr_dsp_load(rows[0] + x), centre);
    cross = compare(cross, tsr_dsp_load(rows[1] + x), centre);
    cross = compare(cross, tsr_dsp_load(row - 2), centre);
    cross = compare(cross, tsr_dsp_load(row - 1), centre);
    cross = compare(cross, tsr_dsp_load(row + 1), centre);
    cross = compare(cross, tsr_dsp_load(row + 2), centre);
    cross = compare(cross, tsr_dsp_load(rows[3] + x), centre);
    planes[0] = compare(cross, tsr_dsp_load(rows[4] + x), centre);
    uint32_t knight = compare(0, tsr_dsp_load(rows[0] + x - 1), centre);
    knight = compare(knight, tsr_dsp_load(rows[0] + x + 1), centre);
    knight = compare(knight, tsr_dsp_load(rows[1] + x - 2), centre);
    knight = compare(knight, tsr_dsp_load(rows[1] + x + 2), centre);
    knight = compare(knight, tsr_dsp_load(rows[3] + x - 2), centre);
    knight = compare(knight, tsr_dsp_load(rows[3] + x + 2), centre);
    knight = compare(knight, tsr_dsp_load(rows[4] + x - 1), centre);
    planes[1] = compare(knight, tsr_dsp_load(rows[4] + x + 1), centre);
}

/* The same of the four pixels from x on, with a frame of nearest pixels around the image. */
static __attribute__((noinline)) void describe_at_edge(const uint8_t *const rows[ROWS], int x, int last,
                                                       uint32_t planes[TSR_MATCH_CENSUS_PLANES])
{
    uint8_t around[ROWS][4 + 2 * REACH];
    const uint8_t *inside[ROWS];
    for (unsigned j = 0; j < ROWS; j++) {
        for (int i = 0; i < 4 + 2 * REACH; i++) {
            int column = x + i - REACH;
            around[j][i] = rows[j][column < 0 ? 0 : column < last ? column : last];
        }
        inside[j] = around[j] + REACH;
    }
    describe(inside, 0, planes);
}

static void find_rows(const struct tsr_gray *frame, unsigned y, const uint8_t *rows[ROWS])
{
    for (int i = 0; i < ROWS; i++) {
        int row = (int)y + i - REACH;
        row = row < 0 ? 0 : row < frame->height ? row : frame->height - 1;
        rows[i] = frame->pixels + (size_t)frame->stride * (unsigned)row;
    }
}

static inline void describe_anywhere(const uint8_t *const rows[ROWS], int x, int last,
                                     uint32_t planes[TSR_MATCH_CENSUS_PLANES])
{
    if (x >= REACH && x + 3 + REACH <= last) {
        describe(rows, (unsigned)x, planes);
    } else {
        describe_at_edge(rows, x, last, planes);
    }
}

/* The last four pixels may be described twice: widths are at least 16. */
static void describe_left(const struct tsr_match *match, unsigned y, const struct tsr_match_planes *planes)
{
    int last = match->config.width - 1;
    const uint8_t *rows[ROWS];
    find_rows(&match->left, y, rows);
    for (int x = 0; x <= last; x += 4) {
        int at = x + 3 <= last ? x : last - 3;
        uint32_t words[TSR_MATCH_CENSUS_PLANES];
        describe_anywhere(rows, at, last, words);
        tsr_dsp_store(planes->left[0] + at, words[0]);
        tsr_dsp_store(planes->left[1] + at, words[1]);
    }
}

/* Entry k = W - 1 - s - column, so columns from the right; behind column 0 its copies follow. */
static void describe_right(const struct tsr_match *match, unsigned y, const struct tsr_match_planes *planes)
{
    int last = match->config.width - 1;
    int first_k = last - match->config.search_start_px; /* of column 0 */
    const uint8_t *rows[ROWS];
    find_rows(&match->right, y, rows);
    for (int k = 0; k <= first_k; k += 4) {
        int at = k + 3 <= first_k ? k : first_k - 3;
        uint32_t words[TSR_MATCH_CENSUS_PLANES];
        describe_anywhere(rows, first_k - at - 3, last, words);
        tsr_dsp_store(planes->right[0] + at, __builtin_bswap32(words[0]));
        tsr_dsp_store(planes->right[1] + at, __builtin_bswap32(words[1]));
    }
    size_t copies = (size_t)(last + match->config.disparities - first_k);
    for (unsigned plane = 0; plane < TSR_MATCH_CENSUS_PLANES; plane++) {
        memset(planes->right[plane] + first_k + 1, planes->right[plane][first_k], copies);
    }
}

static void describe_row(const struct tsr_match *match, unsigned y)
{
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    describe_left(match, y, &planes);
    describe_right(match, y, &planes);
}

/* What selects fields of 2, 4 and 8 bits; in registers, as an operand that is shifted cannot meet a constant. */
struct masks {
    uint32_t twos;
    uint32_t fours;
    uint32_t eights;
};

static inline struct masks load_masks(void)
{
    struct masks masks = {UINT32_C(0x55555555), UINT32_C(0x33333333), UINT32_C(0x0f0f0f0f)};
    __asm("" : "+r"(masks.twos), "+r"(masks.fours), "+r"(masks.eights));
    return masks;
}

/* Set bits of both bytes, in each of four lanes. */
static inline uint32_t count_bits(const struct masks *masks, uint32_t a, uint32_t b)
{
    uint32_t count, t;
    __asm("and %1, %4, %2, lsr #1\n\tsub %2, %2, %1\n\tand %1, %4, %3, lsr #1\n\tsub %3, %3, %1\n\t"
          "and %0, %5, %2\n\tand %1, %5, %2, lsr #2\n\tadd %0, %0, %1\n\tand %1, %5, %3\n\tadd %0, %0, %1\n\t"
          "and %1, %5, %3, lsr #2\n\tadd %0, %0, %1\n\tand %1, %6, %0, lsr #4\n\tand %0, %6, %0\n\tadd %0, %0, %1"
          : "=&r"(count), "=&r"(t), "+&r"(a), "+&r"(b)
          : "r"(masks->twos), "r"(masks->fours), "r"(masks->eights));
    return count;
}

/* A pixel's row of lanes: its descriptor in every byte, and what it meets. */
struct lanes {
    uint32_t left[TSR_MATCH_CENSUS_PLANES];
    const uint8_t *right[TSR_MATCH_CENSUS_PLANES];
};

static inline struct lanes lanes_of(const struct tsr_match_planes *planes, unsigned x, unsigned width)
{
    struct lanes lanes = {{planes->left[0][x] * ONES, planes->left[1][x] * ONES},
                          {planes->right[0] + (width - 1u - x), planes->right[1] + (width - 1u - x)}};
    return lanes;
}

static inline uint32_t cost_of(const struct masks *masks, const struct lanes *lanes, unsigned d)
{
    return count_bits(masks, lanes->left[0] ^ tsr_dsp_load(lanes->right[0] + d),
                      lanes->left[1] ^ tsr_dsp_load(lanes->right[1] + d));
}

static void cost_row(const struct tsr_match *match, unsigned y)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *costs = tsr_match_costs_at(match, y);
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    const struct masks masks = load_masks();
    for (unsigned x = 0; x < width; x++, costs += disparities) {
        struct lanes lanes = lanes_of(&planes, x, width);
#pragma GCC unroll 4
        for (unsigned d = 0; d < disparities; d += 4u) {
            tsr_dsp_store(costs + d, cost_of(&masks, &lanes, d));
        }
    }
}

static void add_census(const struct tsr_match *match, unsigned y, unsigned times)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *column = tsr_match_share_scratch(match).columns;
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    const struct masks masks = load_masks();
    for (unsigned x = 0; x < width; x++, column += disparities) {
        struct lanes lanes = lanes_of(&planes, x, width);
        for (unsigned d = 0; d < disparities; d += 4u) {
            tsr_dsp_store(column + d, tsr_dsp_load(column + d) + times * cost_of(&masks, &lanes, d));
        }
    }
}

/* What leaves is part of the sum, and that is at most 240: no lane borrows or carries. */
static void move_columns(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    unsigned width = match->config.width;
    unsigned disparities = match->config.disparities;
    uint8_t *column = tsr_match_share_scratch(match).columns;
    struct tsr_match_planes new = tsr_match_planes_at(match, y_new);
    struct tsr_match_planes old = tsr_match_planes_at(match, y_old);
    const struct masks masks = load_masks();
    for (unsigned x = 0; x < width; x++, column += disparities) {
        struct lanes enter = lanes_of(&new, x, width);
        struct lanes leave = lanes_of(&old, x, width);
        for (unsigned d = 0; d < disparities; d += 4u) {
            uint32_t stays = tsr_dsp_load(column + d) - cost_of(&masks, &leave, d);
            tsr_dsp_store(column + d, stays + cost_of(&masks, &enter, d));
        }
    }
}

static void census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    move_columns(match, y_new, y_old);
    tsr_match_finish_row(match, y);
}

const struct tsr_match_census_kernel tsr_match_census_dsp = {describe_row, add_census, census_row, cost_row,
                                                             tsr_dsp_smooth_row};
#endif
