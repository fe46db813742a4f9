/*
 * The window of the MVE kernel: one step to the next column, sixteen lanes d at
 * once, and the searches among its sums.
 *
 *   column += |left_new - right_new| - |left_old - right_old|
 *   sums   += column - leave
 *
 * Loops are tail-predicated by bytes, so that a last group of eight lanes needs
 * no code of its own: the eight bytes that are left are the lower half of a
 * vector, and so are the four even and the four odd sums that come of them.
 *
 * 16-bit sums are kept as keys, S << 3 | d / 16, so that the least key names the
 * least sum and the lowest group that has it. Even lanes lie apart from odd
 * ones, as VSHLLB and VSHLLT take bytes apart:
 *
 *   even [D / 2] | pad [8] | odd [D / 2] | pad [8]         pads: above every sum
 *
 * The sums beside lane d are then neighbours in the other array, one word. A key
 * that its pixel may not choose has bit 15 set.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_MVE_WINDOW_H
#define TSR_VISION_MATCH_MVE_WINDOW_H

#include <stdint.h>

#define MVE_GROUP 16u
#define MVE_PAD 8u
#define MVE_KEY_SHIFT 3
#define MVE_KEY_BARRED 0x8000u
_Static_assert(TSR_DISPARITY_COUNT_MAX / MVE_GROUP <= 1u << MVE_KEY_SHIFT, "a group's number fits below the sum");

/* A column and where it meets the right rows: all pointers to lane 0. */
struct mve_step {
    const uint8_t *right_new;
    const uint8_t *right_old;
    uint8_t *column;
    const uint8_t *leave;
    unsigned left_new;
    unsigned left_old;
};

/* clang-format off */
#define MVE_BEGIN                     \
    "vdup.8 q4, %[left_new]\n\t"      \
    "vdup.8 q5, %[left_old]\n\t"      \
    "vmov.i8 q6, #0xff\n\t"           \
    "dlstp.8 lr, %[lanes]\n"          \
    "1:\n\t"
#define MVE_LOAD_RUN                        \
    "vldrb.u8 q0, [%[right_new]], #16\n\t"  \
    "vldrb.u8 q1, [%[right_old]], #16\n\t"
/* Lanes whose right pixel lies left of the picture take its first one: eq. (11). */
#define MVE_LOAD_CLIPPED                    \
    "vidup.u8 q3, %[least], #1\n\t"          \
    "vmin.u8 q3, q3, q7\n\t"                \
    "vldrb.u8 q0, [%[right_new], q3]\n\t"   \
    "vldrb.u8 q1, [%[right_old], q3]\n\t"
/* q0 = column - leave, with the column moved down */
#define MVE_MOVE_COLUMN                     \
    "vabd.u8 q0, q0, q4\n\t"                \
    "vldrb.u8 q2, [%[column]]\n\t"          \
    "vabd.u8 q1, q1, q5\n\t"                \
    "vadd.i8 q0, q0, q2\n\t"                \
    "vsub.i8 q0, q0, q1\n\t"                \
    "vstrb.8 q0, [%[column]], #16\n\t"      \
    "vldrb.u8 q3, [%[leave]], #16\n\t"      \
    "vsub.i8 q0, q0, q3\n\t"
#define MVE_MOVE_KEYS                       \
    "vldrh.u16 q1, [%[even]]\n\t"           \
    "vshllb.s8 q2, q0, #3\n\t"              \
    "vldrh.u16 q3, [%[odd]]\n\t"            \
    "vadd.i16 q1, q1, q2\n\t"               \
    "vshllt.s8 q0, q0, #3\n\t"              \
    "vstrh.16 q1, [%[even]], #16\n\t"       \
    "vadd.i16 q3, q3, q0\n\t"               \
    "vmin.u16 q6, q6, q1\n\t"               \
    "vstrh.16 q3, [%[odd]], #16\n\t"        \
    "vmin.u16 q6, q6, q3\n\t"               \
    "letp lr, 1b\n\t"                       \
    "mvn %[least], #0\n\t"                  \
    "vminv.u16 %[least], q6"
#define MVE_MOVE_SUMS                       \
    "vldrb.u8 q1, [%[sums]]\n\t"            \
    "vadd.i8 q1, q1, q0\n\t"                \
    "vstrb.8 q1, [%[sums]], #16\n\t"        \
    "vmin.u8 q6, q6, q1\n\t"                \
    "letp lr, 1b\n\t"                       \
    "mvn %[least], #0\n\t"                  \
    "vminv.u8 %[least], q6"
#define MVE_STEP_OPERANDS                                                                            \
    [right_new] "+r"(step.right_new), [right_old] "+r"(step.right_old), [column] "+r"(step.column),  \
    [leave] "+r"(step.leave)
#define MVE_STEP_INPUTS [left_new] "r"(step.left_new), [left_old] "r"(step.left_old), [lanes] "r"(lanes)
/* clang-format on */

/* One step of 16-bit sums; the least key. */
static inline unsigned mve_move_keys(struct mve_step step, unsigned lanes, uint16_t *even, uint16_t *odd)
{
    unsigned least;
    __asm volatile(MVE_BEGIN MVE_LOAD_RUN MVE_MOVE_COLUMN MVE_MOVE_KEYS
                   : MVE_STEP_OPERANDS, [even] "+r"(even), [odd] "+r"(odd), [least] "=r"(least)
                   : MVE_STEP_INPUTS
                   : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "lr", "memory");
    return least;
}

/* The same where lanes above limit meet the pixel of lane limit. */
static inline unsigned mve_move_clipped_keys(struct mve_step step, unsigned lanes, unsigned limit, uint16_t *even,
                                             uint16_t *odd)
{
    unsigned least = 0; /* before that, the lane */
    __asm volatile("vdup.8 q7, %[limit]\n\t" MVE_BEGIN MVE_LOAD_CLIPPED MVE_MOVE_COLUMN MVE_MOVE_KEYS
                   : MVE_STEP_OPERANDS, [even] "+r"(even), [odd] "+r"(odd), [least] "+Te"(least)
                   : MVE_STEP_INPUTS, [limit] "r"(limit)
                   : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "q7", "lr", "memory");
    return least;
}

/* One step of 8-bit sums; the least one. */
static inline unsigned mve_move_sums(struct mve_step step, unsigned lanes, uint8_t *sums)
{
    unsigned least;
    __asm volatile(MVE_BEGIN MVE_LOAD_RUN MVE_MOVE_COLUMN MVE_MOVE_SUMS
                   : MVE_STEP_OPERANDS, [sums] "+r"(sums), [least] "=r"(least)
                   : MVE_STEP_INPUTS
                   : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "lr", "memory");
    return least;
}

static inline void mve_move_clipped_sums(struct mve_step step, unsigned lanes, unsigned limit, uint8_t *sums)
{
    unsigned least = 0; /* before that, the lane */
    __asm volatile("vdup.8 q7, %[limit]\n\t" MVE_BEGIN MVE_LOAD_CLIPPED MVE_MOVE_COLUMN MVE_MOVE_SUMS
                   : MVE_STEP_OPERANDS, [sums] "+r"(sums), [least] "+Te"(least)
                   : MVE_STEP_INPUTS, [limit] "r"(limit)
                   : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "q7", "lr", "memory");
}

static inline unsigned mve_find_least_key(const uint16_t *even, const uint16_t *odd, unsigned lanes)
{
    unsigned least;
    __asm volatile("vmov.i8 q2, #0xff\n\t"
                   "dlstp.8 lr, %[lanes]\n"
                   "1:\n\t"
                   "vldrh.u16 q0, [%[even]], #16\n\t"
                   "vldrh.u16 q1, [%[odd]], #16\n\t"
                   "vmin.u16 q2, q2, q0\n\t"
                   "vmin.u16 q2, q2, q1\n\t"
                   "letp lr, 1b\n\t"
                   "mvn %[least], #0\n\t"
                   "vminv.u16 %[least], q2"
                   : [even] "+r"(even), [odd] "+r"(odd), [least] "=r"(least)
                   : [lanes] "r"(lanes)
                   : "q0", "q1", "q2", "lr", "memory");
    return least;
}

static inline unsigned mve_find_least_sum(const uint8_t *sums, unsigned lanes)
{
    unsigned least;
    __asm volatile("vmov.i8 q1, #0xff\n\t"
                   "dlstp.8 lr, %[lanes]\n"
                   "1:\n\t"
                   "vldrb.u8 q0, [%[sums]], #16\n\t"
                   "vmin.u8 q1, q1, q0\n\t"
                   "letp lr, 1b\n\t"
                   "mvn %[least], #0\n\t"
                   "vminv.u8 %[least], q1"
                   : [sums] "+r"(sums), [least] "=r"(least)
                   : [lanes] "r"(lanes)
                   : "q0", "q1", "lr", "memory");
    return least;
}

/* The lowest lane of a group whose key is the given one. A predicate has two bits a 16-bit lane. */
static inline unsigned mve_find_lane(const uint16_t *even, const uint16_t *odd, unsigned key)
{
    unsigned evens, odds;
    __asm volatile("vldrh.u16 q0, [%[even]]\n\t"
                   "vldrh.u16 q1, [%[odd]]\n\t"
                   "vcmp.i16 eq, q0, %[key]\n\t"
                   "vmrs %[evens], p0\n\t"
                   "vcmp.i16 eq, q1, %[key]\n\t"
                   "vmrs %[odds], p0"
                   : [evens] "=&r"(evens), [odds] "=r"(odds)
                   : [even] "r"(even), [odd] "r"(odd), [key] "r"(key)
                   : "q0", "q1", "memory", "cc");
    return (unsigned)__builtin_ctz((evens & 0x55555555u) | (odds & 0xaaaaaaaau));
}

/* The lowest lane that has the sum; there is one. */
static inline unsigned mve_find_lane_of_sum(const uint8_t *sums, unsigned sum)
{
    unsigned equal;
    const uint8_t *at = sums;
    do {
        __asm volatile("vldrb.u8 q0, [%[at]], #16\n\t"
                       "vcmp.i8 eq, q0, %[sum]\n\t"
                       "vmrs %[equal], p0"
                       : [at] "+r"(at), [equal] "=r"(equal)
                       : [sum] "r"(sum)
                       : "q0", "memory", "cc");
    } while (equal == 0);
    return (unsigned)(at - sums) - MVE_GROUP + (unsigned)__builtin_ctz(equal);
}

#endif
