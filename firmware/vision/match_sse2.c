/*
 * The matcher's kernel for x86-64, whose SSE2 every one has: 16 disparities at once.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_X86

#include <emmintrin.h>

#define VECTOR_LANES 16u
typedef __m128i vec8;
typedef __m128i vec16;

#define INLINE static inline __attribute__((always_inline))

INLINE vec8 load8(const uint8_t *at)
{
    return _mm_loadu_si128((const __m128i *)(const void *)at);
}

INLINE void store8(uint8_t *at, vec8 a)
{
    _mm_storeu_si128((__m128i *)(void *)at, a);
}

INLINE void store16(int16_t *at, vec16 a)
{
    _mm_storeu_si128((__m128i *)(void *)at, a);
}

INLINE vec8 splat8(uint8_t a)
{
    return _mm_set1_epi8((char)a);
}

INLINE vec16 splat16(int16_t a)
{
    return _mm_set1_epi16(a);
}

INLINE vec8 difference8(vec8 a, vec8 b)
{
    return _mm_sub_epi8(_mm_max_epu8(a, b), _mm_min_epu8(a, b));
}

INLINE vec8 add8(vec8 a, vec8 b)
{
    return _mm_add_epi8(a, b);
}

INLINE vec8 subtract8(vec8 a, vec8 b)
{
    return _mm_sub_epi8(a, b);
}

INLINE vec16 add16(vec16 a, vec16 b)
{
    return _mm_add_epi16(a, b);
}

INLINE vec16 min16(vec16 a, vec16 b)
{
    return _mm_min_epi16(a, b);
}

INLINE vec16 even16(vec8 a)
{
    return _mm_srai_epi16(_mm_slli_epi16(a, 8), 8);
}

INLINE vec16 odd16(vec8 a)
{
    return _mm_srai_epi16(a, 8);
}

INLINE vec16 least16(vec16 a, unsigned *sum)
{
    a = _mm_min_epi16(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(1, 0, 3, 2)));
    a = _mm_min_epi16(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(2, 3, 0, 1)));
    a = _mm_min_epi16(a, _mm_shufflelo_epi16(a, _MM_SHUFFLE(2, 3, 0, 1)));
    *sum = (unsigned)_mm_cvtsi128_si32(a) & 0xffffu;
    return _mm_shuffle_epi32(_mm_shufflelo_epi16(a, 0), 0);
}

INLINE uint64_t interleave_masks(vec16 even, vec16 odd)
{
    const __m128i low_bytes = _mm_set1_epi16(0x00ff);
    return (uint32_t)_mm_movemask_epi8(_mm_or_si128(_mm_and_si128(even, low_bytes), _mm_andnot_si128(low_bytes, odd)));
}

INLINE uint64_t mask_equal(vec16 even, vec16 odd, vec16 a)
{
    return interleave_masks(_mm_cmpeq_epi16(even, a), _mm_cmpeq_epi16(odd, a));
}

INLINE uint64_t mask_above(vec16 even, vec16 odd, vec16 a)
{
    return interleave_masks(_mm_cmpgt_epi16(even, a), _mm_cmpgt_epi16(odd, a));
}

/* Lanes first, first + 2, ... */
INLINE vec16 index16(int first)
{
    const __m128i twos = _mm_setr_epi16(0, 2, 4, 6, 8, 10, 12, 14);
    return _mm_add_epi16(twos, _mm_set1_epi16((int16_t)first));
}

INLINE vec16 choose_lanes(vec16 mask, vec16 a, vec16 b)
{
    return _mm_or_si128(_mm_and_si128(mask, a), _mm_andnot_si128(mask, b));
}

INLINE vec16 select_above(int first, int x, vec16 a, vec16 b)
{
    return choose_lanes(_mm_cmpgt_epi16(index16(first), _mm_set1_epi16((int16_t)x)), a, b);
}

INLINE vec16 select_equal(int first, int x, vec16 a, vec16 b)
{
    return choose_lanes(_mm_cmpeq_epi16(index16(first), _mm_set1_epi16((int16_t)x)), a, b);
}

#include "match_vector_row.h"

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    struct winners winners;
    switch ((match->config.disparities + VECTOR_LANES - 1u) / VECTOR_LANES) {
    case 1: find_winners_of(match, y_new, y_old, 1, &winners); break;
    case 2: find_winners_of(match, y_new, y_old, 2, &winners); break;
    case 3: find_winners_of(match, y_new, y_old, 3, &winners); break;
    case 4: find_winners_of(match, y_new, y_old, 4, &winners); break;
    case 5: find_winners_of(match, y_new, y_old, 5, &winners); break;
    case 6: find_winners_of(match, y_new, y_old, 6, &winners); break;
    case 7: find_winners_of(match, y_new, y_old, 7, &winners); break;
    default: find_winners_of(match, y_new, y_old, 8, &winners); break;
    }
    finish_row(match, y, y_new, y_old, &winners);
}

const struct tsr_match_kernel tsr_match_kernel_sse2 = {
    .name = "sse2",
    .prefilter_row = tsr_match_prefilter_row,
    .add_row = tsr_match_add_row,
    .match_row = match_row,
    TSR_MATCH_PORTABLE_CENSUS,
};
#endif
