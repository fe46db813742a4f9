/*
 * The cells of change detection: what every cell of every frame goes through.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "change_cells.h"

#include <string.h>

#include "change_bytes.h"
#if defined(__SSE2__)
#include "change_sse2.h"
#endif

/* Ours, chosen on scenes made of ten pictures and on vtest.avi: docs/change.md. */
#define VOTER_STEP 7u  /* every seventh cell has a vote: they spread over the columns of usual widths */
#define VOTER_MIN 16u  /* darker, a gray level is too large a part of M */
#define VOTER_MAX 239u /* brighter, M has lost what was clipped */
#define VOTERS_MIN 8u  /* of fewer, an object may be most */
#define LIGHT_MIN_Q8 128u
#define LIGHT_MAX_Q8 512u
#define BRIGHT 192 /* from here on some pixels of a cell may be clipped */
#define LIGHT_DOUBT_LOG2 2
#define RISE_SETTLING 4
#define SLOW_BEATS 8u /* a power of two, so that the beat may wrap */

#define BLOCK 4u

static uint32_t sum_block(const uint8_t *pixels, size_t stride)
{
    uint32_t sum = 0;
    for (unsigned y = 0; y < BLOCK; y++) {
        uint32_t word;
        memcpy(&word, pixels + y * stride, sizeof word);
        sum = tsr_change_add_bytes(sum, word);
    }
    return sum;
}

static uint32_t sum_cell(const uint8_t *pixels, size_t stride, unsigned side)
{
    if (side < BLOCK) {
        return (uint32_t)pixels[0] + pixels[1] + pixels[stride] + pixels[stride + 1];
    }
    uint32_t sum = sum_block(pixels, stride);
    if (side > BLOCK) {
        const uint8_t *below = pixels + BLOCK * stride;
        sum += sum_block(pixels + BLOCK, stride) + sum_block(below, stride) + sum_block(below + BLOCK, stride);
    }
    return sum;
}

void tsr_change_reduce(const struct tsr_change *change, const struct tsr_gray_view *frame, uint8_t *means)
{
    unsigned side = change->config.reduction;
    unsigned area_log2 = side == 2 ? 2u : side == 4 ? 4u : 6u;
    uint32_t half = 1u << (area_log2 - 1u);
    size_t stride = frame->stride;
    unsigned cells_x = change->cells_x;
    const uint8_t *row = frame->pixels;
    for (unsigned y = 0; y < change->cells_y; y++, row += side * stride) {
        unsigned x = 0;
#if defined(__SSE2__)
        for (; side == BLOCK && (x + BLOCK) <= cells_x; x += BLOCK, means += BLOCK) {
            tsr_change_mean_blocks(row + (size_t)x * side, stride, means);
        }
#endif
        for (; x < cells_x; x++) {
            uint32_t sum = sum_cell(row + (size_t)x * side, stride, side);
            *means++ = (uint8_t)((sum + half) >> area_log2);
        }
    }
}

static bool has_vote(uint8_t mean)
{
    return mean >= VOTER_MIN && mean <= VOTER_MAX;
}

/* Voters that became brighter than light_q8 says, less those that did not. */
static int count_votes(const uint8_t *now, const uint8_t *mean, unsigned cells, unsigned light_q8)
{
    int votes = 0;
    for (unsigned i = 0; i < cells; i += VOTER_STEP) {
        if (has_vote(mean[i])) {
            votes += now[i] * TSR_CHANGE_LIGHT_ONE_Q8 > mean[i] * light_q8 ? 1 : -1;
        }
    }
    return votes;
}

/* Bisection: no cell's ratio is kept, so this needs neither memory nor divisions. */
unsigned tsr_change_measure_light(const struct tsr_change *change)
{
    unsigned cells = tsr_change_cells(change);
    const uint8_t *now = change->state;
    const uint8_t *mean = now + cells;
    if (count_votes(now, mean, cells, UINT16_MAX) > -(int)VOTERS_MIN) { /* nobody: all against */
        return TSR_CHANGE_LIGHT_ONE_Q8;
    }
    unsigned low = LIGHT_MIN_Q8;
    unsigned high = LIGHT_MAX_Q8;
    while (low < high) {
        unsigned middle = (low + high) / 2u;
        if (count_votes(now, mean, cells, middle) > 0) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

static int clip(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* What all cells of a frame share. By value: a store to M could be one to anything behind a pointer. */
struct rule {
    unsigned light_q8;
    int amplification;
    int low;
    int high;
    int rise;
    bool slow;
};

/* Eqs. (27), (7), (8), (28). By how much D exceeds V; 0 if it does not. */
static int follow_cell(struct rule rule, int gray, uint8_t *mean, uint8_t *deviation)
{
    int before = *mean;
    int expected = (int)((*mean * rule.light_q8 + TSR_CHANGE_LIGHT_ONE_Q8 / 2u) / TSR_CHANGE_LIGHT_ONE_Q8);
    expected = expected < UINT8_MAX ? expected : UINT8_MAX;
    int lit = tsr_change_distance(expected, before);
    int step = 1 + (tsr_change_larger(expected, before) >= BRIGHT ? lit : lit >> LIGHT_DOUBT_LOG2);
    int away = tsr_change_distance(gray, expected) - step;
    int spread = *deviation & ~TSR_CHANGE_MARK;
    if (away <= 0) { /* M reaches I: D = 0 */
        *mean = (uint8_t)gray;
        *deviation = (uint8_t)tsr_change_larger(spread - 1, rule.low);
        return 0;
    }
    spread = clip(spread + clip(rule.amplification * away - spread, -1, rule.rise), rule.low, rule.high);
    *deviation = (uint8_t)spread;
    bool apart = away > spread;
    bool waits = apart && rule.slow;
    *mean = (uint8_t)(waits ? expected : gray > expected ? expected + step : expected - step);
    return apart ? away - spread : 0;
}

unsigned tsr_change_follow(struct tsr_change *change, unsigned light_q8)
{
    const struct tsr_change_config *config = &change->config;
    const struct rule rule = {light_q8,
                              config->amplification,
                              config->deviation_min,
                              config->deviation_max,
                              change->frames < config->settle_frames ? RISE_SETTLING : 1,
                              change->beat % SLOW_BEATS != 0};
    unsigned cells_x = change->cells_x;
    unsigned cells = tsr_change_cells(change);
    const uint8_t *now = change->state;
    uint8_t *mean = change->state + cells;
    uint8_t *deviation = mean + cells;
    unsigned changed = 0;
    for (unsigned y = 0; y < change->cells_y; y++) {
        for (unsigned x = 0; x < cells_x; x++, now++, mean++, deviation++) {
            int excess = follow_cell(rule, *now, mean, deviation);
            if (excess != 0 && tsr_change_counts(change, x, y, excess)) {
                *deviation |= TSR_CHANGE_MARK;
                changed++;
            }
        }
    }
    return changed;
}
