/*
 * Vectors of 16 bytes on AArch64, as vector_sse2.h describes them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_VECTOR_NEON_H
#define TSR_VISION_VECTOR_NEON_H

#include <arm_neon.h>
#include <stdint.h>

#define INLINE static inline __attribute__((always_inline))
#define VECTOR_LEN 16u
#define LANE_PAIR 1u
#define KEPT_COUNTS 1u
typedef uint8x16_t vec8;
typedef int16x8_t vec16;

INLINE vec8 load8(const uint8_t *at)
{
    return vld1q_u8(at);
}

INLINE vec8 load8_aligned(const uint8_t *at)
{
    return vld1q_u8(at);
}

INLINE void store8(uint8_t *at, vec8 a)
{
    vst1q_u8(at, a);
}

INLINE vec16 load16(const int16_t *at)
{
    return vld1q_s16(at);
}

INLINE vec16 load16_anywhere(const int16_t *at)
{
    return vld1q_s16(at);
}

INLINE void store16(int16_t *at, vec16 a)
{
    vst1q_s16(at, a);
}

INLINE void store16_anywhere(int16_t *at, vec16 a)
{
    vst1q_s16(at, a);
}

INLINE vec16 load_wide(const uint8_t *at)
{
    return vreinterpretq_s16_u16(vmovl_u8(vld1_u8(at)));
}

INLINE vec8 narrow(vec16 low, vec16 high)
{
    return vcombine_u8(vqmovun_s16(low), vqmovun_s16(high));
}

INLINE vec8 reverse8(vec8 a)
{
    vec8 halves = vrev64q_u8(a);
    return vextq_u8(halves, halves, 8);
}

INLINE vec8 splat8(uint8_t a)
{
    return vdupq_n_u8(a);
}

INLINE vec16 splat16(int16_t a)
{
    return vdupq_n_s16(a);
}

INLINE vec16 load_splat16(const int16_t *at)
{
    return vld1q_dup_s16(at);
}

INLINE vec16 gather16(const uint16_t *table, const uint16_t *index)
{
    uint16x8_t found = vdupq_n_u16(table[index[0]]);
    found = vld1q_lane_u16(table + index[1], found, 1);
    found = vld1q_lane_u16(table + index[2], found, 2);
    found = vld1q_lane_u16(table + index[3], found, 3);
    found = vld1q_lane_u16(table + index[4], found, 4);
    found = vld1q_lane_u16(table + index[5], found, 5);
    found = vld1q_lane_u16(table + index[6], found, 6);
    return vreinterpretq_s16_u16(vld1q_lane_u16(table + index[7], found, 7));
}

INLINE vec8 add8(vec8 a, vec8 b)
{
    return vaddq_u8(a, b);
}

INLINE vec8 subtract8(vec8 a, vec8 b)
{
    return vsubq_u8(a, b);
}

INLINE vec8 difference8(vec8 a, vec8 b)
{
    return vabdq_u8(a, b);
}

INLINE vec8 min8(vec8 a, vec8 b)
{
    return vminq_u8(a, b);
}

INLINE vec8 add_saturated8(vec8 a, vec8 b)
{
    return vqaddq_u8(a, b);
}

INLINE vec8 xor8(vec8 a, vec8 b)
{
    return veorq_u8(a, b);
}

INLINE vec8 at_most8(vec8 a, vec8 b)
{
    return vcleq_u8(a, b);
}

INLINE vec8 count_bits8(vec8 a)
{
    return vcntq_u8(a);
}

INLINE vec8 quarter8(vec8 a)
{
    return vshrq_n_u8(a, 2);
}

INLINE vec8 before8(vec8 a, vec8 previous)
{
    return vextq_u8(previous, a, 15);
}

INLINE vec8 behind8(vec8 a, vec8 next)
{
    return vextq_u8(a, next, 1);
}

INLINE vec8 spread_least8(vec8 a)
{
    return vdupq_n_u8(vminvq_u8(a));
}

INLINE uint8_t first_byte8(vec8 a)
{
    return vgetq_lane_u8(a, 0);
}

INLINE void keep_counts16(vec16 a, vec16 b, int16_t *kept)
{
    kept[0] = (int16_t)-vaddvq_s16(a);
    kept[1] = (int16_t)-vaddvq_s16(b);
}

INLINE vec16 find_counts16(const int16_t *kept)
{
    return vld1q_s16(kept);
}

INLINE vec8 probe_index8(vec8 nibbles)
{
    return nibbles;
}

INLINE vec8 probe4(uint8_t index)
{
    return vdupq_n_u8(index);
}

INLINE vec8 probe_difference4(vec8 probe, vec8 nibbles)
{
    return vabdq_u8(probe, nibbles);
}

INLINE vec8 pair_lanes(vec8 a)
{
    return a;
}

INLINE vec16 first_times16(vec8 a)
{
    return vshll_n_s8(vreinterpret_s8_u8(vget_low_u8(a)), 4);
}

INLINE vec16 second_times16(vec8 a)
{
    return vshll_high_n_s8(vreinterpretq_s8_u8(a), 4);
}

INLINE vec16 add16(vec16 a, vec16 b)
{
    return vaddq_s16(a, b);
}

INLINE vec16 subtract16(vec16 a, vec16 b)
{
    return vsubq_s16(a, b);
}

INLINE vec16 multiply16(vec16 a, vec16 b)
{
    return vmulq_s16(a, b);
}

INLINE vec16 multiply_high16(vec16 a, vec16 b)
{
    uint16x8_t x = vreinterpretq_u16_s16(a);
    uint16x8_t y = vreinterpretq_u16_s16(b);
    uint16x4_t low = vshrn_n_u32(vmull_u16(vget_low_u16(x), vget_low_u16(y)), 16);
    return vreinterpretq_s16_u16(vcombine_u16(low, vshrn_n_u32(vmull_high_u16(x, y), 16)));
}

INLINE vec16 min16(vec16 a, vec16 b)
{
    return vminq_s16(a, b);
}

INLINE vec16 max16(vec16 a, vec16 b)
{
    return vmaxq_s16(a, b);
}

INLINE vec16 above16(vec16 a, vec16 b)
{
    return vreinterpretq_s16_u16(vcgtq_s16(a, b));
}

INLINE vec16 equal16(vec16 a, vec16 b)
{
    return vreinterpretq_s16_u16(vceqq_s16(a, b));
}

INLINE vec16 and16(vec16 a, vec16 b)
{
    return vandq_s16(a, b);
}

INLINE vec16 or16(vec16 a, vec16 b)
{
    return vorrq_s16(a, b);
}

INLINE vec16 xor16(vec16 a, vec16 b)
{
    return veorq_s16(a, b);
}

INLINE vec16 zip_low16(vec16 a, vec16 b)
{
    return vzip1q_s16(a, b);
}

INLINE vec16 zip_high16(vec16 a, vec16 b)
{
    return vzip2q_s16(a, b);
}

#define SHIFT_LEFT16(a, n) vshlq_n_s16(a, n)
#define SHIFT_RIGHT16(a, n) vshrq_n_s16(a, n)
#define SHIFT_RIGHT_UNSIGNED16(a, n) vreinterpretq_s16_u16(vshrq_n_u16(vreinterpretq_u16_s16(a), n))

#include "vector_least.h"

#endif
