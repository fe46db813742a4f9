/*
 * Which changed cells count, and whether enough of them touch: rarely needed,
 * so compiled small. A region is walked without a stack, each cell of it once
 * for itself and once for every way back.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "change_cells.h"

#define EDGE_DOUBT_LOG2 3 /* ours, chosen as those of change_cells.c */
#define AROUND 9u
#define ITSELF 4u

/* The largest step of I from a cell to one beside it: what a tremble of the camera moves a part of. */
static int contrast_at(const struct tsr_change *change, unsigned x, unsigned y)
{
    const uint8_t *now = change->state + y * change->cells_x + x;
    const ptrdiff_t row = change->cells_x;
    int left = x > 0 ? tsr_change_distance(now[0], now[-1]) : 0;
    int right = x + 1u < change->cells_x ? tsr_change_distance(now[0], now[1]) : 0;
    int above = y > 0 ? tsr_change_distance(now[0], now[-row]) : 0;
    int below = y + 1u < change->cells_y ? tsr_change_distance(now[0], now[row]) : 0;
    return tsr_change_larger(tsr_change_larger(left, right), tsr_change_larger(above, below));
}

static bool is_watched(const struct tsr_change_config *config, unsigned x, unsigned y)
{
    unsigned side = config->reduction;
    bool watched = config->watched_count == 0;
    for (unsigned i = 0; i < config->watched_count && !watched; i++) {
        const struct tsr_rectangle *area = &config->watched[i];
        watched = x * side < (unsigned)area->x + area->width && x * side + side > area->x &&
                  y * side < (unsigned)area->y + area->height && y * side + side > area->y;
    }
    return watched;
}

bool tsr_change_counts(const struct tsr_change *change, unsigned x, unsigned y, int excess)
{
    bool beyond_any_edge = excess > UINT8_MAX >> EDGE_DOUBT_LOG2;
    return is_watched(&change->config, x, y) &&
           (beyond_any_edge || excess > contrast_at(change, x, y) >> EDGE_DOUBT_LOG2);
}

/* From start over the marks, depth first. A visited cell holds the direction it was entered by instead of I. */
static unsigned walk_region(struct tsr_change *change, unsigned start, unsigned wanted)
{
    unsigned cells = tsr_change_cells(change);
    uint8_t *entered = change->state;
    uint8_t *marks = change->state + (size_t)2 * cells;
    int columns = change->cells_x;
    int x = (int)start % columns;
    int y = (int)start / columns;
    unsigned count = 1;
    entered[start] = ITSELF;
    marks[start] &= (uint8_t)~TSR_CHANGE_MARK;
    while (count < wanted) {
        unsigned way = 0;
        for (; way < AROUND; way++) {
            int to_x = x + (int)(way % 3u) - 1;
            int to_y = y + (int)(way / 3u) - 1;
            if (to_x >= 0 && to_x < columns && to_y >= 0 && to_y < change->cells_y &&
                (marks[to_y * columns + to_x] & TSR_CHANGE_MARK) != 0) {
                break;
            }
        }
        bool onward = way < AROUND;
        unsigned taken = onward ? way : entered[y * columns + x];
        if (!onward && taken == ITSELF) {
            break;
        }
        int sign = onward ? 1 : -1;
        x += sign * ((int)(taken % 3u) - 1);
        y += sign * ((int)(taken / 3u) - 1);
        if (onward) {
            entered[y * columns + x] = (uint8_t)way;
            marks[y * columns + x] &= (uint8_t)~TSR_CHANGE_MARK;
            count++;
        }
    }
    return count;
}

bool tsr_change_has_region(struct tsr_change *change, unsigned min_cells)
{
    unsigned cells = tsr_change_cells(change);
    const uint8_t *marks = change->state + (size_t)2 * cells;
    for (unsigned i = 0; i < cells; i++) {
        if ((marks[i] & TSR_CHANGE_MARK) != 0 && walk_region(change, i, min_cells) >= min_cells) {
            return true;
        }
    }
    return false;
}
