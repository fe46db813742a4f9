/*
 * The matcher's kernel for x86-64 with AVX2: 32 disparities at once.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_X86

#include <immintrin.h>

#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,bmi,bmi2,popcnt"))), apply_to = function)
#else
#pragma GCC target("avx2,bmi,bmi2,popcnt")
#endif

#define VECTOR_LANES 32u
typedef __m256i vec8;
typedef __m256i vec16;

#define INLINE static inline __attribute__((always_inline))

INLINE vec8 load8(const uint8_t *at)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)at);
}

INLINE void store8(uint8_t *at, vec8 a)
{
    _mm256_storeu_si256((__m256i *)(void *)at, a);
}

INLINE void store16(int16_t *at, vec16 a)
{
    _mm256_storeu_si256((__m256i *)(void *)at, a);
}

INLINE vec8 splat8(uint8_t a)
{
    return _mm256_set1_epi8((char)a);
}

INLINE vec16 splat16(int16_t a)
{
    return _mm256_set1_epi16(a);
}

INLINE vec8 difference8(vec8 a, vec8 b)
{
    return _mm256_sub_epi8(_mm256_max_epu8(a, b), _mm256_min_epu8(a, b));
}

INLINE vec8 add8(vec8 a, vec8 b)
{
    return _mm256_add_epi8(a, b);
}

INLINE vec8 subtract8(vec8 a, vec8 b)
{
    return _mm256_sub_epi8(a, b);
}

INLINE vec16 add16(vec16 a, vec16 b)
{
    return _mm256_add_epi16(a, b);
}

INLINE vec16 min16(vec16 a, vec16 b)
{
    return _mm256_min_epi16(a, b);
}

INLINE vec16 even16(vec8 a)
{
    return _mm256_srai_epi16(_mm256_slli_epi16(a, 8), 8);
}

INLINE vec16 odd16(vec8 a)
{
    return _mm256_srai_epi16(a, 8);
}

/* Sums are not negative, so the unsigned minimum serves. */
INLINE vec16 least16(vec16 a, unsigned *sum)
{
    __m128i half = _mm_min_epi16(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    __m128i least = _mm_minpos_epu16(half);
    *sum = (unsigned)_mm_cvtsi128_si32(least) & 0xffffu; /* above it stands which lane it was */
    return _mm256_broadcastw_epi16(least);
}

INLINE uint64_t interleave_masks(vec16 even, vec16 odd)
{
    const __m256i low_bytes = _mm256_set1_epi16(0x00ff);
    return (uint32_t)_mm256_movemask_epi8(
        _mm256_or_si256(_mm256_and_si256(even, low_bytes), _mm256_andnot_si256(low_bytes, odd)));
}

INLINE uint64_t mask_equal(vec16 even, vec16 odd, vec16 a)
{
    return interleave_masks(_mm256_cmpeq_epi16(even, a), _mm256_cmpeq_epi16(odd, a));
}

INLINE uint64_t mask_above(vec16 even, vec16 odd, vec16 a)
{
    return interleave_masks(_mm256_cmpgt_epi16(even, a), _mm256_cmpgt_epi16(odd, a));
}

/* Lanes first, first + 2, ... */
INLINE vec16 index16(int first)
{
    const __m256i twos = _mm256_setr_epi16(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    return _mm256_add_epi16(twos, _mm256_set1_epi16((int16_t)first));
}

INLINE vec16 select_above(int first, int x, vec16 a, vec16 b)
{
    return _mm256_blendv_epi8(b, a, _mm256_cmpgt_epi16(index16(first), _mm256_set1_epi16((int16_t)x)));
}

INLINE vec16 select_equal(int first, int x, vec16 a, vec16 b)
{
    return _mm256_blendv_epi8(b, a, _mm256_cmpeq_epi16(index16(first), _mm256_set1_epi16((int16_t)x)));
}

#include "match_vector_row.h"

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    struct winners winners;
    switch ((match->config.disparities + VECTOR_LANES - 1u) / VECTOR_LANES) {
    case 1:
        if (match->config.disparities < VECTOR_LANES) {
            tsr_match_kernel_sse2.match_row(match, y, y_new, y_old);
            return;
        }
        find_winners_of(match, y_new, y_old, 1, &winners);
        break;
    case 2: find_winners_of(match, y_new, y_old, 2, &winners); break;
    case 3: find_winners_of(match, y_new, y_old, 3, &winners); break;
    default: find_winners_of(match, y_new, y_old, 4, &winners); break;
    }
    finish_row(match, y, y_new, y_old, &winners);
}

const struct tsr_match_kernel tsr_match_kernel_avx2 = {
    .name = "avx2",
    .prefilter_row = tsr_match_prefilter_row,
    .add_row = tsr_match_add_row,
    .match_row = match_row,
    TSR_MATCH_PORTABLE_CENSUS,
};

#ifdef __clang__
#pragma clang attribute pop
#endif
#endif
