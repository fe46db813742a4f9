/*
 * The pixels of a row with the DSP extension: the sliding window, and the choice
 * among 16-bit window sums.
 *
 * Written in assembly because the window needs all fourteen registers, and the
 * stack pointer to address the sums. Groups of eight lanes are unrolled in
 * descending order, so that an equal sum gives the group to the lower one, and
 * entered at the one that is asked for. A group takes 38 instructions.
 *
 * Four column sums in a word are one number, so a carry between them comes back
 * with the term that undoes it. With (a)+ = max(a, 0), which is UQSUB8, and its
 * complement 255 - (a)+, which is UQADD8 of a complement,
 *
 *      |L - R| = (L - R)+ 2 + R - L  = R - 2 (255 - (L - R)+) + 510 - L      the new row
 *     -|L - R| =                       R - 2 (R - L)+         - L            the old one
 *
 * one UMAAL adds R - 2 t to the column sums, and what is left is the same for
 * all lanes of a column: -L_new - L_old + 510, 510 in every byte being -2.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include "match_dsp.h"
#include "match_dsp_window.h"

/* The arguments of naked functions are in registers only. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

#define IN_FRAME(member, offset) _Static_assert(offsetof(struct tsr_dsp_frame, member) == (offset), #member)
IN_FRAME(stride, TSR_DSP_AT_STRIDE);
IN_FRAME(x, TSR_DSP_AT_X);
IN_FRAME(stop, TSR_DSP_AT_X + 32);
IN_FRAME(least_entry, TSR_DSP_AT_LEAST_ENTRY);
IN_FRAME(lane_key, TSR_DSP_AT_KEY);
IN_FRAME(ones_again, TSR_DSP_AT_KEY + 4);
IN_FRAME(sums, TSR_DSP_AT_SUMS);
IN_FRAME(least, TSR_DSP_AT_LEAST);
_Static_assert(sizeof(struct tsr_dsp_frame) == TSR_DSP_FRAME_LEN, "the frame's length");

/* r4 .. r7 are free, r4 and r5 hold what the entering column has more than the leaving one. */
#define MOVE_GROUP                                                                                                     \
    ".macro move_group group\n\t"                                                                                      \
    "move_columns \\group\n\t"                                                                                         \
    "ldrd r6, r7, [sp, #at_sums+16*\\group]\n\t"                                                                       \
    "sxtab16 r6, r6, r4\n\t"                                                                                           \
    "sxtab16 r7, r7, r4, ror #8\n\t"                                                                                   \
    "strd r6, r7, [sp, #at_sums+16*\\group]\n\t"                                                                       \
    "usub16 r4, r6, r7\n\t"                                                                                            \
    "sel r4, r7, r6\n\t"                                                                                               \
    "ldrd r6, r7, [sp, #at_sums+16*\\group+8]\n\t"                                                                     \
    "sxtab16 r6, r6, r5\n\t"                                                                                           \
    "sxtab16 r7, r7, r5, ror #8\n\t"                                                                                   \
    "strd r6, r7, [sp, #at_sums+16*\\group+8]\n\t"                                                                     \
    "usub16 r5, r6, r7\n\t"                                                                                            \
    "sel r5, r7, r6\n\t"                                                                                               \
    "usub16 r6, r4, r5\n\t"                                                                                            \
    "sel r4, r5, r4\n\t"                                                                                               \
    "str.w r4, [sp, #at_least+4*\\group]\n\t"                                                                          \
    "mov.w r5, #0x10001*\\group\n\t"                                                                                   \
    "usub16 r6, r12, r4\n\t"                                                                                           \
    "sel r12, r4, r12\n\t"                                                                                             \
    "sel lr, r5, lr\n\t"                                                                                               \
    ".endm\n\t"

/* Four least words at r11; r7 is above the limit. */
#define JUDGE_LEAST                                                                                                    \
    ".macro judge_least\n\t"                                                                                           \
    "ldmia r11!, {r2-r4, r10}\n\t"                                                                                     \
    "uqsub16 r2, r7, r2\n\t"                                                                                           \
    "uqsub16 r3, r7, r3\n\t"                                                                                           \
    "uqsub16 r4, r7, r4\n\t"                                                                                           \
    "uqsub16 r10, r7, r10\n\t"                                                                                         \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orrs r2, r2, r4\n\t"                                                                                              \
    "bne.w .Lfar\n\t"                                                                                                  \
    ".endm\n\t"

/* The least sum (r6), its group (r4) and lane (r8), the group's words at r5 + at_sums, d (r9). */
#define FIND_WINNER                                                                                                    \
    ".macro find_winner\n\t"                                                                                           \
    "pkhbt r4, lr, r12, lsl #16\n\t" /* the halves as sum and group */                                                 \
    "pkhtb r5, r12, lr, asr #16\n\t"                                                                                   \
    "cmp r4, r5\n\t"                                                                                                   \
    "it hi\n\t"                                                                                                        \
    "movhi r4, r5\n\t"                                                                                                 \
    "lsr r6, r4, #16\n\t"                                                                                              \
    "uxth r4, r4\n\t"                                                                                                  \
    "add r5, sp, r4, lsl #4\n\t"                                                                                       \
    "ldrd r0, r1, [r5, #at_sums]\n\t"                                                                                  \
    "ldrd r2, r3, [r5, #at_sums+8]\n\t"                                                                                \
    "add r7, r6, #1\n\t"                                                                                               \
    "orr r7, r7, r7, lsl #16\n\t"                                                                                      \
    "uqsub16 r8, r7, r0\n\t" /* 1 where the sum is the least */                                                        \
    "uqsub16 r9, r7, r1\n\t"                                                                                           \
    "uqsub16 r10, r7, r2\n\t"                                                                                          \
    "uqsub16 r11, r7, r3\n\t"                                                                                          \
    "orr r8, r8, r9, lsl #1\n\t" /* bit n for lane n */                                                                \
    "orr r10, r10, r11, lsl #1\n\t"                                                                                    \
    "orr r8, r8, r10, lsl #4\n\t"                                                                                      \
    "orr r8, r8, r8, lsr #14\n\t"                                                                                      \
    "rbit r8, r8\n\t"                                                                                                  \
    "clz r8, r8\n\t"                                                                                                   \
    "add r9, r8, r4, lsl #3\n\t"                                                                                       \
    ".endm\n\t"

/* The words within the limit, and the two sums beside a lane. */
#define JUDGE_LANE                                                                                                     \
    ".macro judge_words words:vararg\n\t"                                                                              \
    ".irp word, \\words\n\t"                                                                                           \
    "uqsub16 r\\word, r7, r\\word\n\t"                                                                                 \
    ".endr\n\t"                                                                                                        \
    ".endm\n\t"                                                                                                        \
    ".macro end_lane below, above\n\t"                                                                                 \
    "bne.w .Lnext\n\t"                                                                                                 \
    "ldrh r2, [r5, #at_sums+\\below]\n\t"                                                                              \
    "ldrh r3, [r5, #at_sums+\\above]\n\t"                                                                              \
    ".endm\n\t"

/* Goes to .Lnext if a lane of the own group that is not beside the winner's is within the limit; the sums beside it
 * in r2 and r3. */
#define JUDGE_OWN                                                                                                      \
    ".macro judge_own\n\t"                                                                                             \
    "ldrd r2, r3, [r5, #at_sums]\n\t"                                                                                  \
    "ldrd r4, r10, [r5, #at_sums+8]\n\t"                                                                               \
    "tbb [pc, r8]\n\t"                                                                                                 \
    ".Llanes:\n\t"                                                                                                     \
    ".byte (.Llane0-.Llanes)/2, (.Llane1-.Llanes)/2, (.Llane2-.Llanes)/2, (.Llane3-.Llanes)/2\n\t"                     \
    ".byte (.Llane4-.Llanes)/2, (.Llane5-.Llanes)/2, (.Llane6-.Llanes)/2, (.Llane7-.Llanes)/2\n\t"                     \
    ".Llane1: judge_words 3, 4, 10\n\t"                                                                                \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orrs r2, r4, r3, lsr #16\n\t"                                                                                     \
    "end_lane 0, 2\n\t"                                                                                                \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane2: judge_words 2, 4, 10\n\t"                                                                                \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orrs r2, r4, r2, lsl #16\n\t"                                                                                     \
    "end_lane 4, 6\n\t"                                                                                                \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane3: judge_words 2, 3, 4, 10\n\t"                                                                             \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orr r2, r10, r2, lsl #16\n\t"                                                                                     \
    "orrs r2, r2, r4, lsr #16\n\t"                                                                                     \
    "end_lane 2, 8\n\t"                                                                                                \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane4: judge_words 2, 3, 4, 10\n\t"                                                                             \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orr r2, r2, r3, lsl #16\n\t"                                                                                      \
    "orrs r2, r2, r4, lsr #16\n\t"                                                                                     \
    "end_lane 6, 12\n\t"                                                                                               \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane5: judge_words 2, 3, 10\n\t"                                                                                \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orrs r2, r2, r10, lsr #16\n\t"                                                                                    \
    "end_lane 8, 10\n\t"                                                                                               \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane6: judge_words 2, 3, 4\n\t"                                                                                 \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orrs r2, r2, r4, lsl #16\n\t"                                                                                     \
    "end_lane 12, 14\n\t"                                                                                              \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane7: judge_words 2, 3, 4, 10\n\t"                                                                             \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orrs r2, r2, r4, lsl #16\n\t"                                                                                     \
    "end_lane 10, 16\n\t"                                                                                              \
    "b .Linterpolate\n\t"                                                                                              \
    ".Llane0: judge_words 2, 3, 4, 10\n\t"                                                                             \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orrs r2, r4, r2, lsr #16\n\t"                                                                                     \
    "end_lane -2, 4\n\t"                                                                                               \
    "cmp r9, #0\n\t"                                                                                                   \
    "beq .Lcentre\n\t"                                                                                                 \
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
    "ldrd r2, r3, [r5, #at_sums+16]\n\t"                                                                               \
    "ldrd r4, r10, [r5, #at_sums+24]\n\t"                                                                              \
    "orr r2, r2, #0xff\n\t"                                                                                            \
    "orr r2, r2, #0xff00\n\t"                                                                                          \
    "b .Lfar_judge\n\t"                                                                                                \
    ".Lfar_below:\n\t"                                                                                                 \
    "subs r11, r11, #1\n\t"                                                                                            \
    "blo .Lnext\n\t"                                                                                                   \
    "ldrd r2, r3, [r5, #at_sums-16]\n\t"                                                                               \
    "ldrd r4, r10, [r5, #at_sums-8]\n\t"                                                                               \
    "movt r10, #0xffff\n\t"                                                                                            \
    ".Lfar_judge:\n\t"                                                                                                 \
    "judge_words 2, 3, 4, 10\n\t"                                                                                      \
    "orr r2, r2, r3\n\t"                                                                                               \
    "orr r4, r4, r10\n\t"                                                                                              \
    "orrs r2, r2, r4\n\t"                                                                                              \
    "bne .Lnext\n\t"                                                                                                   \
    "judge_all_but uqsub16\n\t"                                                                                        \
    "b .Lown\n\t"                                                                                                      \
    ".endm\n\t"

__attribute__((naked)) void tsr_dsp_match_pixels(const struct tsr_dsp_row *row)
{
    __asm volatile(TSR_DSP_MACROS MOVE_GROUP JUDGE_LEAST FIND_WINNER JUDGE_LANE JUDGE_OWN JUDGE_NEIGHBOURS
                   "push {r4-r11, lr}\n\t"
                   "sub sp, sp, #frame_len\n\t"
                   "mov r1, r0\n\t"
                   "mov r0, sp\n\t"
                   "bl tsr_dsp_begin\n\t"
                   "b tsr_dsp_end_column\n\t"
                   /* One more column. The branch to here leaves the carry clear: SBC takes one more away. */
                   ".thumb_func\n\t"
                   ".globl tsr_dsp_next_column\n\t"
                   "tsr_dsp_next_column:\n\t"
                   "ldmia sp, {r0-r8, r11, r12, lr}\n\t"
                   "ldrb r4, [r4, lr]\n\t"
                   "ldrb r5, [r5, lr]\n\t"
                   "add r2, r2, r8\n\t"
                   "add r3, r3, r8\n\t"
                   "mul r9, r5, r6\n\t"
                   "mls r8, r4, r6, r12\n\t"
                   "sbc r10, r8, r9\n\t"
                   "bx r7\n\t"
                   ".irp group, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0\n\t"
                   ".Lgroup_\\group: move_group \\group\n\t"
                   ".endr\n\t"
                   "stmia sp, {r0-r3}\n\t"
                   "find_winner\n\t"
                   "claim\n\t"
                   "lsr r7, r7, #20\n\t"
                   "orr r7, r7, r7, lsl #16\n\t"
                   "judge_others\n\t"
                   ".Lleast_4: judge_least\n\t"
                   ".Lleast_3: judge_least\n\t"
                   ".Lleast_2: judge_least\n\t"
                   ".Lleast_1: judge_least\n\t"
                   ".Lown: judge_own\n\t"
                   ".Linterpolate: interpolate\n\t"
                   ".Lnext: end_pixel\n\t"
                   ".thumb_func\n\t"
                   ".globl tsr_dsp_end_column\n\t"
                   "tsr_dsp_end_column:\n\t"
                   "mov r0, sp\n\t"
                   "bl tsr_dsp_prepare\n\t"
                   "cmp r0, #1\n\t"
                   "blo tsr_dsp_next_column\n\t"
                   "add sp, sp, #frame_len\n\t"
                   "pop {r4-r11, pc}\n\t"
                   "off_centre 0x4000\n\t"
                   "judge_neighbours\n\t"
                   ".pushsection .rodata.tsr_dsp_groups, \"a\"\n\t"
                   ".align 2\n\t"
                   ".globl tsr_dsp_groups\n\t"
                   "tsr_dsp_groups:\n\t"
                   ".irp group, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15\n\t"
                   ".word .Lgroup_\\group+1\n\t"
                   ".endr\n\t"
                   ".globl tsr_dsp_least\n\t"
                   "tsr_dsp_least: .word .Lleast_1+1, .Lleast_2+1, .Lleast_3+1, .Lleast_4+1\n\t"
                   ".popsection\n\t");
}
#endif
