/*
 * The plain modes of the matcher: their scratch and the order of their rows.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_plain.h"

#include <string.h>

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
    scratch.sums = common.sums;
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

/* Of a claim, writing a row needs only the disparity. */
static void finish_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_plain_scratch scratch = tsr_match_share_plain(match);
    for (unsigned x = 0; x < match->config.width; x++) {
        scratch.claims[x] = (uint16_t)TSR_MATCH_CLAIM_D(scratch.claims_wide[x]);
    }
    tsr_match_write_row(match, y);
}

static unsigned rows_total(const struct tsr_match_config *config)
{
    return config->height + config->window / 2u;
}

static void step(const struct tsr_match *match, unsigned row)
{
    const struct tsr_match_plain_sums *plain =
        match->config.mode == TSR_MATCH_RAW ? &tsr_match_raw_sums : &tsr_match_ssd_sums;
    unsigned radius = match->config.window / 2u;
    unsigned last = match->config.height - 1u;
    if (row < radius) { /* row 0 r + 2 times, rows 1 .. r - 1 once, as in a window */
        if (row == 0) {
            memset(tsr_match_share_scratch(match).columns, 0, columns_alone_len(&match->config));
        }
        tsr_match_mirror_row(match, row, 0);
        plain->add_row(match, row, row == 0 ? radius + 2u : 1u);
        return;
    }
    unsigned y = row - radius;
    unsigned y_new = y + radius < last ? y + radius : last;
    unsigned y_old = y > radius ? y - radius - 1u : 0u;
    tsr_match_mirror_row(match, y_new, 0);
    tsr_match_mirror_row(match, y_old, 1);
    memset(tsr_match_share_plain(match).claims_wide, 0xff, sizeof(uint32_t) * match->config.width);
    plain->choose_row(match, y_new, y_old);
    finish_row(match, y);
}

const struct tsr_match_method tsr_match_method_plain = {rows_total, step};
