/*
 * One path of the mode smooth over the disparities of a pixel, with the DSP
 * extension: four lanes in a word.
 *
 * Written as functions of assembly because they need nearly all registers at
 * once, which compilers spill. A word takes 16 instructions, with the sum 23.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include "match_dsp.h"

/* The arguments of naked functions are in registers only. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/*
 * docs/math.md, eq. (44), four lanes.
 *
 * r0 source    r4 jump in every byte     r7 penalty_near in every byte    r9 lanes d - 1 of the word
 * r1 cost      r5 least in every byte    r8 least so far                  r10, r12, lr free
 * r2 path
 *
 * Lanes d - 1 of the next word are read before this one takes their place. No lane carries into the next: a path cost
 * is at most 68, and what is taken from it at most itself. The path cost is left in r12.
 */
#define WALK_WORD(at_end)                                                                                              \
    "ldr r10, [r0, #1]\n\t" at_end "usub8 r12, r9, r10\n\t"                                                            \
    "sel r12, r10, r9\n\t"                                                                                             \
    "ldr r9, [r0, #3]\n\t"                                                                                             \
    "ldr r10, [r0], #4\n\t"                                                                                            \
    "uqadd8 r12, r12, r7\n\t"                                                                                          \
    "usub8 lr, r12, r10\n\t"                                                                                           \
    "sel r12, r10, r12\n\t"                                                                                            \
    "usub8 lr, r12, r4\n\t"                                                                                            \
    "sel r12, r4, r12\n\t"                                                                                             \
    "ldr lr, [r1], #4\n\t"                                                                                             \
    "add r12, r12, lr\n\t"                                                                                             \
    "sub r12, r12, r5\n\t"                                                                                             \
    "str r12, [r2], #4\n\t"                                                                                            \
    "usub8 lr, r8, r12\n\t"                                                                                            \
    "sel r8, r12, r8\n\t"

/* Behind the last lane stands 255; compares with the end, whose flags nothing changes. */
#define IF_LAST(end)                                                                                                   \
    "cmp r0, " end "\n\t"                                                                                              \
    "it eq\n\t"                                                                                                        \
    "orreq r10, r10, #0xff000000\n\t"

/* Before the first lane stands 255. */
#define BEGIN_WALK                                                                                                     \
    "mov r7, #0x08080808\n\t"                                                                                          \
    "mvn r8, #0\n\t"                                                                                                   \
    "ldr r9, [r0]\n\t"                                                                                                 \
    "mov r10, #0xff\n\t"                                                                                               \
    "orr r9, r10, r9, lsl #8\n"

__attribute__((naked)) uint32_t tsr_dsp_walk(const struct tsr_dsp_walk *walk)
{
    __asm volatile("push {r4-r10, lr}\n\t"
                   "ldmia r0, {r0-r2, r4-r6}\n\t" BEGIN_WALK "1:\n\t" WALK_WORD("")
                       WALK_WORD(IF_LAST("r6")) "bne 1b\n\t"
                                                "mov r0, r8\n\t"
                                                "pop {r4-r10, pc}\n\t");
}

/* Sums take the place of the costs, r3 and r6 are the other paths, r11 is the least sum so far. */
#define SUM_WORD                                                                                                       \
    "ldr lr, [r3], #4\n\t"                                                                                             \
    "ldr r10, [r6], #4\n\t"                                                                                            \
    "add r12, r12, lr\n\t"                                                                                             \
    "add r12, r12, r10\n\t"                                                                                            \
    "str r12, [r1, #-4]\n\t"                                                                                           \
    "usub8 lr, r11, r12\n\t"                                                                                           \
    "sel r11, r12, r11\n\t"

__attribute__((naked)) uint64_t tsr_dsp_walk_last(const struct tsr_dsp_walk *walk, const uint32_t *first,
                                                  const uint32_t *second)
{
    __asm volatile("push {r4-r11, lr}\n\t"
                   "mov r11, r1\n\t"
                   "mov r12, r2\n\t"
                   "ldmia r0, {r0-r2, r4-r6}\n\t"
                   "push {r6, r7}\n\t"
                   "mov r3, r11\n\t"
                   "mov r6, r12\n\t"
                   "mvn r11, #0\n\t" BEGIN_WALK "1:\n\t" WALK_WORD("")
                       SUM_WORD WALK_WORD("ldr lr, [sp]\n\t" IF_LAST("lr")) SUM_WORD "bne 1b\n\t"
                                                                                     "mov r0, r8\n\t"
                                                                                     "mov r1, r11\n\t"
                                                                                     "add sp, #8\n\t"
                                                                                     "pop {r4-r11, pc}\n\t");
}
#endif
