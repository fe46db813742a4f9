/*
 * 3x3 medians of a block with the DSP extension of Cortex-M: two pixels in a
 * word, whose values order as they are, unsigned.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "median_block.h"

#if defined(__ARM_FEATURE_SIMD32)

#include "tsr/base/disparity.h"
#include "tsr/vision/median.h"

#define BOTH UINT32_C(0x00010001)

/* Two pixels' lesser and greater values. */
struct ordered {
    uint32_t lesser;
    uint32_t greater;
};

static inline struct ordered order(uint32_t a, uint32_t b)
{
    struct ordered result;
    __asm("usub16 %0, %2, %3\n\tsel %0, %3, %2\n\tsel %1, %2, %3"
          : "=&r"(result.lesser), "=&r"(result.greater)
          : "r"(a), "r"(b));
    return result;
}

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("usub16 %0, %1, %2\n\tsel %0, %2, %1" : "=&r"(result) : "r"(a), "r"(b));
    return result;
}

static inline uint32_t greater(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("usub16 %0, %1, %2\n\tsel %0, %1, %2" : "=&r"(result) : "r"(a), "r"(b));
    return result;
}

/* first where count >= least, else second. */
static inline uint32_t choose(uint32_t count, uint32_t least, uint32_t first, uint32_t second)
{
    uint32_t result;
    __asm("usub16 %0, %1, %2\n\tsel %0, %3, %4" : "=&r"(result) : "r"(count), "r"(least), "r"(first), "r"(second));
    return result;
}

static inline uint32_t load(const uint16_t *at)
{
    uint32_t word;
    __builtin_memcpy(&word, at, sizeof word);
    return word;
}

static inline void store(uint16_t *at, uint32_t word)
{
    __builtin_memcpy(at, &word, sizeof word);
}

/* Of the columns: their three values in ascending order, and how many are invalid. */
struct columns {
    _Alignas(4) uint16_t low[TSR_MEDIAN_COLUMNS];
    _Alignas(4) uint16_t middle[TSR_MEDIAN_COLUMNS];
    _Alignas(4) uint16_t high[TSR_MEDIAN_COLUMNS];
    _Alignas(4) uint16_t invalid[TSR_MEDIAN_COLUMNS];
};

static inline uint32_t is_invalid(uint32_t values)
{
    return choose(values, TSR_DISPARITY_INVALID * BOTH, BOTH, 0);
}

static void sort_columns(const struct tsr_median_block *block, struct columns *columns)
{
    for (unsigned i = 0; i < TSR_MEDIAN_COLUMNS; i += 2) {
        uint32_t a = load(block->values[0] + i);
        uint32_t b = load(block->values[1] + i);
        uint32_t c = load(block->values[2] + i);
        store(columns->invalid + i, is_invalid(a) + is_invalid(b) + is_invalid(c));
        struct ordered first = order(a, b);
        struct ordered last = order(first.greater, c);
        struct ordered begin = order(first.lesser, last.lesser);
        store(columns->low + i, begin.lesser);
        store(columns->middle + i, begin.greater);
        store(columns->high + i, last.greater);
    }
}

/* Of two windows side by side. */
static inline uint32_t find_median(const struct columns *columns, unsigned i)
{
    uint32_t low = load(columns->low + i + 2u);
    struct ordered lows = order(load(columns->low + i), load(columns->low + i + 1u));
    struct ordered last = order(lows.greater, low);
    uint32_t low_1 = greater(lows.lesser, last.lesser);
    uint32_t low_2 = last.greater;
    uint32_t middle = load(columns->middle + i + 2u);
    struct ordered middles = order(load(columns->middle + i), load(columns->middle + i + 1u));
    uint32_t middle_0 = lesser(middles.lesser, middle);
    uint32_t middle_1 = greater(middles.lesser, lesser(middles.greater, middle));
    uint32_t high_0 =
        lesser(lesser(load(columns->high + i), load(columns->high + i + 1u)), load(columns->high + i + 2u));

    struct ordered one = order(low_1, middle_0); /* middle_1 is not below the greater one */
    struct ordered other = order(low_2, high_0);
    struct ordered two = order(one.greater, other.lesser);
    struct ordered rest = order(other.greater, middle_1);
    uint32_t rank_3 = lesser(two.greater, rest.lesser);
    uint32_t rank_4 = greater(rest.lesser, lesser(rest.greater, two.greater));

    uint32_t invalid = load(columns->invalid + i) + load(columns->invalid + i + 1u) + load(columns->invalid + i + 2u);
    uint32_t median = choose(invalid, 1u * BOTH, rank_3, rank_4);
    median = choose(invalid, 3u * BOTH, two.lesser, median);
    median = choose(invalid, 5u * BOTH, one.lesser, median);
    return choose(invalid, (10u - TSR_MEDIAN_VALID_MIN) * BOTH, TSR_DISPARITY_INVALID * BOTH, median);
}

void tsr_median_filter_block(const struct tsr_median_block *block, uint16_t medians[TSR_MEDIAN_BLOCK])
{
    struct columns columns;
    sort_columns(block, &columns);
    for (unsigned i = 0; i < TSR_MEDIAN_BLOCK; i += 2) {
        store(medians + i, find_median(&columns, i));
    }
}
#endif
