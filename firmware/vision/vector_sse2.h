/*
 * Vectors of 16 bytes on x86-64, whose SSE2 every one has: the operations that
 * the kernels in vectors are written in. vector_avx2.h and vector_neon.h give
 * the same ones; a source file includes one of them.
 *
 *   VECTOR_LEN, vec8, vec16      bytes in a vector; of uint8_t, of int16_t
 *   load8 store8 load16_anywhere store16_anywhere
 *   load8_aligned load16 store16 at multiples of VECTOR_LEN
 *   load_wide(at)                VECTOR_LEN / 2 bytes, widened
 *   narrow(low, high)            bytes again, saturated at 0 and 255
 *   splat8 splat16 reverse8; load_splat16(at) may read four bytes
 *   gather16(table, index)       VECTOR_LEN / 2 elements
 *   add8 subtract8 add16 subtract16 multiply16 (low half) min16 max16
 *   and16 or16 xor16 SHIFT_...16
 *   multiply_high16(a, b)        the high half, of unsigned numbers
 *   difference8(a, b)            |a - b|, unsigned
 *   min8 add_saturated8 xor8     of unsigned bytes
 *   at_most8(a, b)               bytes of ones where a <= b, unsigned
 *   count_bits8(a)               bits set in each byte
 *   quarter8(a)                  a / 4, unsigned
 *   before8(a, previous)         bytes moved up by a lane, behind the last of previous
 *   behind8(a, next)             moved down by a lane, before the first of next
 *   spread_least8(a)             the least byte, unsigned, in every byte
 *   first_byte8(a)
 *   above16(a, b), equal16       lanes of ones where a > b, signed; where equal
 *   keep_counts16(a, b, kept)    into 2 KEPT_COUNTS of 16 bits, aligned, what the next one needs;
 *                                lanes in -128 .. 0 and at most 255 in all
 *   find_counts16(kept)          of VECTOR_LEN / 2 vectors so kept, 0 less the sum of their lanes
 *   probe_index8(a)              of nibbles in bytes, what probe4() takes
 *   probe_difference4(probe4(i), a)      |n - a|, where i is the index of n
 *   pair_lanes(a)                lanes in order to the order of LANE_PAIR
 *   first_times16, second_times16(a)     16 times the bytes with a sign
 *   keep_least16(a, kept)        into KEPT_LANES of 16 bits, aligned, what the next one needs
 *   least_lanes(vectors)         lanes that are told apart where a pixel has so many vectors
 *                                of bytes: a power of two, and D <= 16 times that
 *   find_least16(kept, lanes, &least, &lane)     of VECTOR_LEN / 2 vectors so kept, in the order
 *                                of lanes: the least number, plus 2^15, and the
 *                                first lane modulo lanes that has it
 *
 * Where lanes are widened a vector of bytes becomes two: lanes first to
 * first + VECTOR_LEN / 2 - 1 and the others. With LANE_PAIR = 1 they are lanes in
 * order; otherwise bytes 2 i and 2 i + 1 hold lanes i and i + LANE_PAIR.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_VECTOR_SSE2_H
#define TSR_VISION_VECTOR_SSE2_H

#include <emmintrin.h>
#include <stdint.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))
#define VECTOR_LEN 16u
#define LANE_PAIR 1u
#define KEPT_COUNTS 4u
typedef __m128i vec8;
typedef __m128i vec16;

INLINE vec8 load8(const uint8_t *at)
{
    return _mm_loadu_si128((const __m128i *)(const void *)at);
}

INLINE vec8 load8_aligned(const uint8_t *at)
{
    return _mm_load_si128((const __m128i *)(const void *)at);
}

INLINE void store8(uint8_t *at, vec8 a)
{
    _mm_storeu_si128((__m128i *)(void *)at, a);
}

INLINE vec16 load16(const int16_t *at)
{
    return _mm_load_si128((const __m128i *)(const void *)at);
}

INLINE vec16 load16_anywhere(const int16_t *at)
{
    return _mm_loadu_si128((const __m128i *)(const void *)at);
}

INLINE void store16(int16_t *at, vec16 a)
{
    _mm_store_si128((__m128i *)(void *)at, a);
}

INLINE void store16_anywhere(int16_t *at, vec16 a)
{
    _mm_storeu_si128((__m128i *)(void *)at, a);
}

INLINE vec16 load_wide(const uint8_t *at)
{
    return _mm_unpacklo_epi8(_mm_loadl_epi64((const __m128i *)(const void *)at), _mm_setzero_si128());
}

INLINE vec8 narrow(vec16 low, vec16 high)
{
    return _mm_packus_epi16(low, high);
}

INLINE vec8 reverse8(vec8 a)
{
    a = _mm_or_si128(_mm_slli_epi16(a, 8), _mm_srli_epi16(a, 8));
    a = _mm_shufflehi_epi16(_mm_shufflelo_epi16(a, _MM_SHUFFLE(0, 1, 2, 3)), _MM_SHUFFLE(0, 1, 2, 3));
    return _mm_shuffle_epi32(a, _MM_SHUFFLE(1, 0, 3, 2));
}

INLINE vec8 splat8(uint8_t a)
{
    return _mm_set1_epi8((char)a);
}

INLINE vec16 splat16(int16_t a)
{
    return _mm_set1_epi16(a);
}

INLINE int load_word(const int16_t *at)
{
    int word;
    memcpy(&word, at, sizeof word);
    return word;
}

INLINE vec16 load_splat16(const int16_t *at)
{
    return _mm_shuffle_epi32(_mm_shufflelo_epi16(_mm_cvtsi32_si128(load_word(at)), 0), 0);
}

INLINE vec16 gather16(const uint16_t *table, const uint16_t *index)
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

INLINE vec8 add8(vec8 a, vec8 b)
{
    return _mm_add_epi8(a, b);
}

INLINE vec8 subtract8(vec8 a, vec8 b)
{
    return _mm_sub_epi8(a, b);
}

INLINE vec8 difference8(vec8 a, vec8 b)
{
    return _mm_sub_epi8(_mm_max_epu8(a, b), _mm_min_epu8(a, b));
}

INLINE vec8 min8(vec8 a, vec8 b)
{
    return _mm_min_epu8(a, b);
}

INLINE vec8 add_saturated8(vec8 a, vec8 b)
{
    return _mm_adds_epu8(a, b);
}

INLINE vec8 xor8(vec8 a, vec8 b)
{
    return _mm_xor_si128(a, b);
}

INLINE vec8 at_most8(vec8 a, vec8 b)
{
    return _mm_cmpeq_epi8(_mm_min_epu8(a, b), a);
}

/* Fields of 2, 4 and 8 bits. */
INLINE vec8 count_bits8(vec8 a)
{
    const __m128i twos = _mm_set1_epi8(0x55);
    const __m128i fours = _mm_set1_epi8(0x33);
    a = _mm_sub_epi8(a, _mm_and_si128(_mm_srli_epi16(a, 1), twos));
    a = _mm_add_epi8(_mm_and_si128(a, fours), _mm_and_si128(_mm_srli_epi16(a, 2), fours));
    return _mm_and_si128(_mm_add_epi8(a, _mm_srli_epi16(a, 4)), _mm_set1_epi8(0x0f));
}

INLINE vec8 quarter8(vec8 a)
{
    return _mm_and_si128(_mm_srli_epi16(a, 2), _mm_set1_epi8(0x3f));
}

INLINE vec8 before8(vec8 a, vec8 previous)
{
    return _mm_or_si128(_mm_slli_si128(a, 1), _mm_srli_si128(previous, 15));
}

INLINE vec8 behind8(vec8 a, vec8 next)
{
    return _mm_or_si128(_mm_srli_si128(a, 1), _mm_slli_si128(next, 15));
}

INLINE vec8 spread_least8(vec8 a)
{
    a = _mm_min_epu8(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(1, 0, 3, 2)));
    a = _mm_min_epu8(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(2, 3, 0, 1)));
    a = _mm_min_epu8(a, _mm_or_si128(_mm_slli_epi32(a, 16), _mm_srli_epi32(a, 16)));
    return _mm_min_epu8(a, _mm_or_si128(_mm_slli_epi16(a, 8), _mm_srli_epi16(a, 8)));
}

INLINE uint8_t first_byte8(vec8 a)
{
    return (uint8_t)_mm_cvtsi128_si32(a);
}

/* 0 less the counts, modulo 256. */
INLINE void keep_counts16(vec16 a, vec16 b, int16_t *kept)
{
    store16(kept, _mm_sad_epu8(_mm_packs_epi16(a, b), _mm_setzero_si128()));
}

INLINE vec8 probe_index8(vec8 nibbles)
{
    return _mm_slli_epi16(nibbles, 4);
}

INLINE vec8 probe4(uint8_t index)
{
    static const _Alignas(16) uint64_t splats[16][2] = {
#define SPLAT(n) {(n)*UINT64_C(0x0101010101010101), (n)*UINT64_C(0x0101010101010101)}
        SPLAT(0), SPLAT(1), SPLAT(2),  SPLAT(3),  SPLAT(4),  SPLAT(5),  SPLAT(6),  SPLAT(7),
        SPLAT(8), SPLAT(9), SPLAT(10), SPLAT(11), SPLAT(12), SPLAT(13), SPLAT(14), SPLAT(15),
#undef SPLAT
    };
    return _mm_load_si128((const __m128i *)(const void *)((const uint8_t *)splats + index));
}

INLINE vec8 probe_difference4(vec8 probe, vec8 nibbles)
{
    return difference8(probe, nibbles);
}

INLINE vec8 pair_lanes(vec8 a)
{
    return a;
}

INLINE vec16 first_times16(vec8 a)
{
    return _mm_srai_epi16(_mm_unpacklo_epi8(_mm_setzero_si128(), a), 4);
}

INLINE vec16 second_times16(vec8 a)
{
    return _mm_srai_epi16(_mm_unpackhi_epi8(_mm_setzero_si128(), a), 4);
}

INLINE vec16 add16(vec16 a, vec16 b)
{
    return _mm_add_epi16(a, b);
}

INLINE vec16 subtract16(vec16 a, vec16 b)
{
    return _mm_sub_epi16(a, b);
}

INLINE vec16 multiply16(vec16 a, vec16 b)
{
    return _mm_mullo_epi16(a, b);
}

INLINE vec16 multiply_high16(vec16 a, vec16 b)
{
    return _mm_mulhi_epu16(a, b);
}

INLINE vec16 min16(vec16 a, vec16 b)
{
    return _mm_min_epi16(a, b);
}

INLINE vec16 max16(vec16 a, vec16 b)
{
    return _mm_max_epi16(a, b);
}

INLINE vec16 above16(vec16 a, vec16 b)
{
    return _mm_cmpgt_epi16(a, b);
}

INLINE vec16 equal16(vec16 a, vec16 b)
{
    return _mm_cmpeq_epi16(a, b);
}

INLINE vec16 and16(vec16 a, vec16 b)
{
    return _mm_and_si128(a, b);
}

INLINE vec16 or16(vec16 a, vec16 b)
{
    return _mm_or_si128(a, b);
}

INLINE vec16 xor16(vec16 a, vec16 b)
{
    return _mm_xor_si128(a, b);
}

#define SHIFT_LEFT16(a, n) _mm_slli_epi16(a, n)
#define SHIFT_RIGHT16(a, n) _mm_srai_epi16(a, n)
#define SHIFT_RIGHT_UNSIGNED16(a, n) _mm_srli_epi16(a, n)

INLINE vec16 find_counts16(const int16_t *kept)
{
    __m128i low = _mm_packs_epi32(load16(kept), load16(kept + 8));
    __m128i high = _mm_packs_epi32(load16(kept + 16), load16(kept + 24));
    __m128i counts = _mm_sub_epi16(_mm_setzero_si128(), _mm_packs_epi32(low, high));
    return _mm_and_si128(counts, _mm_set1_epi16(255));
}

INLINE vec16 zip_low16(vec16 a, vec16 b)
{
    return _mm_unpacklo_epi16(a, b);
}

INLINE vec16 zip_high16(vec16 a, vec16 b)
{
    return _mm_unpackhi_epi16(a, b);
}

#include "vector_least.h"

#endif
