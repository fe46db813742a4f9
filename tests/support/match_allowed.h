/*
 * Which configurations the matcher takes, from the comments of match.h alone.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_MATCH_ALLOWED_H
#define TSR_TESTS_MATCH_ALLOWED_H

#include "tsr/vision/match.h"

static inline int match_is_within(unsigned value, unsigned least, unsigned most)
{
    return value >= least && value <= most;
}

/* Of a test's threshold: 0 is its default. */
static inline int match_is_threshold(uint8_t value, uint8_t most)
{
    return value <= most || value == TSR_MATCH_TEST_OFF;
}

static inline unsigned match_window_of(const struct tsr_match_config *config)
{
    const unsigned named = config->window != 0 ? config->window : 9u;
    return config->mode == TSR_MATCH_SMOOTH ? 7u : named;
}

/* What the comments of struct tsr_match_config allow. */
static inline int match_is_allowed(const struct tsr_match_config *config)
{
    const unsigned disparities = config->disparities != 0 ? config->disparities : 32u;
    const unsigned window = match_window_of(config);
    const int room = (int)config->width - (int)disparities;
    if (!match_is_within(disparities, 16, 128) || disparities % 8u != 0 || !match_is_within(window, 5, 15) ||
        window % 2u == 0 || !match_is_within(config->width, disparities, TSR_IMAGE_WIDTH_MAX) ||
        !match_is_within(config->height, window, TSR_IMAGE_HEIGHT_MAX) || config->mode > TSR_MATCH_SSD ||
        config->search_start_px < -room || config->search_start_px > room) {
        return 0;
    }
    if (!match_is_threshold(config->uniqueness_percent, 100) || !match_is_threshold(config->lr_tolerance_px, 127)) {
        return 0;
    }
    if (config->mode != TSR_MATCH_SAD && config->mode != TSR_MATCH_SAD8) {
        return 1; /* others ignore cap and texture */
    }
    const unsigned by_columns = 63u / window < 7u ? 63u / window : 7u;
    const unsigned by_window = 127u / (window * window);
    const unsigned cap_max = config->mode == TSR_MATCH_SAD8 && by_window < by_columns ? by_window : by_columns;
    return cap_max > 0 && config->prefilter_cap <= cap_max && match_is_threshold(config->texture_min, 127);
}

#endif
