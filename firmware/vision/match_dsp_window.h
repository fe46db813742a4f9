/*
 * Assembly that 16-bit and 8-bit window sums share: the column sums' way down,
 * and what follows when the winner is known. Only its two files include this.
 *
 *   r4 group   r5 its sums, less at_sums   r6 least sum   r7 above the limit in every lane   r8 lane   r9 d
 *   r0 x       r1 texture       r12 choices    lr stop
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_DSP_WINDOW_H
#define TSR_VISION_MATCH_DSP_WINDOW_H

/*
 * r0 right_new   r2 enter   r8 255 - left_new in every byte   r10 what all lanes have in common
 * r1 right_old   r3 leave   r9 left_old in every byte         r11 -2     r4 .. r7 free
 *
 * Eight column sums take the new difference and lose the old one; then r4 and r5
 * hold what they exceed the leaving column's by. The last loads of a column move
 * to the next column's pixels.
 */
#define TSR_DSP_MOVE_COLUMNS                                                                                           \
    ".macro move_quad sums, offset, step\n\t"                                                                          \
    ".ifnb \\step\n\t"                                                                                                 \
    "ldr.w r6, [r0], #\\step\n\t"                                                                                      \
    ".else\n\t"                                                                                                        \
    "ldr.w r6, [r0, #\\offset]\n\t"                                                                                    \
    ".endif\n\t"                                                                                                       \
    "uqadd8 r7, r6, r8\n\t"                                                                                            \
    "umaal \\sums, r6, r7, r11\n\t"                                                                                    \
    ".ifnb \\step\n\t"                                                                                                 \
    "ldr.w r6, [r1], #\\step\n\t"                                                                                      \
    ".else\n\t"                                                                                                        \
    "ldr.w r6, [r1, #\\offset]\n\t"                                                                                    \
    ".endif\n\t"                                                                                                       \
    "uqsub8 r7, r6, r9\n\t"                                                                                            \
    "umaal \\sums, r6, r7, r11\n\t"                                                                                    \
    "add.w \\sums, \\sums, r10\n\t"                                                                                    \
    ".endm\n\t"                                                                                                        \
    ".macro move_columns group\n\t"                                                                                    \
    "ldrd r4, r5, [r2, #8*\\group]\n\t"                                                                                \
    "move_quad r5, 8*\\group+4\n\t"                                                                                    \
    ".if \\group\n\t"                                                                                                  \
    "move_quad r4, 8*\\group\n\t"                                                                                      \
    ".else\n\t"                                                                                                        \
    "move_quad r4, 0, -1\n\t"                                                                                          \
    ".endif\n\t"                                                                                                       \
    "strd r4, r5, [r2, #8*\\group]\n\t"                                                                                \
    "ldrd r6, r7, [r3, #8*\\group]\n\t"                                                                                \
    "usub8 r4, r4, r6\n\t"                                                                                             \
    "usub8 r5, r5, r7\n\t"                                                                                             \
    ".endm\n\t"

/* x and texture, which is negative if there is too little, the claim of eq. (17), the limit of eq. (15) as a number
 * with 20 fraction bits in r7, choices in r12 and stop in lr. */
#define TSR_DSP_CLAIM                                                                                                  \
    ".macro claim\n\t"                                                                                                 \
    "add r0, sp, #at_x\n\t"                                                                                            \
    "ldmia r0, {r0-r3, r7, r10-r12, lr}\n\t"                                                                           \
    "ldrb r3, [r3, r0]\n\t"                                                                                            \
    "ldrb r7, [r7, r0]\n\t"                                                                                            \
    "add r1, r1, r3\n\t"                                                                                               \
    "sub r1, r1, r7\n\t"                                                                                               \
    "mla r7, r6, r10, r11\n\t"                                                                                         \
    "sub r3, r0, r9\n\t"                                                                                               \
    "ldrh r10, [r2, r3, lsl #1]\n\t"                                                                                   \
    "lsr r11, r6, #2\n\t"                                                                                              \
    "orr r11, r9, r11, lsl #7\n\t"                                                                                     \
    "cmp r11, r10\n\t"                                                                                                 \
    "it lo\n\t"                                                                                                        \
    "strhlo r11, [r2, r3, lsl #1]\n\t"                                                                                 \
    ".endm\n\t"

/* Judges the groups by their least sums, the own one as if it were above the limit. Too little texture raises the
 * limit above all sums. */
#define TSR_DSP_JUDGE_LEAST                                                                                            \
    ".macro judge_others\n\t"                                                                                          \
    "orr r7, r7, r1, asr #31\n\t"                                                                                      \
    "add r11, sp, #at_least\n\t"                                                                                       \
    "str r7, [r11, r4, lsl #2]\n\t"                                                                                    \
    "ldr.w pc, [sp, #at_least_entry]\n\t"                                                                              \
    ".endm\n\t"

/* Eq. (16) from the sums below (r2) and above (r3); the sum below is the larger one here. */
#define TSR_DSP_INTERPOLATE                                                                                            \
    ".macro interpolate\n\t"                                                                                           \
    "subs r4, r2, r3\n\t"                                                                                              \
    "blo .Labove\n\t"                                                                                                  \
    "sub r2, r2, r6\n\t"                                                                                               \
    "add r4, r2, r4, lsl #4\n\t"                                                                                       \
    "lsl r2, r2, #1\n\t"                                                                                               \
    "udiv r4, r4, r2\n\t"                                                                                              \
    "add r9, r4, r9, lsl #5\n\t"                                                                                       \
    "strh r9, [r12, r0, lsl #1]\n\t"                                                                                   \
    ".endm\n\t"

/* The other cases of it: d = 0, the sum above is the larger one, it is out of reach. */
#define TSR_DSP_OFF_CENTRE                                                                                             \
    ".macro off_centre out_of_reach\n\t"                                                                               \
    ".Lcentre:\n\t"                                                                                                    \
    "lsl r9, r9, #5\n\t"                                                                                               \
    "strh r9, [r12, r0, lsl #1]\n\t"                                                                                   \
    "b .Lnext\n\t"                                                                                                     \
    ".Labove:\n\t"                                                                                                     \
    "cmp r3, #\\out_of_reach\n\t"                                                                                      \
    "bhs .Lcentre\n\t"                                                                                                 \
    "sub r2, r3, r6\n\t"                                                                                               \
    "sub r4, r2, r4, lsl #4\n\t"                                                                                       \
    "lsl r2, r2, #1\n\t"                                                                                               \
    "udiv r4, r4, r2\n\t"                                                                                              \
    "rsb r9, r4, r9, lsl #5\n\t"                                                                                       \
    "strh r9, [r12, r0, lsl #1]\n\t"                                                                                   \
    "b .Lnext\n\t"                                                                                                     \
    ".endm\n\t"

#define TSR_DSP_NEXT                                                                                                   \
    ".macro end_pixel\n\t"                                                                                             \
    "add r0, r0, #1\n\t"                                                                                               \
    "strd r0, r1, [sp, #at_x]\n\t"                                                                                     \
    "cmp r0, lr\n\t"                                                                                                   \
    "blo.w tsr_dsp_next_column\n\t"                                                                                    \
    ".endm\n\t"

/* Goes to .Lnext if a group but the winner's and that of r11, which has been judged, has a sum within the limit. */
#define TSR_DSP_JUDGE_ALL_BUT                                                                                          \
    ".macro judge_all_but uqsub\n\t"                                                                                   \
    "add r3, sp, #at_least\n\t"                                                                                        \
    "str r7, [r3, r11, lsl #2]\n\t"                                                                                    \
    "ldr r4, [sp, #at_stride]\n\t"                                                                                     \
    ".Lfar_next:\n\t"                                                                                                  \
    "ldr r2, [r3], #4\n\t"                                                                                             \
    "\\uqsub r2, r7, r2\n\t"                                                                                           \
    "cmp r2, #0\n\t"                                                                                                   \
    "bne .Lnext\n\t"                                                                                                   \
    "subs r4, r4, #8\n\t"                                                                                              \
    "bne .Lfar_next\n\t"                                                                                               \
    ".endm\n\t"

#define TSR_DSP_MACROS                                                                                                 \
    TSR_DSP_EQUATES TSR_DSP_MOVE_COLUMNS TSR_DSP_CLAIM TSR_DSP_JUDGE_LEAST TSR_DSP_INTERPOLATE TSR_DSP_OFF_CENTRE      \
        TSR_DSP_NEXT TSR_DSP_JUDGE_ALL_BUT

#endif
