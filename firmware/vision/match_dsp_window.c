/*
 * One step of the sliding window with the DSP extension.
 *
 * Written as one function of assembly because it needs thirteen registers at
 * once. Groups of eight lanes are unrolled in descending order, so that an equal
 * sum gives the group to the lower one, and entered at the one that is asked
 * for. A group takes 47 instructions.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include "match_dsp.h"

/* The arguments of naked functions are in registers only. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/*
 * r0 least sums   r1 right_new   r4 leave   r9 left_new in every byte    r5, r6, r8, r12 free
 * r11 groups      r2 right_old   r7 sums    r10 left_old in every byte
 *                 r3 enter
 *
 * Four lanes: the column sums take the new difference and lose the old one, then
 * the window sums take what the entering column has more than the leaving one.
 */
#define MOVE_QUAD(column, sum)                                                                                         \
    "ldr r5, [r1, #" column "]\n\t"                                                                                    \
    "usub8 r6, r9, r5\n\t"                                                                                             \
    "usub8 r5, r5, r9\n\t"                                                                                             \
    "sel r5, r5, r6\n\t"                                                                                               \
    "ldr r6, [r2, #" column "]\n\t"                                                                                    \
    "usub8 r8, r10, r6\n\t"                                                                                            \
    "usub8 r6, r6, r10\n\t"                                                                                            \
    "sel r6, r6, r8\n\t"                                                                                               \
    "ldr r8, [r3, #" column "]\n\t"                                                                                    \
    "uadd8 r8, r8, r5\n\t"                                                                                             \
    "usub8 r8, r8, r6\n\t"                                                                                             \
    "str r8, [r3, #" column "]\n\t"                                                                                    \
    "ldr r6, [r4, #" column "]\n\t"                                                                                    \
    "usub8 r8, r8, r6\n\t"                                                                                             \
    "ldrd r5, r6, [r7, #" sum "]\n\t"                                                                                  \
    "sxtab16 r5, r5, r8\n\t"                                                                                           \
    "sxtab16 r6, r6, r8, ror #8\n\t"                                                                                   \
    "strd r5, r6, [r7, #" sum "]\n\t"

#define MOVE_GROUP(group)                                                                                              \
    ".Lmove_group_" #group                                                                                             \
    ":\n\t" MOVE_QUAD("8*" #group, "16*" #group) "usub16 r12, r5, r6\n\t"                                              \
                                                 "sel r12, r6, r5\n\t" MOVE_QUAD(                                      \
                                                     "8*" #group "+4", "16*" #group "+8") "usub16 r8, r5, r6\n\t"      \
                                                                                          "sel r5, r6, r5\n\t"         \
                                                                                          "usub16 r8, r5, r12\n\t"     \
                                                                                          "sel r5, r12, r5\n\t"        \
                                                                                          "str r5, [r7, #-4-4*" #group \
                                                                                          "]\n\t"                      \
                                                                                          "mov r6, #" #group           \
                                                                                          "*0x10001\n\t"               \
                                                                                          "usub16 r8, r0, r5\n\t"      \
                                                                                          "sel r0, r5, r0\n\t"         \
                                                                                          "sel r11, r6, r11\n\t"

/* Both functions use one table by its distance: one section. */
#define IN_ONE_SECTION __attribute__((naked, section(".text.tsr_dsp_move_window")))

IN_ONE_SECTION uint64_t tsr_dsp_move_window(struct tsr_dsp_window *window)
{
    __asm volatile("push {r4-r11, lr}\n\t"
                   "ldmia r0, {r1-r8}\n\t"
                   "ldrb r9, [r5], #1\n\t"
                   "ldrb r10, [r6], #1\n\t"
                   "subs r1, #1\n\t"
                   "subs r2, #1\n\t"
                   "add r3, r8\n\t"
                   "add r4, r8\n\t"
                   "stmia r0, {r1-r6}\n\t"
                   "mov r12, #0x01010101\n\t"
                   "mul r9, r9, r12\n\t"
                   "mul r10, r10, r12\n\t"
                   "ldr r12, [r0, #32]\n\t"
                   "mvn r0, #0\n\t"
                   "bx r12\n\t" MOVE_GROUP(15) MOVE_GROUP(14) MOVE_GROUP(13) MOVE_GROUP(12) MOVE_GROUP(11) MOVE_GROUP(
                       10) MOVE_GROUP(9) MOVE_GROUP(8) MOVE_GROUP(7) MOVE_GROUP(6) MOVE_GROUP(5) MOVE_GROUP(4)
                       MOVE_GROUP(3) MOVE_GROUP(2) MOVE_GROUP(1) MOVE_GROUP(
                           0) "mov r1, r11\n\t"
                              "pop {r4-r11, pc}\n\t"
                              ".align 2\n\t"
                              ".Lmove_entries:\n\t"
                              ".word .Lmove_group_0+1, .Lmove_group_1+1, .Lmove_group_2+1, .Lmove_group_3+1\n\t"
                              ".word .Lmove_group_4+1, .Lmove_group_5+1, .Lmove_group_6+1, .Lmove_group_7+1\n\t"
                              ".word .Lmove_group_8+1, .Lmove_group_9+1, .Lmove_group_10+1, .Lmove_group_11+1\n\t"
                              ".word .Lmove_group_12+1, .Lmove_group_13+1, .Lmove_group_14+1, .Lmove_group_15+1\n\t");
}

IN_ONE_SECTION const void *tsr_dsp_entry(unsigned groups)
{
    __asm volatile("adr.w r1, .Lmove_entries-4\n\t"
                   "ldr r0, [r1, r0, lsl #2]\n\t"
                   "bx lr\n\t");
}
#endif
