/*
 * Prefilter and warm-up rows of the matcher with the DSP extension.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include <stdbool.h>
#include <string.h>

#include "match_dsp.h"

/* The arguments of naked functions are in registers only. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/* What the loop over a row works on: four columns at a time, from the second four on. */
struct quads {
    const uint8_t *above;
    const uint8_t *row;
    const uint8_t *below;
    uint8_t *out;
    uint32_t even; /* above + 2 row + below of the columns 0 and 2 */
    uint32_t odd;  /* of 1 and 3 */
    uint32_t bias; /* in both halves, 4 cap and the rounding: below it, the derivative is at its least */
    uint32_t room; /* in both halves, what lies above the largest such derivative */
    uint32_t mask;
    uint32_t excess; /* in every byte, what a quarter of room makes of a byte */
    const uint8_t *above_end;
};

/* above + 2 row + below of the next four columns: r11 even, r12 odd. */
#define ADD_VERTICALLY                                                                                                 \
    ".macro add_vertically\n\t"                                                                                        \
    "ldr lr, [r0], #4\n\t"                                                                                             \
    "uxtb16 r11, lr\n\t"                                                                                               \
    "uxtb16 r12, lr, ror #8\n\t"                                                                                       \
    "ldr lr, [r2], #4\n\t"                                                                                             \
    "uxtab16 r11, r11, lr\n\t"                                                                                         \
    "uxtab16 r12, r12, lr, ror #8\n\t"                                                                                 \
    "ldr lr, [r1], #4\n\t"                                                                                             \
    "uxtab16 r11, r11, lr\n\t"                                                                                         \
    "uxtab16 r11, r11, lr\n\t"                                                                                         \
    "uxtab16 r12, r12, lr, ror #8\n\t"                                                                                 \
    "uxtab16 r12, r12, lr, ror #8\n\t"                                                                                 \
    ".endm\n\t"

/* The columns to the right less those of this register, clipped to 0 .. 65535 - room and that much higher by room, a
 * quarter of it. */
#define DERIVE                                                                                                         \
    ".macro derive columns, next\n\t"                                                                                  \
    "lsl lr, \\next, #16\n\t"                                                                                          \
    "orr lr, lr, \\columns, lsr #16\n\t"                                                                               \
    "uadd16 lr, lr, r6\n\t"                                                                                            \
    "uqsub16 lr, lr, \\columns\n\t"                                                                                    \
    "uqadd16 lr, lr, r7\n\t"                                                                                           \
    "and \\columns, r8, lr, lsr #2\n\t"                                                                                \
    ".endm\n\t"

#define FILTER_QUADS                                                                                                   \
    ".macro filter_quads step\n\t"                                                                                     \
    "push {r4-r11, lr}\n\t"                                                                                            \
    "ldmia r0, {r0-r10}\n\t"                                                                                           \
    "1:\n\t"                                                                                                           \
    "add_vertically\n\t"                                                                                               \
    "derive r4, r11\n\t"                                                                                               \
    "derive r5, r12\n\t"                                                                                               \
    "orr r4, r4, r5, lsl #8\n\t"                                                                                       \
    "usub8 r4, r4, r9\n\t"                                                                                             \
    ".if \\step < 0\n\t"                                                                                               \
    "rev r4, r4\n\t"                                                                                                   \
    ".endif\n\t"                                                                                                       \
    "str r4, [r3], #\\step\n\t"                                                                                        \
    "mov r4, r11\n\t"                                                                                                  \
    "mov r5, r12\n\t"                                                                                                  \
    "cmp r0, r10\n\t"                                                                                                  \
    "blo 1b\n\t"                                                                                                       \
    "pop {r4-r11, pc}\n\t"                                                                                             \
    ".endm\n\t"

/* Assembler macros outlive the function they stand in. */
#define FILTER(step)                                                                                                   \
    ADD_VERTICALLY DERIVE FILTER_QUADS "filter_quads " step "\n\t"                                                     \
                                       ".purgem add_vertically\n\t"                                                    \
                                       ".purgem derive\n\t"                                                            \
                                       ".purgem filter_quads\n\t"

static __attribute__((naked)) void filter_quads(const struct quads *quads)
{
    __asm volatile(FILTER("4"));
}

/* From the row's end downward, mirrored. */
static __attribute__((naked)) void filter_quads_mirrored(const struct quads *quads)
{
    __asm volatile(FILTER("-4"));
}

/* One pixel, with the columns beside it. */
static uint8_t derive_pixel(const uint8_t *const rows[3], unsigned left, unsigned right, int cap)
{
    int sum = rows[0][right] + 2 * rows[1][right] + rows[2][right] - rows[0][left] - 2 * rows[1][left] - rows[2][left];
    int value = (sum + 2) >> 2;
    value = value < -cap ? -cap : value;
    return (uint8_t)((value > cap ? cap : value) + cap);
}

/* The three rows around y: those above and at y as copies in kept, [2][width], which goes from row to row. */
static void gather_rows(const struct tsr_gray *frame, unsigned y, uint8_t *kept, const uint8_t *rows[3])
{
    const uint8_t *row = frame->pixels + (size_t)y * frame->stride;
    uint8_t *copy = kept + (y & 1u) * frame->width;
    memcpy(copy, row, frame->width);
    rows[0] = y > 0 ? kept + ((y - 1u) & 1u) * frame->width : copy;
    rows[1] = copy;
    rows[2] = y + 1u < frame->height ? row + frame->stride : copy;
}

static uint32_t add_two(const uint8_t *const rows[3], unsigned x)
{
    uint32_t low = rows[0][x] + 2u * rows[1][x] + rows[2][x];
    return low | (rows[0][x + 2u] + 2u * rows[1][x + 2u] + rows[2][x + 2u]) << 16;
}

/* Row y of a frame in place: eq. (10). */
static void filter_row(const struct tsr_gray *frame, unsigned y, uint8_t *kept, int cap, bool mirror)
{
    const uint8_t *rows[3];
    gather_rows(frame, y, kept, rows);
    unsigned last = frame->width - 1u;
    unsigned done = 4u * (frame->width / 4u) - 4u; /* pixels 1 .. done */
    uint8_t *row = frame->pixels + (size_t)y * frame->stride;
    const struct quads quads = {.above = rows[0] + 4,
                                .row = rows[1] + 4,
                                .below = rows[2] + 4,
                                .out = mirror ? row + (last - 4u) : row + 1,
                                .even = add_two(rows, 0),
                                .odd = add_two(rows, 1),
                                .bias = (4u * (unsigned)cap + 2u) * 0x10001u,
                                .room = (65532u - 8u * (unsigned)cap) * 0x10001u,
                                .mask = 0x00ff00ffu,
                                .excess = (255u - 2u * (unsigned)cap) * 0x01010101u,
                                .above_end = rows[0] + 4u + done};
    uint8_t first = derive_pixel(rows, 0, 1, cap);
    if (mirror) {
        filter_quads_mirrored(&quads);
    } else {
        filter_quads(&quads);
    }
    for (unsigned x = done + 1u; x <= last; x++) {
        row[mirror ? last - x : x] = derive_pixel(rows, x - 1u, x < last ? x + 1u : last, cap);
    }
    row[mirror ? last : 0] = first;
}

void tsr_dsp_prefilter_row(const struct tsr_match *match, unsigned y)
{
    uint8_t *kept = tsr_match_share_scratch(match).columns;
    int cap = match->config.prefilter_cap;
    filter_row(&match->left, y, kept, cap, false);
    if (match->config.right_is_prefiltered) {
        tsr_match_take_filtered_row(match, y);
    } else {
        filter_row(&match->right, y, kept + 2u * match->config.width, cap, true);
    }
}

void tsr_dsp_add_row(const struct tsr_match *match, unsigned y, unsigned times)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    int start = config->search_start_px;
    int radius = config->window / 2;
    const uint8_t *left = match->left.pixels + (size_t)y * match->left.stride;
    const uint8_t *right = match->right.pixels + (size_t)y * match->right.stride;
    uint8_t *edge = match->scratch;
    tsr_dsp_fill_edge(config, right, edge);
    for (int x = start > radius ? start - radius : 0; x < config->width; x++) {
        uint8_t *column = scratch.columns + (size_t)x * config->disparities;
        const uint8_t *first = right + (config->width - 1 - x + start);
        if (x - start < config->disparities - 1) {
            first = tsr_dsp_at_edge(config, edge, x - start);
        }
        uint32_t pixel = left[x] * 0x01010101u;
        unsigned lanes = TSR_DSP_GROUP_LANES * tsr_dsp_count_groups(config, x - start);
        for (unsigned d = 0; d < lanes; d += 4u) {
            uint32_t difference = tsr_dsp_difference(pixel, tsr_dsp_load(first + d));
            tsr_dsp_store(column + d, tsr_dsp_load(column + d) + times * difference);
        }
    }
    for (unsigned x = 0; x < config->width; x++) {
        uint32_t difference = tsr_dsp_difference(left[x], config->prefilter_cap);
        scratch.texture[x] = (uint8_t)(scratch.texture[x] + times * difference);
    }
}

#define WRITE_PIXEL                                                                                                    \
    "ldrh %[found], [%[choice]], #2\n\t"                                                                               \
    "cmp %[found], %[none]\n\t"                                                                                        \
    "beq 2f\n\t"                                                                                                       \
    "add %[d], %[found], #16\n\t"                                                                                      \
    "lsr %[d], %[d], #5\n\t"                                                                                           \
    "sub %[at], %[choice], %[d], lsl #1\n\t"                                                                           \
    "ldrh %[at], [%[at], %[to_claim]]\n\t"                                                                             \
    "sub %[found], %[found], %[d], lsl #4\n\t"                                                                         \
    "and %[at], %[at], #127\n\t"                                                                                       \
    "usad8 %[at], %[at], %[d]\n\t"                                                                                     \
    "cmp %[at], %[tolerance]\n\t"                                                                                      \
    "it hi\n\t"                                                                                                        \
    "movhi %[found], %[none]\n\t"                                                                                      \
    "2:\n\t"                                                                                                           \
    "strh %[found], [%[value]], #2\n\t"

/* The choices are 32 d + offset_q4, and the claims lie in front of them. */
void tsr_dsp_write_row(const struct tsr_match *match, unsigned y)
{
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    const uint16_t *choice = scratch.choices;
    const uint16_t *end = choice + match->config.width;
    uint16_t *value = match->map + (size_t)y * match->config.width;
    int to_claim = -2 * ((int)match->config.width + match->config.search_start_px + 1);
    uint32_t found, d, at;
    /* Two at a time, of an odd number one first. */
    __asm volatile("tst %[width], #1\n\t"
                   "bne 3f\n\t"
                   "1:\n\t" WRITE_PIXEL "3:\n\t" WRITE_PIXEL "cmp %[choice], %[end]\n\t"
                   "bne 1b"
                   : [choice] "+&r"(choice), [value] "+&r"(value), [found] "=&r"(found), [d] "=&r"(d), [at] "=&r"(at)
                   : [end] "r"(end), [none] "r"(TSR_MATCH_CHOICE_NONE), [to_claim] "r"(to_claim),
                     [tolerance] "r"(match->config.lr_tolerance_px), [width] "r"(match->config.width)
                   : "cc", "memory");
}
#endif
