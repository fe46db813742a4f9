/*
 * Contents of random gray images.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_CONTENT_H
#define TSR_TESTS_CODEC_CONTENT_H

#include "codec_random.h"

enum content {
    CONTENT_FLAT,
    CONTENT_CHECKER,
    CONTENT_NOISE,
    CONTENT_SLOPE,
    CONTENT_BLOCKS,
    CONTENT_EXTREMES,
    CONTENT_COUNT
};

static inline uint8_t pick(struct codec_random *random, enum content content, unsigned x, unsigned y)
{
    switch (content) {
    case CONTENT_FLAT: return 77;
    case CONTENT_CHECKER: return (x + y) % 2 == 0 ? 0 : 255;
    case CONTENT_NOISE: return (uint8_t)codec_random_next(random);
    case CONTENT_SLOPE: return (uint8_t)(x + 2 * y + codec_random_below(random, 6));
    case CONTENT_BLOCKS: return (uint8_t)((x / 9) * 70 + (y / 5) * 110 + codec_random_below(random, 3));
    default: return codec_random_below(random, 2) == 0 ? 0 : 255;
    }
}

#endif
