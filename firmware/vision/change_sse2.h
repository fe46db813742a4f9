/*
 * Means of blocks of 4 x 4 pixels with SSE2: sixteen columns at a time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_CHANGE_SSE2_H
#define TSR_VISION_CHANGE_SSE2_H

#include <emmintrin.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define TSR_CHANGE_COLUMNS 16u

/* Four means, rounded to nearest, ties up, of what four rows from pixels on hold in TSR_CHANGE_COLUMNS columns. */
static inline void tsr_change_mean_blocks(const uint8_t *pixels, size_t stride, uint8_t *means)
{
    const __m128i low = _mm_set1_epi16(0xff);
    __m128i pairs = _mm_setzero_si128(); /* sums of two columns, at most 4 * 510 */
    for (unsigned y = 0; y < 4; y++) {
        const __m128i row = _mm_loadu_si128((const __m128i *)(const void *)(pixels + y * stride));
        pairs = _mm_add_epi16(pairs, _mm_add_epi16(_mm_and_si128(row, low), _mm_srli_epi16(row, 8)));
    }
    const __m128i sums = _mm_madd_epi16(pairs, _mm_set1_epi16(1));
    const __m128i rounded = _mm_srli_epi32(_mm_add_epi32(sums, _mm_set1_epi32(8)), 4);
    const __m128i bytes = _mm_packus_epi16(_mm_packs_epi32(rounded, rounded), rounded);
    const int four = _mm_cvtsi128_si32(bytes);
    memcpy(means, &four, sizeof four);
}

#endif
