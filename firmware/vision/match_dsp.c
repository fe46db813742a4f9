/*
 * The matcher's rows with the DSP extension of Cortex-M4, M7 and M33: four
 * disparities in a word of column sums, two in a word of window sums.
 *
 * Lanes d of one group of eight lie in four words: (0,2) (1,3) (4,6) (5,7), low
 * half first, as UXTB16 and its rotated form take bytes apart. Beside the sums a
 * group keeps its least one (as two halves), so that most groups are judged by
 * one word.
 *
 * At the left border a lane d starts at pixel x = d. Columns left of it do not
 * have the lane, and what they hold there is undefined; until it starts, its
 * sum is NOT_STARTED, which no winner and no limit reaches. The column sums
 * left of column d that lane d will need are written when it starts, all equal
 * to that of column d: eq. (12).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include <string.h>

#include "match_dsp.h"

#define GROUP_LANES 8u
#define LEAST_WORDS 4u /* groups are judged by so many at once */
#define ALL_LANES UINT32_C(0xffffffff)
/* Above every limit (2 * 1890) by more than garbage can move it in the steps before a lane starts. */
#define NOT_STARTED 0x4000u

/* Halfword of lane l - 1 of a group, l = 0 .. 9, from the group's first. */
static const int8_t halfword_of_lane[10] = {-1, 0, 2, 1, 3, 4, 6, 5, 7, 8};

/* Sets the lanes of a group that lie within one of lane l. */
static const uint32_t own_lanes[GROUP_LANES][4] = {
    {0x0000ffff, 0x0000ffff, 0, 0},          {0xffffffff, 0x0000ffff, 0, 0},          {0xffff0000, 0xffffffff, 0, 0},
    {0xffff0000, 0xffff0000, 0x0000ffff, 0}, {0, 0xffff0000, 0x0000ffff, 0x0000ffff}, {0, 0, 0xffffffff, 0x0000ffff},
    {0, 0, 0xffff0000, 0xffffffff},          {0, 0, 0xffff0000, 0xffff0000},
};

/* What one row works on. */
struct row {
    uint32_t *sums;         /* [D / 2]; in front of it, downward, the least of every group */
    uint8_t *columns;       /* [columns_count][D] */
    unsigned columns_count; /* W - s */
    unsigned disparities;
    uint32_t unique_scale; /* ceil(2^20 uniqueness / 100) */
    bool unique_off;
    uint8_t *texture; /* column sums, of all columns */
    uint16_t *claims;
    uint16_t *choices; /* of the first pixel that has candidates */
};

static inline uint16_t *halfwords_of(const struct row *row, unsigned group)
{
    return (uint16_t *)(void *)(row->sums + 4u * group);
}

/* Not 0 if a sum of a group's four words that is not masked is below the halves of above. */
static inline uint32_t find_below(const uint32_t *words, const uint32_t *masks, uint32_t above)
{
    uint32_t found, t0, t1, t2, t3;
    __asm("ldrd %1, %2, [%5]\n\tldrd %3, %4, [%6]\n\torr %1, %1, %3\n\torr %2, %2, %4\n\t"
          "uqsub16 %1, %7, %1\n\tuqsub16 %2, %7, %2\n\torr %0, %1, %2\n\t"
          "ldrd %1, %2, [%5, #8]\n\tldrd %3, %4, [%6, #8]\n\torr %1, %1, %3\n\torr %2, %2, %4\n\t"
          "uqsub16 %1, %7, %1\n\tuqsub16 %2, %7, %2\n\torr %1, %1, %2\n\torr %0, %0, %1"
          : "=&r"(found), "=&r"(t0), "=&r"(t1), "=&r"(t2), "=&r"(t3)
          : "r"(words), "r"(masks), "r"(above)
          : "memory");
    return found;
}

/* The same of LEAST_WORDS words without masks, and what was found before. */
static inline uint32_t find_least_below(const uint32_t *words, uint32_t above, uint32_t found)
{
    uint32_t t0, t1, t2, t3;
    __asm("ldrd %1, %2, [%5]\n\tldrd %3, %4, [%5, #8]\n\tuqsub16 %1, %6, %1\n\tuqsub16 %2, %6, %2\n\t"
          "uqsub16 %3, %6, %3\n\tuqsub16 %4, %6, %4\n\torr %0, %0, %1\n\torr %0, %0, %2\n\t"
          "orr %0, %0, %3\n\torr %0, %0, %4"
          : "+&r"(found), "=&r"(t0), "=&r"(t1), "=&r"(t2), "=&r"(t3)
          : "r"(words), "r"(above)
          : "memory");
    return found;
}

/* Some group but the winner's has a sum within the limit: is it just the lane beside the winner? */
static __attribute__((noinline)) bool are_neighbours_own(const struct row *row, unsigned winner_group,
                                                         unsigned winner_lane, uint32_t above)
{
    static const uint32_t last_lane[4] = {0, 0, 0, 0xffff0000};
    static const uint32_t first_lane[4] = {0x0000ffff, 0, 0, 0};
    for (unsigned group = 0; group < row->disparities / GROUP_LANES; group++) {
        if (group == winner_group || tsr_dsp_subtract_halves(above, row->sums[-1 - (int)group]) == 0) {
            continue;
        }
        const uint32_t *own = NULL;
        if (group + 1u == winner_group && winner_lane == 0) {
            own = last_lane;
        } else if (group == winner_group + 1u && winner_lane == GROUP_LANES - 1u) {
            own = first_lane;
        }
        if (own == NULL || find_below(row->sums + 4u * group, own, above) != 0) {
            return false;
        }
    }
    return true;
}

/* docs/math.md, eq. (15). */
static inline bool is_unique(const struct row *row, unsigned group, unsigned lane, unsigned sum)
{
    uint32_t limit = sum + (sum * row->unique_scale >> 20);
    uint32_t above = (limit + 1u) * 0x10001u;
    if (find_below(row->sums + 4u * group, own_lanes[lane], above) != 0) {
        return false;
    }
    row->sums[-1 - (int)group] = ALL_LANES;
    uint32_t others = 0;
    const uint32_t *least = row->sums;
    for (int words = (int)row->disparities; words > 0; words -= (int)(GROUP_LANES * LEAST_WORDS)) {
        least -= LEAST_WORDS;
        others = find_least_below(least, above, others);
    }
    return others == 0 || are_neighbours_own(row, group, lane, above);
}

/* docs/math.md, eq. (16). */
static inline unsigned interpolate(const uint16_t *halfwords, unsigned lane, unsigned d, unsigned sum)
{
    int below = halfwords[halfword_of_lane[lane]];
    int above = halfwords[halfword_of_lane[lane + 2u]];
    int lean = below - above;
    unsigned slope = (unsigned)(lean > 0 ? below : above) - sum;
    unsigned distance = (unsigned)(lean > 0 ? lean : -lean);
    unsigned offset_q4 = (16u * distance + slope) / (2u * slope);
    unsigned centre = TSR_MATCH_CHOICE(d, 0);
    return lean > 0 ? centre + offset_q4 : centre - offset_q4;
}

/* The lowest lane of a group that has the sum; either half of the group's words may hold it. */
static __attribute__((noinline)) unsigned find_lane(const uint16_t *halfwords, unsigned sum)
{
    unsigned lane = 0;
    while (halfwords[halfword_of_lane[lane + 1u]] != sum) {
        lane++;
    }
    return lane;
}

/* Pixel x (of those with candidates) from the window sums. */
static inline __attribute__((always_inline)) void choose(const struct row *row, unsigned x, unsigned highest,
                                                         uint64_t least, bool textured)
{
    unsigned low = (uint16_t)least;
    unsigned high = (uint16_t)(least >> 16);
    unsigned sum = low;
    unsigned group = (uint16_t)(least >> 32);
    unsigned lane;
    const uint16_t *halfwords;
    if (low < high) {
        halfwords = halfwords_of(row, group);
        lane = halfwords[0] == sum ? 0u : halfwords[2] == sum ? 1u : halfwords[4] == sum ? 4u : 5u;
    } else if (low > high) {
        sum = high;
        group = (unsigned)(least >> 48);
        halfwords = halfwords_of(row, group);
        lane = halfwords[1] == sum ? 2u : halfwords[3] == sum ? 3u : halfwords[5] == sum ? 6u : 7u;
    } else {
        unsigned other = (unsigned)(least >> 48);
        group = other < group ? other : group;
        halfwords = halfwords_of(row, group);
        lane = find_lane(halfwords, sum);
    }
    unsigned d = GROUP_LANES * group + lane;
    unsigned claim = TSR_MATCH_CLAIM(sum, d);
    uint16_t *claimed = row->claims + (x - d);
    if (claim < *claimed) {
        *claimed = (uint16_t)claim;
    }
    unsigned choice = TSR_MATCH_CHOICE_NONE;
    if (textured && (row->unique_off || is_unique(row, group, lane, sum))) {
        choice = d - 1u < highest - 1u ? interpolate(halfwords, lane, d, sum) : TSR_MATCH_CHOICE(d, 0);
    }
    row->choices[x] = (uint16_t)choice;
}

/* Begin lane d at pixel d: its sum as if the column that enters now (d + radius)
 * were not in yet, and what it needs of columns that do not have it. */
static void start_lane(const struct row *row, unsigned d, unsigned radius)
{
    unsigned stride = row->disparities;
    uint8_t *column = row->columns + (size_t)d * stride + d;
    unsigned first = *column;
    unsigned sum = (radius + 2u) * first;
    for (unsigned i = 1; i < radius; i++) {
        unsigned to_last = row->columns_count - 1u - d;
        sum += column[(size_t)(i < to_last ? i : to_last) * stride];
    }
    unsigned behind = d < radius + 1u ? d : radius + 1u;
    for (unsigned i = 1; i <= behind; i++) {
        column[-(int)(i * stride)] = (uint8_t)first;
    }
    halfwords_of(row, d / GROUP_LANES)[halfword_of_lane[d % GROUP_LANES + 1u]] = (uint16_t)sum;
}

static void move_texture_columns(const struct tsr_match *match, uint8_t *columns, const uint8_t *new_row,
                                 const uint8_t *old_row)
{
    unsigned width = match->config.width;
    uint32_t caps = match->config.prefilter_cap * 0x01010101u;
    unsigned x = 0;
    for (; x + 4u <= width; x += 4u) {
        uint32_t added = tsr_dsp_difference(tsr_dsp_load(new_row + x), caps);
        uint32_t taken = tsr_dsp_difference(tsr_dsp_load(old_row + x), caps);
        uint32_t sums = tsr_dsp_load(columns + x);
        tsr_dsp_store(columns + x, tsr_dsp_subtract(tsr_dsp_add(sums, added), taken));
    }
    for (; x < width; x++) {
        uint32_t added = tsr_dsp_difference(new_row[x], caps & 0xffu);
        columns[x] = (uint8_t)(columns[x] + added - tsr_dsp_difference(old_row[x], caps & 0xffu));
    }
}

/* Lays a row's working memory over the scratch: the least of the groups, the sums, and the edge of the new row. */
static struct row begin_row(const struct tsr_match *match, uint8_t **edge)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned disparities = config->disparities;
    unsigned least_count = (disparities / GROUP_LANES + LEAST_WORDS - 1u) / LEAST_WORDS * LEAST_WORDS;
    uint32_t *least = (uint32_t *)(void *)match->scratch;
    struct row row = {.sums = least + least_count,
                      .columns = scratch.columns,
                      .columns_count = config->width - start,
                      .disparities = disparities,
                      .unique_scale = ((unsigned)config->uniqueness_percent << 20) / 100u + 1u,
                      .unique_off = config->uniqueness_percent == TSR_MATCH_TEST_OFF,
                      .texture = scratch.texture,
                      .claims = scratch.claims,

                      .choices = scratch.choices + start};
    memset(least, 0xff, sizeof *least * least_count);
    for (unsigned i = 0; i < disparities / 2u; i++) {
        row.sums[i] = NOT_STARTED * 0x10001u;
    }
    memset(scratch.claims, 0xff, sizeof *scratch.claims * config->width);
    for (unsigned x = 0; x < start; x++) {
        scratch.choices[x] = TSR_MATCH_CHOICE_NONE;
    }
    *edge = (uint8_t *)(row.sums + disparities / 2u);
    return row;
}

/* The texture of pixel x - 1 (of all columns), less what it must be: eq. (13). */
static int begin_texture(const struct tsr_match *match, const uint8_t *columns, unsigned x)
{
    const struct tsr_match_config *config = &match->config;
    int last = config->width - 1;
    int radius = config->window / 2;
    int sum = config->texture_min == TSR_MATCH_TEST_OFF ? INT16_MAX : -(int)config->texture_min * config->window;
    for (int i = (int)x - 1 - radius; i <= (int)x - 1 + radius; i++) {
        sum += columns[i < 0 ? 0 : i < last ? i : last];
    }
    return sum;
}

/* Moves the texture to x, wherever that is. */
static int move_texture(const struct tsr_match *match, const uint8_t *columns, unsigned x, int sum)
{
    unsigned last = match->config.width - 1u;
    unsigned radius = match->config.window / 2u;
    unsigned enter = x + radius < last ? x + radius : last;
    unsigned leave = x > radius ? x - radius - 1u : 0u;
    return sum + columns[enter] - columns[leave];
}

/* The window in front of the first column: a copy of the new row's edge stands in for its end, as lanes that have
 * not started are read beyond it. */
static struct tsr_dsp_window begin_window(const struct tsr_match *match, const struct row *row, unsigned y_new,
                                          unsigned y_old, uint8_t *edge)
{
    unsigned last = match->config.width - 1u;
    unsigned start = (unsigned)match->config.search_start_px;
    unsigned disparities = row->disparities;
    memcpy(edge, match->right.pixels + (size_t)y_new * match->right.stride + (last + 1u - disparities), disparities);
    memset(edge + disparities, 0, GROUP_LANES);
    struct tsr_dsp_window window = {.right_new = edge + disparities,
                                    .right_old =
                                        match->right.pixels + (size_t)y_old * match->right.stride + (last + 1u),
                                    .enter = row->columns - disparities,
                                    .leave = row->columns - disparities,
                                    .left_new = match->left.pixels + (size_t)y_new * match->left.stride + start,
                                    .left_old = match->left.pixels + (size_t)y_old * match->left.stride + start,
                                    .sums = row->sums,
                                    .stride = disparities};
    return window;
}

/* A step at the left border (lanes still start) or right of the last column (which is taken again, unmoved). */
static __attribute__((noinline)) int step_at_border(const struct tsr_match *match, const struct row *row,
                                                    struct tsr_dsp_window *window, unsigned enter, int texture)
{
    unsigned disparities = row->disparities;
    unsigned radius = match->config.window / 2u;
    unsigned start = (unsigned)match->config.search_start_px;
    unsigned x = enter - radius;
    if (enter < disparities) {
        window->entry = tsr_dsp_entry(enter / GROUP_LANES + 1u);
    }
    if (enter >= row->columns_count) {
        window->enter -= disparities;
        window->right_new = window->right_old;
        window->left_new = window->left_old;
    }
    if (enter <= 2u * radius + 1u) {
        window->leave = row->columns - disparities;
    }
    if (enter >= radius && x < disparities) {
        start_lane(row, x, radius);
    }
    uint64_t least = tsr_dsp_move_window(window);
    if (enter >= radius) {
        texture = move_texture(match, row->texture, start + x, texture);
        choose(row, x, x < disparities ? x : disparities - 1u, least, texture >= 0);
    }
    return texture;
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    uint8_t *edge;
    const struct row row = begin_row(match, &edge);
    unsigned radius = match->config.window / 2u;
    unsigned start = (unsigned)match->config.search_start_px;
    unsigned highest = row.disparities - 1u;
    struct tsr_dsp_window window = begin_window(match, &row, y_new, y_old, edge);
    move_texture_columns(match, row.texture, window.left_new - start, window.left_old - start);
    int texture = begin_texture(match, row.texture, start);

    unsigned enter = 0;
    for (; enter < row.disparities + radius && enter < row.columns_count; enter++) {
        if (enter == row.disparities) {
            window.right_new = match->right.pixels + (size_t)y_new * match->right.stride +
                               (row.columns_count + start - row.disparities);
        }
        texture = step_at_border(match, &row, &window, enter, texture);
    }
    const uint8_t *texture_enter = row.texture + start;
    const uint8_t *texture_leave = row.texture + start - 2u * radius - 1u;
    for (; enter < row.columns_count; enter++) {
        texture += texture_enter[enter] - texture_leave[enter];
        choose(&row, enter - radius, highest, tsr_dsp_move_window(&window), texture >= 0);
    }
    for (; enter < row.columns_count + radius; enter++) {
        texture = step_at_border(match, &row, &window, enter, texture);
    }
    tsr_match_write_row(match, y);
}

const struct tsr_match_kernel tsr_match_kernel_dsp = {
    .name = "dsp",
    .prefilter_row = tsr_dsp_prefilter_row,
    .add_row = tsr_dsp_add_row,
    .match_row = match_row,
    TSR_MATCH_DSP_CENSUS,
};
#endif
