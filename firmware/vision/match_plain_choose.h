/*
 * The choice of a pixel from the window sums of a plain mode. Included by
 * match_plain_sums.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
/* The disparities a pixel can search, lowest .. highest, and the best of them. */
struct winner {
    int lowest;
    int highest;
    int d;
};

/* docs/math.md, eq. (14). Two passes, each of which compilers turn into vector code. */
static struct winner find_winner(const struct tsr_match_config *config, const window_sum *sums, unsigned x)
{
    int lane_of_first = (int)x - config->search_start_px;
    int lowest = lane_of_first - (config->width - 1);
    struct winner winner = {lowest > 0 ? lowest : 0, config->disparities - 1, 0};
    winner.highest = lane_of_first < winner.highest ? lane_of_first : winner.highest;
    window_sum least = (window_sum)-1;
    for (int d = winner.lowest; d <= winner.highest; d++) {
        least = sums[d] < least ? sums[d] : least;
    }
    winner.d = winner.lowest;
    while (winner.d < winner.highest && sums[winner.d] != least) {
        winner.d++;
    }
    return winner;
}

/* docs/math.md, eq. (15). Sums within the limit beside d* are its own slope. */
static bool is_unique(const struct tsr_match_config *config, const window_sum *sums, struct winner winner)
{
    if (config->uniqueness_percent == TSR_MATCH_TEST_OFF) {
        return true;
    }
    uint32_t limit = (uint32_t)sums[winner.d] * (100u + config->uniqueness_percent) / 100u;
    unsigned own = 1;
    own += winner.d > winner.lowest && sums[winner.d - 1] <= limit ? 1u : 0u;
    own += winner.d < winner.highest && sums[winner.d + 1] <= limit ? 1u : 0u;
    window_sum largest = (window_sum)-1;
    window_sum within = limit < largest ? (window_sum)limit : largest;
    window_sum count = 0;
    for (int d = winner.lowest; d <= winner.highest; d++) {
        count = (window_sum)(count + (sums[d] <= within ? 1u : 0u));
    }
    return count == own;
}

/* docs/math.md, eq. (16) or (25): they differ in the divisor, which is not 0. */
static int find_offset_q4(const window_sum *sums, struct winner winner)
{
    if (winner.d <= winner.lowest || winner.d >= winner.highest) {
        return 0;
    }
    uint32_t below = (uint32_t)sums[winner.d - 1] - sums[winner.d];
    uint32_t above = (uint32_t)sums[winner.d + 1] - sums[winner.d];
    uint32_t divisor = offset_divisor(below, above);
    uint32_t lean = below > above ? below - above : above - below;
    int offset_q4 = (int)((16u * lean + divisor) / (2u * divisor));
    return below > above ? offset_q4 : -offset_q4;
}

static void choose(const struct tsr_match *match, unsigned x)
{
    const struct tsr_match_config *config = &match->config;
    const struct tsr_match_plain_scratch scratch = tsr_match_share_plain(match);
    const window_sum *sums = scratch.sums;
    struct winner winner = find_winner(config, sums, x);
    scratch.choices[x] = TSR_MATCH_CHOICE_NONE;
    if (winner.lowest > winner.highest) {
        return;
    }
    uint32_t *claimed = scratch.claims_wide + ((int)x - config->search_start_px - winner.d);
    uint32_t claim = (uint32_t)sums[winner.d] << 7 | (uint32_t)winner.d;
    *claimed = claim < *claimed ? claim : *claimed;
    if (is_unique(config, sums, winner)) {
        scratch.choices[x] = TSR_MATCH_CHOICE(winner.d, find_offset_q4(sums, winner));
    }
}
