/*
 * 3x3 medians of a block in portable C: loops that compilers turn into vector code.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "median_block.h"

#if !defined(__ARM_FEATURE_SIMD32) /* median_block_dsp.c */

#include <stdbool.h>

#include "tsr/vision/median.h"

/* Of the columns around a block: their three values in ascending order, and how many are valid. Values are less 2^15,
 * so that their order is the one of vector instructions, and invalid ones are the largest. */
struct columns {
    int16_t low[TSR_MEDIAN_COLUMNS];
    int16_t middle[TSR_MEDIAN_COLUMNS];
    int16_t high[TSR_MEDIAN_COLUMNS];
    int16_t valid[TSR_MEDIAN_COLUMNS];
};

static inline int16_t lesser(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static inline int16_t greater(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

/* By a mask: a branch would keep the loop from being made of vectors. */
static inline int16_t select(bool first, int16_t a, int16_t b)
{
    int16_t mask = (int16_t) - (int16_t)first;
    return (int16_t)((a & mask) | (b & ~mask));
}

static void sort_columns(const struct tsr_median_block *block, struct columns *columns)
{
    for (unsigned i = 0; i < TSR_MEDIAN_COLUMNS; i++) {
        int16_t a = (int16_t)(block->values[0][i] ^ 0x8000u);
        int16_t b = (int16_t)(block->values[1][i] ^ 0x8000u);
        int16_t c = (int16_t)(block->values[2][i] ^ 0x8000u);
        int16_t below = lesser(a, b);
        int16_t above = greater(a, b);
        columns->low[i] = lesser(below, c);
        columns->middle[i] = greater(below, lesser(above, c));
        columns->high[i] = greater(above, c);
        columns->valid[i] = (int16_t)((a != INT16_MAX) + (b != INT16_MAX) + (c != INT16_MAX));
    }
}

static void find_medians(const struct columns *columns, uint16_t medians[TSR_MEDIAN_BLOCK])
{
    for (unsigned i = 0; i < TSR_MEDIAN_BLOCK; i++) {
        const int16_t *low = columns->low + i;
        const int16_t *middle = columns->middle + i;
        const int16_t *high = columns->high + i;
        int16_t low_1 = greater(lesser(low[0], low[1]), lesser(greater(low[0], low[1]), low[2]));
        int16_t low_2 = greater(greater(low[0], low[1]), low[2]);
        int16_t middle_0 = lesser(lesser(middle[0], middle[1]), middle[2]);
        int16_t middle_1 = greater(lesser(middle[0], middle[1]), lesser(greater(middle[0], middle[1]), middle[2]));
        int16_t high_0 = lesser(lesser(high[0], high[1]), high[2]);

        int16_t rank_1 = lesser(low_1, middle_0);
        int16_t after = greater(low_1, middle_0); /* middle_1 is not below it */
        int16_t rank_2 = lesser(after, lesser(low_2, high_0));
        after = greater(after, lesser(low_2, high_0));
        int16_t other = greater(low_2, high_0);
        int16_t rank_3 = lesser(after, lesser(other, middle_1));
        int16_t rank_4 = greater(lesser(other, middle_1), lesser(greater(other, middle_1), after));

        int16_t valid = (int16_t)(columns->valid[i] + columns->valid[i + 1u] + columns->valid[i + 2u]);
        int16_t median = select(valid > 8, rank_4, rank_3);
        median = select(valid > 6, median, rank_2);
        median = select(valid > 4, median, rank_1);
        median = select(valid >= TSR_MEDIAN_VALID_MIN, median, INT16_MAX);
        medians[i] = (uint16_t)((uint16_t)median ^ 0x8000u);
    }
}

void tsr_median_filter_block(const struct tsr_median_block *block, uint16_t medians[TSR_MEDIAN_BLOCK])
{
    struct columns columns;
    sort_columns(block, &columns);
    find_medians(&columns, medians);
}
#endif
