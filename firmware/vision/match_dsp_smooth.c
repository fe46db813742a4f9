/*
 * Path costs and the choice among their sums with the DSP extension: four
 * disparities in a word, all of it in 8 bits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include <string.h>

#include "match_dsp.h"

#define ONES UINT32_C(0x01010101)
#define NONE UINT32_C(0xffffffff)
#define WORDS_MAX (TSR_DISPARITY_COUNT_MAX / 4u)

/* The lesser of each pair of bytes. */
static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("usub8 %0, %1, %2\n\tsel %0, %2, %1" : "=&r"(result) : "r"(a), "r"(b));
    return result;
}

/* The least of the four bytes, in every byte. */
static inline uint32_t spread_least(uint32_t a)
{
    a = lesser(a, a >> 16 | a << 16);
    return lesser(a, a >> 8 | a << 24);
}

/* Sums over three rows, [d / 4]: of column x, and of columns x - 1 and x together. */
struct box {
    uint32_t here;
    uint32_t both;
};

/* The rows of costs that are summed. */
struct cost_rows {
    const uint32_t *at[TSR_MATCH_SMOOTH_ROWS];
};

/* Column 0, and its copy that stands for column -1. */
static void begin_box(const struct cost_rows *rows, struct box *box, unsigned words)
{
    for (unsigned i = 0; i < words; i++) {
        box[i].here = rows->at[0][i] + rows->at[1][i] + rows->at[2][i];
        box[i].both = 2u * box[i].here;
    }
}

/* docs/math.md, eq. (42): a column enters, cost is B of the one before. words is even. */
static inline void move_box(const struct cost_rows *rows, unsigned column, struct box *box, uint32_t *cost,
                            unsigned words)
{
    const uint32_t *row0 = rows->at[0] + column * words;
    const uint32_t *row1 = rows->at[1] + column * words;
    const uint32_t *row2 = rows->at[2] + column * words;
    const uint32_t *end = cost + words;
    uint32_t sum, here, both;
    do {
        for (unsigned i = 0; i < 2; i++) {
            __asm volatile("ldr %0, [%3], #4\n\tldr %1, [%4], #4\n\tadd %0, %0, %1\n\tldr %1, [%5], #4\n\t"
                           "add %0, %0, %1\n\tldrd %1, %2, [%6]\n\tadd %2, %2, %0\n\tadd %1, %1, %0\n\t"
                           "strd %0, %1, [%6], #8\n\tand %2, %8, %2, lsr #2\n\tstr %2, [%7], #4"
                           : "=&r"(sum), "=&r"(here), "=&r"(both), "+&r"(row0), "+&r"(row1), "+&r"(row2), "+&r"(box),
                             "+&r"(cost)
                           : "r"(UINT32_C(0x3f3f3f3f))
                           : "memory");
        }
    } while (cost != end);
}

/* What the pixels of a row are found out with. */
struct row {
    struct tsr_match_paths paths;
    const uint8_t *gray;
    const uint8_t *gray_above;
    uint32_t *cost; /* B, then S, in bytes */
    uint16_t *claims;
    uint16_t *choices; /* of the first pixel that has candidates */
    uint32_t unique_scale;
    bool unique_off;
    unsigned words;
    unsigned last;       /* column */
    uint32_t least_left; /* in every byte */
};

/* docs/math.md, eq. (43), as tsr_match_penalty_far(), in every byte. */
static inline uint32_t penalty_far(uint32_t gray, uint32_t gray_before)
{
    uint32_t room;
    __asm("usad8 %0, %1, %2\n\trsb %0, %0, %3\n\tusat %0, #5, %0"
          : "=r"(room)
          : "r"(gray), "r"(gray_before), "i"(TSR_MATCH_PENALTY_FAR - TSR_MATCH_PENALTY_NEAR));
    return (room + TSR_MATCH_PENALTY_NEAR) * ONES;
}

/* One path of pixel x. A path that starts here comes from costs of 0, which adds nothing. */
static inline void set_path(struct tsr_dsp_walk *walk, const uint32_t *source, uint32_t *path, unsigned words,
                            uint32_t least, uint32_t penalty)
{
    walk->source = source;
    walk->path = path;
    walk->last = source + (words - 1u);
    walk->least = least;
    walk->jump = least + penalty;
}

/* docs/math.md, eqs. (43) to (46). Returns the least sum in every byte. */
static inline uint32_t sum_paths(struct row *row, unsigned x)
{
    static const uint32_t none[WORDS_MAX + 1u];
    unsigned words = row->words;
    struct tsr_match_paths *paths = &row->paths;
    uint32_t *first = (uint32_t *)(void *)paths->before;
    uint32_t *second = (uint32_t *)(void *)paths->above[0] + x * words;
    uint32_t *third = (uint32_t *)(void *)paths->above[1] + x * words;
    uint32_t gray = row->gray[x];
    struct tsr_dsp_walk walk;
    walk.cost = row->cost;

    set_path(&walk, x > 0 ? first : none, first, words, row->least_left,
             x > 0 ? penalty_far(gray, row->gray[x - 1u]) : 0u);
    row->least_left = spread_least(tsr_dsp_walk(&walk));

    set_path(&walk, second, second, words, paths->least[0][x] * ONES, penalty_far(gray, row->gray_above[x]));
    paths->least[0][x] = (uint8_t)spread_least(tsr_dsp_walk(&walk));

    if (x < row->last) {
        set_path(&walk, third + words, third, words, paths->least[1][x + 1u] * ONES,
                 penalty_far(gray, row->gray_above[x + 1u]));
    } else {
        set_path(&walk, none, third, words, 0, 0);
    }
    uint64_t least = tsr_dsp_walk_last(&walk, first, second);
    paths->least[1][x] = (uint8_t)spread_least((uint32_t)least);
    return spread_least((uint32_t)(least >> 32));
}

/* ONES where a byte of a is at least that of b, else 0. */
static inline uint32_t at_least(uint32_t a, uint32_t b)
{
    uint32_t result;
    __asm("usub8 %0, %1, %2\n\tsel %0, %3, %4" : "=&r"(result) : "r"(a), "r"(b), "r"(ONES), "r"(0));
    return result;
}

/* Lanes from x + 1 on do not exist: the least of the others, in every byte. words is even. */
static __attribute__((noinline)) uint32_t mask_sums(uint32_t *sums, unsigned words, unsigned x)
{
    uint8_t *lanes = (uint8_t *)sums;
    for (unsigned d = x + 1u; d < 4u * words; d++) {
        lanes[d] = UINT8_MAX;
    }
    uint32_t least = NONE;
    for (unsigned i = 0; i < words; i++) {
        least = lesser(least, sums[i]);
    }
    return spread_least(least);
}

/* The lowest lane of the least sum; some word has it. */
static inline unsigned find_winner(const uint32_t *sums, uint32_t least)
{
    const uint32_t *at = sums;
    uint32_t found;
    do {
        found = at_least(least, *at++);
    } while (found == 0);
    return 4u * (unsigned)(at - 1 - sums) + (unsigned)__builtin_ctz(found) / 8u;
}

/* docs/math.md, eq. (15): the lanes within the limit are the winner and those beside it. words is even. */
static inline bool is_unique(const uint32_t *sums, unsigned words, unsigned limit, unsigned own)
{
    uint32_t within = limit * ONES;
    uint32_t count = 0; /* in four lanes */
    const uint32_t *end = sums + words;
    do {
        count += at_least(within, sums[0]);
        count += at_least(within, sums[1]);
        sums += 2;
    } while (sums != end);
    return count * ONES >> 24 == own;
}

/* docs/math.md, eq. (16). */
static inline unsigned interpolate(unsigned choice, unsigned below, unsigned above, unsigned sum)
{
    int lean = (int)below - (int)above;
    unsigned slope = (lean > 0 ? below : above) - sum;
    unsigned distance = (unsigned)(lean > 0 ? lean : -lean);
    unsigned offset_q4 = (16u * distance + slope) / (2u * slope);
    return lean > 0 ? choice + offset_q4 : choice - offset_q4;
}

/* Pixel x (of those with candidates) from the sums, whose least is in every byte: docs/math.md, eqs. (14) to (17). */
static inline void choose(const struct row *row, unsigned x, uint32_t least)
{
    unsigned words = row->words;
    unsigned highest = 4u * words - 1u;
    if (x < highest) {
        highest = x;
        words = x / 8u * 2u + 2u;
        least = mask_sums(row->cost, words, x);
    }
    unsigned d = find_winner(row->cost, least);
    unsigned sum = least & 0xffu;
    uint16_t *claimed = row->claims + (x - d);
    unsigned claim = TSR_MATCH_CLAIM_OF(sum, 0, d);
    if (claim < *claimed) {
        *claimed = (uint16_t)claim;
    }
    const uint8_t *lanes = (const uint8_t *)row->cost + d;
    unsigned below = d > 0 ? lanes[-1] : UINT8_MAX;
    unsigned above = d < highest ? lanes[1] : UINT8_MAX;
    unsigned limit = sum + (sum * row->unique_scale >> 20);
    limit = limit < UINT8_MAX ? limit : UINT8_MAX - 1u; /* sums are at most 204, lanes that do not exist 255 */
    unsigned own = 1u + (below <= limit ? 1u : 0u) + (above <= limit ? 1u : 0u);
    unsigned choice = TSR_MATCH_CHOICE_NONE;
    if (row->unique_off || is_unique(row->cost, words, limit, own)) {
        choice = 32u * d; /* as tsr_dsp_write_row() reads it */
        choice = d - 1u < highest - 1u ? interpolate(choice, below, above, sum) : choice;
    }
    row->choices[x] = (uint16_t)choice;
}

void tsr_dsp_smooth_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned last = config->width - 1u;
    unsigned below = y + 1u < config->height ? y + 1u : y;
    const uint8_t *gray = match->left.pixels + (size_t)y * match->left.stride;
    uint32_t cost[WORDS_MAX];
    struct box box[WORDS_MAX];
    struct row row = {.paths = tsr_match_share_paths(match),
                      .gray = gray,
                      .gray_above = y > 0 ? gray - match->left.stride : gray,
                      .cost = cost,
                      .claims = scratch.claims,
                      .choices = scratch.choices + start,
                      .unique_scale = ((unsigned)config->uniqueness_percent << 20) / 100u + 1u,
                      .unique_off = config->uniqueness_percent == TSR_MATCH_TEST_OFF,
                      .words = config->disparities / 4u,
                      .last = last};
    const struct cost_rows rows = {{(const uint32_t *)(const void *)tsr_match_costs_at(match, y > 0 ? y - 1u : 0u),
                                    (const uint32_t *)(const void *)tsr_match_costs_at(match, y),
                                    (const uint32_t *)(const void *)tsr_match_costs_at(match, below)}};
    memset(scratch.claims, 0xff, sizeof *scratch.claims * config->width);
    memset(scratch.choices, 0xff, sizeof *scratch.choices * start);
    begin_box(&rows, box, row.words);
    for (unsigned x = 0; x <= last; x++) {
        move_box(&rows, x < last ? x + 1u : last, box, cost, row.words);
        uint32_t least = sum_paths(&row, x);
        if (x >= start) {
            choose(&row, x - start, least);
        }
    }
    tsr_dsp_write_row(match, y);
}
#endif
