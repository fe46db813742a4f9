/*
 * The plain modes of the matcher: their scratch, the order of their rows, and the
 * choice of a pixel from 32-bit sums.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_plain.h"

#include <string.h>

/* The disparities a pixel can search, lowest .. highest, and the best of them. */
struct winner {
    int lowest;
    int highest;
    int d;
};

bool tsr_match_is_plain(uint8_t mode)
{
    return mode == TSR_MATCH_RAW || mode == TSR_MATCH_SSD;
}

static size_t columns_alone_len(const struct tsr_match_config *config)
{
    size_t sum_len = config->mode == TSR_MATCH_RAW ? TSR_MATCH_RAW_SUM_LEN : TSR_MATCH_SSD_SUM_LEN;
    return sum_len * config->width * config->disparities;
}

size_t tsr_match_plain_columns_len(const struct tsr_match_config *config)
{
    return columns_alone_len(config) + sizeof(uint32_t) * config->width;
}

size_t tsr_match_plain_met_len(const struct tsr_match_config *config)
{
    return 2u * ((size_t)config->width + config->disparities);
}

struct tsr_match_plain_scratch tsr_match_share_plain(const struct tsr_match *match)
{
    struct tsr_match_scratch common = tsr_match_share_scratch(match);
    size_t width = match->config.width;
    struct tsr_match_plain_scratch scratch;
    scratch.sums = (uint32_t *)(void *)common.sums;
    scratch.claims_wide = (uint32_t *)(void *)(common.columns + columns_alone_len(&match->config));
    scratch.claims = common.claims;
    scratch.choices = common.choices;
    scratch.met[0] = common.texture + width;
    scratch.met[1] = scratch.met[0] + width + match->config.disparities;
    return scratch;
}

void tsr_match_mirror_row(const struct tsr_match *match, unsigned y, unsigned which)
{
    int last = match->config.width - 1;
    int count = last + match->config.disparities;
    const uint8_t *right = match->right.pixels + (size_t)y * match->right.stride;
    uint8_t *met = tsr_match_share_plain(match).met[which];
    for (int k = 0; k < count; k++) {
        int column = last - match->config.search_start_px - k;
        met[k] = right[column < 0 ? 0 : column < last ? column : last];
    }
}

/* docs/math.md, eq. (14). */
static struct winner find_winner(const struct tsr_match_config *config, const uint32_t *sums, unsigned x)
{
    int lane_of_first = (int)x - config->search_start_px;
    int lowest = lane_of_first - (config->width - 1);
    struct winner winner = {lowest > 0 ? lowest : 0, config->disparities - 1, 0};
    winner.highest = lane_of_first < winner.highest ? lane_of_first : winner.highest;
    winner.d = winner.lowest;
    for (int d = winner.lowest + 1; d <= winner.highest; d++) {
        winner.d = sums[d] < sums[winner.d] ? d : winner.d;
    }
    return winner;
}

/* docs/math.md, eq. (15). */
static bool is_unique(const struct tsr_match_config *config, const uint32_t *sums, struct winner winner)
{
    if (config->uniqueness_percent == TSR_MATCH_TEST_OFF) {
        return true;
    }
    uint32_t limit = sums[winner.d] * (100u + config->uniqueness_percent) / 100u;
    bool unique = true;
    for (int d = winner.lowest; d <= winner.highest; d++) {
        bool own = d >= winner.d - 1 && d <= winner.d + 1;
        unique = unique && (own || sums[d] > limit);
    }
    return unique;
}

/* docs/math.md, eq. (16), or (25) of a parabola; both have a form with one divisor that is not 0. */
static int find_offset_q4(const struct tsr_match_config *config, const uint32_t *sums, struct winner winner)
{
    if (winner.d <= winner.lowest || winner.d >= winner.highest) {
        return 0;
    }
    uint32_t least = sums[winner.d];
    uint32_t below = sums[winner.d - 1] - least;
    uint32_t above = sums[winner.d + 1] - least;
    uint32_t larger = below > above ? below : above;
    uint32_t divisor = config->mode == TSR_MATCH_SSD ? below + above : larger;
    uint32_t lean = below > above ? below - above : above - below;
    int offset_q4 = (int)((16u * lean + divisor) / (2u * divisor));
    return below > above ? offset_q4 : -offset_q4;
}

void tsr_match_choose_plain(const struct tsr_match *match, unsigned x)
{
    const struct tsr_match_config *config = &match->config;
    const struct tsr_match_plain_scratch scratch = tsr_match_share_plain(match);
    struct winner winner = find_winner(config, scratch.sums, x);
    scratch.choices[x] = TSR_MATCH_CHOICE_NONE;
    if (winner.lowest > winner.highest) {
        return;
    }
    uint32_t *claimed = scratch.claims_wide + ((int)x - config->search_start_px - winner.d);
    uint32_t claim = scratch.sums[winner.d] << 7 | (uint32_t)winner.d;
    *claimed = claim < *claimed ? claim : *claimed;
    if (is_unique(config, scratch.sums, winner)) {
        scratch.choices[x] = TSR_MATCH_CHOICE(winner.d, find_offset_q4(config, scratch.sums, winner));
    }
}

/* Of a claim, writing a row needs only the disparity. */
static void finish_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_plain_scratch scratch = tsr_match_share_plain(match);
    for (unsigned x = 0; x < match->config.width; x++) {
        scratch.claims[x] = (uint16_t)TSR_MATCH_CLAIM_D(scratch.claims_wide[x]);
    }
    tsr_match_write_row(match, y);
}

unsigned tsr_match_plain_rows_total(const struct tsr_match_config *config)
{
    return config->height + config->window / 2u;
}

void tsr_match_plain_step(const struct tsr_match *match, unsigned step)
{
    const struct tsr_match_plain_sums *plain =
        match->config.mode == TSR_MATCH_RAW ? &tsr_match_raw_sums : &tsr_match_ssd_sums;
    unsigned radius = match->config.window / 2u;
    unsigned last = match->config.height - 1u;
    if (step < radius) { /* row 0 r + 2 times, rows 1 .. r - 1 once, as in a window */
        if (step == 0) {
            memset(tsr_match_share_scratch(match).columns, 0, columns_alone_len(&match->config));
        }
        tsr_match_mirror_row(match, step, 0);
        plain->add_row(match, step, step == 0 ? radius + 2u : 1u);
        return;
    }
    unsigned y = step - radius;
    unsigned y_new = y + radius < last ? y + radius : last;
    unsigned y_old = y > radius ? y - radius - 1u : 0u;
    tsr_match_mirror_row(match, y_new, 0);
    tsr_match_mirror_row(match, y_old, 1);
    memset(tsr_match_share_plain(match).claims_wide, 0xff, sizeof(uint32_t) * match->config.width);
    plain->choose_row(match, y_new, y_old);
    finish_row(match, y);
}
