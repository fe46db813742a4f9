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

#include <stddef.h>
#include <stdint.h>

#include "match_mve.h"

#define MVE_PAD 8u
#define MVE_KEY_SHIFT 3
#define MVE_KEY_BARRED 0x8000u
_Static_assert(TSR_DISPARITY_COUNT_MAX / TSR_MVE_GROUP <= 1u << MVE_KEY_SHIFT, "a group's number fits below the sum");

/*
 * Before a step the pointers are those of the column before; a step moves them
 * by one column. right_new and right_old point to lane 0's pixel of mirrored
 * rows. The order is that of the registers that the steps load.
 */
struct mve_window {
    const uint8_t *left_new;
    const uint8_t *left_old;
    const uint8_t *right_new;
    const uint8_t *right_old;
    uint8_t *column;
    const uint8_t *leave;
    void *even; /* or all 8-bit sums */
    uint16_t *odd;
    uint32_t lanes; /* D, from column to column */
    uint32_t limit; /* lanes above it meet the pixel of this one, where a step asks */
};
_Static_assert(sizeof(struct mve_window) == 10 * sizeof(uint32_t), "words, as the steps load them");

/* clang-format off */
#define MVE_BEGIN(registers)          \
    "ldm %[window], {" registers "}\n\t" \
    "ldrb lr, [r0, #1]!\n\t"          \
    "vdup.8 q4, lr\n\t"               \
    "ldrb lr, [r1, #1]!\n\t"          \
    "vdup.8 q5, lr\n\t"               \
    "subs r2, #1\n\t"                 \
    "subs r3, #1\n\t"                 \
    "add r4, r9\n\t"                  \
    "add r5, r9\n\t"                  \
    "stm %[window], {r0-r5}\n\t"      \
    "vmov.i8 q6, #0xff\n\t"
#define MVE_LOAD_RUN                  \
    "dlstp.8 lr, r9\n"                \
    "1:\n\t"                          \
    "vldrb.u8 q0, [r2], #16\n\t"      \
    "vldrb.u8 q1, [r3], #16\n\t"
/* Lanes whose right pixel lies left of the picture take its first one: eq. (11). */
#define MVE_LOAD_CLIPPED              \
    "vdup.8 q7, r10\n\t"              \
    "mov r10, #0\n\t"                 \
    "dlstp.8 lr, r9\n"                \
    "1:\n\t"                          \
    "vidup.u8 q3, r10, #1\n\t"        \
    "vmin.u8 q3, q3, q7\n\t"          \
    "vldrb.u8 q0, [r2, q3]\n\t"       \
    "vldrb.u8 q1, [r3, q3]\n\t"
/* q0 = column - leave, with the column moved down */
#define MVE_MOVE_COLUMN               \
    "vabd.u8 q0, q0, q4\n\t"          \
    "vldrb.u8 q2, [r4]\n\t"           \
    "vabd.u8 q1, q1, q5\n\t"          \
    "vadd.i8 q0, q0, q2\n\t"          \
    "vsub.i8 q0, q0, q1\n\t"          \
    "vstrb.8 q0, [r4], #16\n\t"       \
    "vldrb.u8 q3, [r5], #16\n\t"      \
    "vsub.i8 q0, q0, q3\n\t"
#define MVE_MOVE_KEYS                 \
    "vldrh.u16 q1, [r6]\n\t"          \
    "vshllb.s8 q2, q0, #3\n\t"        \
    "vldrh.u16 q3, [r8]\n\t"          \
    "vadd.i16 q1, q1, q2\n\t"         \
    "vshllt.s8 q0, q0, #3\n\t"        \
    "vstrh.16 q1, [r6], #16\n\t"      \
    "vadd.i16 q3, q3, q0\n\t"         \
    "vmin.u16 q6, q6, q1\n\t"         \
    "vstrh.16 q3, [r8], #16\n\t"      \
    "vmin.u16 q6, q6, q3\n\t"         \
    "letp lr, 1b\n\t"                 \
    "mvn %[least], #0\n\t"            \
    "vminv.u16 %[least], q6"
#define MVE_MOVE_SUMS                 \
    "vldrb.u8 q1, [r6]\n\t"           \
    "vadd.i8 q1, q1, q0\n\t"          \
    "vstrb.8 q1, [r6], #16\n\t"       \
    "vmin.u8 q6, q6, q1\n\t"          \
    "letp lr, 1b\n\t"                 \
    "mvn %[least], #0\n\t"            \
    "vminv.u8 %[least], q6"
#define MVE_RUN "r0-r6, r8, r9"
#define MVE_CLIPPED "r0-r6, r8-r10"
#define MVE_CLOBBERED                                                                                        \
    "r0", "r1", "r2", "r3", "r4", "r5", "r6", "r8", "r9", "lr", "q0", "q1", "q2", "q3", "q4", "q5", "q6",    \
    "cc", "memory"
/* clang-format on */

/* One step of 16-bit sums; the least key. */
static inline unsigned mve_move_keys(struct mve_window *window)
{
    unsigned least;
    __asm volatile(MVE_BEGIN(MVE_RUN) MVE_LOAD_RUN MVE_MOVE_COLUMN MVE_MOVE_KEYS
                   : [least] "=h"(least)
                   : [window] "h"(window)
                   : MVE_CLOBBERED);
    return least;
}

/* The same, obeying limit. */
static inline unsigned mve_move_clipped_keys(struct mve_window *window)
{
    unsigned least;
    __asm volatile(MVE_BEGIN(MVE_CLIPPED) MVE_LOAD_CLIPPED MVE_MOVE_COLUMN MVE_MOVE_KEYS
                   : [least] "=h"(least)
                   : [window] "h"(window)
                   : MVE_CLOBBERED, "r10", "q7");
    return least;
}

/* One step of 8-bit sums; the least one. */
static inline unsigned mve_move_sums(struct mve_window *window)
{
    unsigned least;
    __asm volatile(MVE_BEGIN(MVE_RUN) MVE_LOAD_RUN MVE_MOVE_COLUMN MVE_MOVE_SUMS
                   : [least] "=h"(least)
                   : [window] "h"(window)
                   : MVE_CLOBBERED);
    return least;
}

static inline void mve_move_clipped_sums(struct mve_window *window)
{
    unsigned least;
    __asm volatile(MVE_BEGIN(MVE_CLIPPED) MVE_LOAD_CLIPPED MVE_MOVE_COLUMN MVE_MOVE_SUMS
                   : [least] "=h"(least)
                   : [window] "h"(window)
                   : MVE_CLOBBERED, "r10", "q7");
}

/* Keys of the sums of a column taken times over, all barred. */
static inline void mve_fill_keys(uint16_t *even, uint16_t *odd, unsigned lanes, const uint8_t *column, unsigned times)
{
    unsigned base = MVE_KEY_BARRED;
    __asm volatile("vdup.8 q2, %[scale]\n\t"
                   "dlstp.8 lr, %[lanes]\n"
                   "1:\n\t"
                   "vldrb.u8 q0, [%[column]], #16\n\t"
                   "vmullb.u8 q1, q0, q2\n\t"
                   "vmullt.u8 q0, q0, q2\n\t"
                   "vadd.i16 q1, q1, %[base]\n\t"
                   "vadd.i16 q0, q0, %[base]\n\t"
                   "add %[base], %[base], #1\n\t"
                   "vstrh.16 q1, [%[even]], #16\n\t"
                   "vstrh.16 q0, [%[odd]], #16\n\t"
                   "letp lr, 1b"
                   : [even] "+r"(even), [odd] "+r"(odd), [column] "+r"(column), [base] "+r"(base)
                   : [lanes] "r"(lanes), [scale] "r"(times << MVE_KEY_SHIFT)
                   : "q0", "q1", "q2", "lr", "cc", "memory");
}

static inline void mve_fill_sums(uint8_t *sums, unsigned lanes, const uint8_t *column, unsigned times)
{
    __asm volatile("dlstp.8 lr, %[lanes]\n"
                   "1:\n\t"
                   "vldrb.u8 q0, [%[column]], #16\n\t"
                   "vmul.i8 q0, q0, %[times]\n\t"
                   "vstrb.8 q0, [%[sums]], #16\n\t"
                   "letp lr, 1b"
                   : [sums] "+r"(sums), [column] "+r"(column)
                   : [lanes] "r"(lanes), [times] "r"(times)
                   : "q0", "lr", "memory");
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
                   : "q0", "q1", "memory");
    return (unsigned)__builtin_ctz((evens & 0x55555555u) | (odds & 0xaaaaaaaau));
}

/* The lowest lane that has the sum; there is one. */
static inline unsigned mve_find_lane_of_sum(const uint8_t *sums, unsigned sum)
{
    unsigned equal = 0;
    const uint8_t *at = sums;
    do {
        __asm volatile("vldrb.u8 q0, [%[at]], #16\n\t"
                       "vcmp.i8 eq, q0, %[sum]\n\t"
                       "vmrs %[equal], p0"
                       : [at] "+r"(at), [equal] "=r"(equal)
                       : [sum] "r"(sum)
                       : "q0", "memory");
    } while (equal == 0);
    return (unsigned)(at - sums) - TSR_MVE_GROUP + (unsigned)__builtin_ctz(equal);
}

#endif
