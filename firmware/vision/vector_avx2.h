/*
 * Vectors of 32 bytes on x86-64 with AVX2, as vector_sse2.h describes them.
 * Included where the compiler may use "avx2".
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_VECTOR_AVX2_H
#define TSR_VISION_VECTOR_AVX2_H

#include <immintrin.h>
#include <stdint.h>

#define INLINE static inline __attribute__((always_inline))
#define VECTOR_LEN 32u
#define LANE_PAIR 16u
#define KEPT_LANES 2u
#define KEPT_COUNTS 4u
typedef __m256i vec8;
typedef __m256i vec16;

INLINE vec8 load8(const uint8_t *at)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)at);
}

INLINE vec8 load8_aligned(const uint8_t *at)
{
    return _mm256_load_si256((const __m256i *)(const void *)at);
}

INLINE void store8(uint8_t *at, vec8 a)
{
    _mm256_storeu_si256((__m256i *)(void *)at, a);
}

INLINE vec16 load16(const int16_t *at)
{
    return _mm256_load_si256((const __m256i *)(const void *)at);
}

INLINE vec16 load16_anywhere(const int16_t *at)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)at);
}

INLINE void store16(int16_t *at, vec16 a)
{
    _mm256_store_si256((__m256i *)(void *)at, a);
}

INLINE void store16_anywhere(int16_t *at, vec16 a)
{
    _mm256_storeu_si256((__m256i *)(void *)at, a);
}

INLINE vec16 load_wide(const uint8_t *at)
{
    return _mm256_cvtepu8_epi16(_mm_loadu_si128((const __m128i *)(const void *)at));
}

INLINE vec8 narrow(vec16 low, vec16 high)
{
    return _mm256_permute4x64_epi64(_mm256_packus_epi16(low, high), _MM_SHUFFLE(3, 1, 2, 0));
}

INLINE vec8 reverse8(vec8 a)
{
    const __m256i last_first = _mm256_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 15, 14, 13, 12,
                                                11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    return _mm256_permute4x64_epi64(_mm256_shuffle_epi8(a, last_first), _MM_SHUFFLE(1, 0, 3, 2));
}

INLINE vec8 splat8(uint8_t a)
{
    return _mm256_set1_epi8((char)a);
}

INLINE vec16 splat16(int16_t a)
{
    return _mm256_set1_epi16(a);
}

INLINE vec16 load_splat16(const int16_t *at)
{
    return _mm256_set1_epi16(*at);
}

INLINE __m128i gather_half(const uint16_t *table, const uint16_t *index)
{
    __m128i found = _mm_cvtsi32_si128(table[index[0]]);
    found = _mm_insert_epi16(found, (int16_t)table[index[1]], 1);
    found = _mm_insert_epi16(found, (int16_t)table[index[2]], 2);
    found = _mm_insert_epi16(found, (int16_t)table[index[3]], 3);
    found = _mm_insert_epi16(found, (int16_t)table[index[4]], 4);
    found = _mm_insert_epi16(found, (int16_t)table[index[5]], 5);
    found = _mm_insert_epi16(found, (int16_t)table[index[6]], 6);
    return _mm_insert_epi16(found, (int16_t)table[index[7]], 7);
}

INLINE vec16 gather16(const uint16_t *table, const uint16_t *index)
{
    return _mm256_set_m128i(gather_half(table, index + 8), gather_half(table, index));
}

INLINE vec8 add8(vec8 a, vec8 b)
{
    return _mm256_add_epi8(a, b);
}

INLINE vec8 subtract8(vec8 a, vec8 b)
{
    return _mm256_sub_epi8(a, b);
}

INLINE vec8 difference8(vec8 a, vec8 b)
{
    return _mm256_sub_epi8(_mm256_max_epu8(a, b), _mm256_min_epu8(a, b));
}

INLINE vec8 min8(vec8 a, vec8 b)
{
    return _mm256_min_epu8(a, b);
}

INLINE vec8 add_saturated8(vec8 a, vec8 b)
{
    return _mm256_adds_epu8(a, b);
}

INLINE vec8 xor8(vec8 a, vec8 b)
{
    return _mm256_xor_si256(a, b);
}

INLINE vec8 at_most8(vec8 a, vec8 b)
{
    return _mm256_cmpeq_epi8(_mm256_min_epu8(a, b), a);
}

/* A shuffle looks up nibbles. */
INLINE vec8 count_bits8(vec8 a)
{
    const __m256i counts = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1, 2, 2, 3, 1,
                                            2, 2, 3, 2, 3, 3, 4);
    const __m256i nibble = _mm256_set1_epi8(0x0f);
    __m256i low = _mm256_shuffle_epi8(counts, _mm256_and_si256(a, nibble));
    return _mm256_add_epi8(low, _mm256_shuffle_epi8(counts, _mm256_and_si256(_mm256_srli_epi16(a, 4), nibble)));
}

INLINE vec8 quarter8(vec8 a)
{
    return _mm256_and_si256(_mm256_srli_epi16(a, 2), _mm256_set1_epi8(0x3f));
}

INLINE vec8 before8(vec8 a, vec8 previous)
{
    return _mm256_alignr_epi8(a, _mm256_permute2x128_si256(previous, a, 0x21), 15);
}

INLINE vec8 behind8(vec8 a, vec8 next)
{
    return _mm256_alignr_epi8(_mm256_permute2x128_si256(a, next, 0x21), a, 1);
}

/* The instruction finds the least of eight numbers of 16 bits. */
INLINE vec8 spread_least8(vec8 a)
{
    __m128i half = _mm_min_epu8(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    half = _mm_minpos_epu16(_mm_min_epu8(half, _mm_srli_epi16(half, 8)));
    return _mm256_broadcastb_epi8(half);
}

INLINE uint8_t first_byte8(vec8 a)
{
    return (uint8_t)_mm256_cvtsi256_si32(a);
}

/* 0 less the counts, modulo 256. */
INLINE void keep_counts16(vec16 a, vec16 b, int16_t *kept)
{
    __m256i sums = _mm256_sad_epu8(_mm256_packs_epi16(a, b), _mm256_setzero_si256());
    __m128i both = _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
    _mm_store_si128((__m128i *)(void *)kept, both);
}

INLINE vec16 find_counts16(const int16_t *kept)
{
    __m256i low = _mm256_packs_epi32(load16(kept), load16(kept + 16));
    __m256i high = _mm256_packs_epi32(load16(kept + 32), load16(kept + 48));
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    __m256i counts = _mm256_permutevar8x32_epi32(_mm256_packs_epi32(low, high), order);
    return _mm256_and_si256(_mm256_sub_epi16(_mm256_setzero_si256(), counts), _mm256_set1_epi16(255));
}

INLINE vec8 probe_index8(vec8 nibbles)
{
    return _mm256_sub_epi8(_mm256_set1_epi8(16), nibbles);
}

/* A nibble's differences to all nibbles, so that a shuffle looks them up. */
INLINE vec8 probe4(uint8_t index)
{
    static const _Alignas(16) int8_t counting[32] = {16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6,  5,  4,  3,  2,  1,
                                                     0,  1,  2,  3,  4,  5,  6,  7, 8, 9, 10, 11, 12, 13, 14, 15};
    return _mm256_broadcastsi128_si256(_mm_loadu_si128((const __m128i *)(const void *)(counting + index)));
}

INLINE vec8 probe_difference4(vec8 probe, vec8 nibbles)
{
    return _mm256_shuffle_epi8(probe, nibbles);
}

INLINE vec8 pair_lanes(vec8 a)
{
    const __m256i zip = _mm256_setr_epi8(0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15, 0, 8, 1, 9, 2, 10, 3, 11,
                                         4, 12, 5, 13, 6, 14, 7, 15);
    return _mm256_shuffle_epi8(_mm256_permute4x64_epi64(a, _MM_SHUFFLE(3, 1, 2, 0)), zip);
}

INLINE vec16 first_times16(vec8 a)
{
    return _mm256_maddubs_epi16(_mm256_set1_epi16(0x0010), a);
}

INLINE vec16 second_times16(vec8 a)
{
    return _mm256_maddubs_epi16(_mm256_set1_epi16(0x1000), a);
}

INLINE vec16 add16(vec16 a, vec16 b)
{
    return _mm256_add_epi16(a, b);
}

INLINE vec16 subtract16(vec16 a, vec16 b)
{
    return _mm256_sub_epi16(a, b);
}

INLINE vec16 multiply16(vec16 a, vec16 b)
{
    return _mm256_mullo_epi16(a, b);
}

INLINE vec16 multiply_high16(vec16 a, vec16 b)
{
    return _mm256_mulhi_epu16(a, b);
}

INLINE vec16 min16(vec16 a, vec16 b)
{
    return _mm256_min_epi16(a, b);
}

INLINE vec16 max16(vec16 a, vec16 b)
{
    return _mm256_max_epi16(a, b);
}

INLINE vec16 above16(vec16 a, vec16 b)
{
    return _mm256_cmpgt_epi16(a, b);
}

INLINE vec16 equal16(vec16 a, vec16 b)
{
    return _mm256_cmpeq_epi16(a, b);
}

INLINE vec16 and16(vec16 a, vec16 b)
{
    return _mm256_and_si256(a, b);
}

INLINE vec16 or16(vec16 a, vec16 b)
{
    return _mm256_or_si256(a, b);
}

INLINE vec16 xor16(vec16 a, vec16 b)
{
    return _mm256_xor_si256(a, b);
}

#define SHIFT_LEFT16(a, n) _mm256_slli_epi16(a, n)
#define SHIFT_RIGHT16(a, n) _mm256_srai_epi16(a, n)
#define SHIFT_RIGHT_UNSIGNED16(a, n) _mm256_srli_epi16(a, n)

/* The instruction finds the least unsigned number, and the first lane that has it. */
INLINE void keep_least16(vec16 a, int16_t *kept)
{
    __m128i half = _mm_min_epi16(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    __m128i found = _mm_minpos_epu16(_mm_xor_si128(half, _mm_set1_epi16(INT16_MIN)));
    _mm_storeu_si32(kept, found);
}

INLINE unsigned least_lanes(unsigned vectors)
{
    (void)vectors;
    return 8;
}

INLINE void find_least16(const int16_t *kept, unsigned lanes_count, vec16 *least, vec16 *lane)
{
    (void)lanes_count;
    __m256i low = load16(kept);
    __m256i high = load16(kept + 16);
    __m256i leasts = _mm256_packs_epi32(_mm256_srai_epi32(_mm256_slli_epi32(low, 16), 16),
                                        _mm256_srai_epi32(_mm256_slli_epi32(high, 16), 16));
    __m256i lanes = _mm256_packs_epi32(_mm256_srli_epi32(low, 16), _mm256_srli_epi32(high, 16));
    *least = _mm256_permute4x64_epi64(leasts, _MM_SHUFFLE(3, 1, 2, 0));
    *lane = _mm256_permute4x64_epi64(lanes, _MM_SHUFFLE(3, 1, 2, 0));
}

#endif
