/*
 * The mode sad8 with the DSP extension: groups with window sums of 8 bits, four
 * in a word, and the choice among them. A group takes 30 instructions.
 *
 * The row's first pixels, which cannot search all lanes yet, have 16-bit sums
 * (match_dsp_window.c), in which a lane can be marked as out of reach. This is
 * entered and left through that function's loop.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include "match_dsp.h"
#include "match_dsp_window.h"

#define MOVE_GROUP                                                                                                     \
    ".macro move_group group\n\t"                                                                                      \
    "move_columns \\group\n\t"                                                                                         \
    "ldrd r6, r7, [sp, #at_sums+8*\\group]\n\t"                                                                        \
    "uadd8 r4, r4, r6\n\t"                                                                                             \
    "uadd8 r5, r5, r7\n\t"                                                                                             \
    "strd r4, r5, [sp, #at_sums+8*\\group]\n\t"                                                                        \
    "usub8 r6, r4, r5\n\t"                                                                                             \
    "sel r4, r5, r4\n\t"                                                                                               \
    "str.w r4, [sp, #at_least+4*\\group]\n\t"                                                                          \
    "mov.w r5, #0x1010101*\\group\n\t"                                                                                 \
    "usub8 r6, r12, r4\n\t"                                                                                            \
    "sel r12, r4, r12\n\t"                                                                                             \
    "sel lr, r5, lr\n\t"                                                                                               \
    ".endm\n\t"

/* Four least words at r11; r7 is above the limit. */
#define JUDGE_LEAST                                                                                                    \
    ".macro judge_least\n\t"                                                                                           \
    "ldmia r11!, {r2-r4, r10}\n\t"                                                                                     \
    "uqsub8 r2, r7, r2\n\t"                                                                                            \
    "uqsub8 r3, r7, r3\n\t"                                                                                            \
    "uqsub8 r4, r7, r4\n\t"                                                                                            \
    "uqsub8 r10, r7, r10\n\t"                                                                                          \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orrs r2, r2, r4\n\t"                                                                                              \
    "bne.w .Lfar\n\t"                                                                                                  \
    ".endm\n\t"

/*
 * As in match_dsp_window.c.
 *
 * Bit 8 l of e is 1 if lane l has the least sum, bit 8 l of f if lane 4 + l has.
 * The product of 16 e + f and 2^27 + 2^18 + 2^9 + 1 has them at bits 31 - l and
 * 27 - l, and below each only what it brings along itself, in places of its own:
 * CLZ counts the lane.
 */
#define FIND_WINNER                                                                                                    \
    ".macro find_winner\n\t"                                                                                           \
    "uxtb16 r4, lr\n\t" /* the bytes as halves of sum and group */                                                     \
    "uxtb16 r5, r12\n\t"                                                                                               \
    "orr r4, r4, r5, lsl #8\n\t"                                                                                       \
    "uxtb16 r5, lr, ror #8\n\t"                                                                                        \
    "and r6, r12, #0xff00ff00\n\t"                                                                                     \
    "orr r5, r5, r6\n\t"                                                                                               \
    "usub16 r6, r4, r5\n\t"                                                                                            \
    "sel r4, r5, r4\n\t"                                                                                               \
    "ror r5, r4, #16\n\t"                                                                                              \
    "usub16 r6, r4, r5\n\t"                                                                                            \
    "sel r4, r5, r4\n\t"                                                                                               \
    "ldrd r11, r12, [sp, #at_key]\n\t"                                                                                 \
    "lsr r6, r4, #24\n\t"                                                                                              \
    "uxtb r4, r4\n\t"                                                                                                  \
    "add r5, sp, r4, lsl #3\n\t"                                                                                       \
    "ldrd r0, r1, [r5, #at_sums]\n\t"                                                                                  \
    "add r7, r6, #1\n\t"                                                                                               \
    "mul r7, r7, r12\n\t"                                                                                              \
    "uqsub8 r0, r7, r0\n\t"                                                                                            \
    "uqsub8 r1, r7, r1\n\t"                                                                                            \
    "orr r0, r1, r0, lsl #4\n\t"                                                                                       \
    "mul r0, r0, r11\n\t"                                                                                              \
    "clz r8, r0\n\t"                                                                                                   \
    "add r9, r8, r4, lsl #3\n\t"                                                                                       \
    ".endm\n\t"

/* Goes to .Lnext if a lane of the own group that is not beside the winner's is within the limit; the sums beside it
 * in r2 and r3. */
#define JUDGE_OWN                                                                                                      \
    ".macro judge_own\n\t"                                                                                             \
    "ldrd r2, r3, [r5, #at_sums]\n\t"                                                                                  \
    "uqsub8 r2, r7, r2\n\t"                                                                                            \
    "uqsub8 r3, r7, r3\n\t"                                                                                            \
    "tbb [pc, r8]\n\t"                                                                                                 \
    ".Llanes:\n\t"                                                                                                     \
    ".byte (.Llane0-.Llanes)/2, (.Llane1-.Llanes)/2, (.Llane2-.Llanes)/2, (.Llane3-.Llanes)/2\n\t"                     \
    ".byte (.Llane4-.Llanes)/2, (.Llane5-.Llanes)/2, (.Llane6-.Llanes)/2, (.Llane7-.Llanes)/2\n\t"                     \
    ".Llane0: orrs r2, r3, r2, lsr #16\n\t"                                                                            \
    "bne .Lnext\n\t"                                                                                                   \
    "cmp r9, #0\n\t"                                                                                                   \
    "beq .Lcentre\n\t"                                                                                                 \
    "b .Lbeside\n\t"                                                                                                   \
    ".Llane1: orrs r2, r3, r2, lsr #24\n\t"                                                                            \
    "b .Llane\n\t"                                                                                                     \
    ".Llane2: orrs r2, r3, r2, lsl #24\n\t"                                                                            \
    "b .Llane\n\t"                                                                                                     \
    ".Llane3: lsl r2, r2, #16\n\t"                                                                                     \
    "orrs r2, r2, r3, lsr #8\n\t"                                                                                      \
    "b .Llane\n\t"                                                                                                     \
    ".Llane4: lsl r2, r2, #8\n\t"                                                                                      \
    "orrs r2, r2, r3, lsr #16\n\t"                                                                                     \
    "b .Llane\n\t"                                                                                                     \
    ".Llane5: orrs r2, r2, r3, lsr #24\n\t"                                                                            \
    "b .Llane\n\t"                                                                                                     \
    ".Llane6: orrs r2, r2, r3, lsl #24\n\t"                                                                            \
    "b .Llane\n\t"                                                                                                     \
    ".Llane7: orrs r2, r2, r3, lsl #16\n\t"                                                                            \
    ".Llane:\n\t"                                                                                                      \
    "bne .Lnext\n\t"                                                                                                   \
    ".Lbeside:\n\t"                                                                                                    \
    "add r5, r5, r8\n\t"                                                                                               \
    "ldrb r2, [r5, #at_sums-1]\n\t"                                                                                    \
    "ldrb r3, [r5, #at_sums+1]\n\t"                                                                                    \
    ".endm\n\t"

/* Another group has a sum within the limit. It may be the lane beside the winner's: is it the only one? */
#define JUDGE_NEIGHBOURS                                                                                               \
    ".macro judge_neighbours\n\t"                                                                                      \
    ".Lfar:\n\t"                                                                                                       \
    "lsr r11, r9, #3\n\t"                                                                                              \
    "cmp r8, #0\n\t"                                                                                                   \
    "beq .Lfar_below\n\t"                                                                                              \
    "cmp r8, #7\n\t"                                                                                                   \
    "bne .Lnext\n\t"                                                                                                   \
    "ldr r2, [sp, #at_stride]\n\t"                                                                                     \
    "add r11, r11, #1\n\t"                                                                                             \
    "cmp r11, r2, lsr #3\n\t"                                                                                          \
    "beq .Lnext\n\t"                                                                                                   \
    "ldrd r2, r3, [r5, #at_sums+8]\n\t"                                                                                \
    "orr r2, r2, #0xff\n\t"                                                                                            \
    "b .Lfar_judge\n\t"                                                                                                \
    ".Lfar_below:\n\t"                                                                                                 \
    "subs r11, r11, #1\n\t"                                                                                            \
    "blo .Lnext\n\t"                                                                                                   \
    "ldrd r2, r3, [r5, #at_sums-8]\n\t"                                                                                \
    "orr r3, r3, #0xff000000\n\t"                                                                                      \
    ".Lfar_judge:\n\t"                                                                                                 \
    "uqsub8 r2, r7, r2\n\t"                                                                                            \
    "uqsub8 r3, r7, r3\n\t"                                                                                            \
    "orrs r2, r2, r3\n\t"                                                                                              \
    "bne .Lnext\n\t"                                                                                                   \
    "judge_all_but uqsub8\n\t"                                                                                         \
    "b .Lown\n\t"                                                                                                      \
    ".endm\n\t"

/* Not a function to call: tsr_dsp_groups8 names its parts. */
__attribute__((naked, used)) void tsr_dsp_match_pixels8(void);
__attribute__((naked, used)) void tsr_dsp_match_pixels8(void)
{
    __asm volatile(TSR_DSP_MACROS MOVE_GROUP JUDGE_LEAST FIND_WINNER JUDGE_OWN JUDGE_NEIGHBOURS
                   ".irp group, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0\n\t"
                   ".Lgroup_\\group: move_group \\group\n\t"
                   ".endr\n\t"
                   "stmia sp, {r0-r3}\n\t"
                   "find_winner\n\t"
                   "claim\n\t"
                   "usat r7, #8, r7, asr #20\n\t"
                   "ldr r10, [sp, #at_key+4]\n\t"
                   "mul r7, r7, r10\n\t"
                   "judge_others\n\t"
                   ".Lleast_4: judge_least\n\t"
                   ".Lleast_3: judge_least\n\t"
                   ".Lleast_2: judge_least\n\t"
                   ".Lleast_1: judge_least\n\t"
                   ".Lown: judge_own\n\t"
                   "interpolate\n\t"
                   ".Lnext: end_pixel\n\t"
                   "b.w tsr_dsp_end_column\n\t"
                   "off_centre 0xff\n\t"
                   "judge_neighbours\n\t"
                   ".pushsection .rodata.tsr_dsp_groups8, \"a\"\n\t"
                   ".align 2\n\t"
                   ".globl tsr_dsp_groups8\n\t"
                   "tsr_dsp_groups8:\n\t"
                   ".irp group, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15\n\t"
                   ".word .Lgroup_\\group+1\n\t"
                   ".endr\n\t"
                   ".globl tsr_dsp_least8\n\t"
                   "tsr_dsp_least8: .word .Lleast_1+1, .Lleast_2+1, .Lleast_3+1, .Lleast_4+1\n\t"
                   ".popsection\n\t");
}
#endif
