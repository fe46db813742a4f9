/*
 * Rows of the matcher without a window, with MVE: prefilter, warm-up, texture,
 * and the map from the choices. The last vector of a row is predicated.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <arm_mve.h>
#include <string.h>

#include "match_mve.h"

#define BYTES 16u /* lanes of a vector */
#define HALVES 8u

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

/* One pixel, with the columns beside it. */
static uint8_t derive_pixel(const uint8_t *const rows[3], unsigned left, unsigned right, int cap)
{
    int sum = rows[0][right] + 2 * rows[1][right] + rows[2][right] - rows[0][left] - 2 * rows[1][left] - rows[2][left];
    int value = (sum + 2) >> 2;
    value = value < -cap ? -cap : value;
    return (uint8_t)((value > cap ? cap : value) + cap);
}

/* clang-format off */
/* Eight pixels in q0 from what lies left of them in three rows. */
#define FILTER                              \
    "dlstp.16 lr, %[count]\n"               \
    "1:\n\t"                                \
    "vldrb.u16 q0, [%[above], #2]\n\t"      \
    "vldrb.u16 q1, [%[above]], #8\n\t"      \
    "vldrb.u16 q2, [%[below], #2]\n\t"      \
    "vsub.i16 q0, q0, q1\n\t"               \
    "vldrb.u16 q1, [%[below]], #8\n\t"      \
    "vadd.i16 q0, q0, q2\n\t"               \
    "vldrb.u16 q2, [%[middle], #2]\n\t"     \
    "vsub.i16 q0, q0, q1\n\t"               \
    "vldrb.u16 q1, [%[middle]], #8\n\t"     \
    "vsub.i16 q2, q2, q1\n\t"               \
    "vadd.i16 q0, q0, q2\n\t"               \
    "vadd.i16 q0, q0, q2\n\t"               \
    "vrshr.s16 q0, q0, #2\n\t"              \
    "vmin.s16 q0, q0, q3\n\t"               \
    "vmax.s16 q0, q0, q4\n\t"               \
    "vadd.i16 q0, q0, q3\n\t"
#define FILTER_OPERANDS [above] "+l"(rows[0]), [middle] "+l"(rows[1]), [below] "+l"(rows[2])
/* clang-format on */

/* Row y of a frame in place: eq. (10). The mirrored one is scattered. */
static inline __attribute__((always_inline)) void filter_row(const struct tsr_gray *frame, unsigned y, uint8_t *kept,
                                                             int cap, bool mirror)
{
    const uint8_t *rows[3];
    gather_rows(frame, y, kept, rows);
    unsigned last = frame->width - 1u;
    uint8_t *row = frame->pixels + (size_t)y * frame->stride;
    uint8_t right = derive_pixel(rows, last - 1u, last, cap); /* before the row below is at an end */
    uint8_t left = derive_pixel(rows, 0, 1, cap);
    if (mirror) {
        uint16x8_t places = vsubq_u16(vdupq_n_u16((uint16_t)(last - 1u)), vidupq_n_u16(0, 1));
        __asm volatile("vdup.16 q3, %[cap]\n\tvneg.s16 q4, q3\n\t" FILTER "vstrb.16 q0, [%[out], %q[places]]\n\t"
                       "vsub.i16 %q[places], %q[places], %[eight]\n\t"
                       "letp lr, 1b"
                       : FILTER_OPERANDS, [places] "+w"(places)
                       : [out] "l"(row), [cap] "r"(cap), [count] "r"(last - 1u), [eight] "r"(HALVES)
                       : "q0", "q1", "q2", "q3", "q4", "lr", "memory");
    } else {
        uint8_t *out = row + 1;
        __asm volatile("vdup.16 q3, %[cap]\n\tvneg.s16 q4, q3\n\t" FILTER "vstrb.16 q0, [%[out]], #8\n\t"
                       "letp lr, 1b"
                       : FILTER_OPERANDS, [out] "+l"(out)
                       : [cap] "r"(cap), [count] "r"(last - 1u)
                       : "q0", "q1", "q2", "q3", "q4", "lr", "memory");
    }
    row[mirror ? last : 0] = left;
    row[mirror ? 0 : last] = right;
}

void tsr_mve_prefilter_row(const struct tsr_match *match, unsigned y)
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

/* Lanes whose right pixel lies left of the picture take its first one, at lane `limit`: eq. (11). */
static void add_column(uint8_t *column, unsigned disparities, unsigned times, uint8_t left, const uint8_t *right,
                       unsigned limit)
{
    uint8x16_t pixel = vdupq_n_u8(left);
    uint8x16_t limits = vdupq_n_u8((uint8_t)limit);
    for (unsigned d = 0; d < disparities; d += BYTES) {
        mve_pred16_t lanes = vctp8q(disparities - d);
        uint8x16_t offsets = vminq_u8(vidupq_n_u8(d, 1), limits);
        uint8x16_t difference = vabdq_u8(pixel, vldrbq_gather_offset_z_u8(right, offsets, lanes));
        uint8x16_t sums = vmlaq_n_u8(vldrbq_z_u8(column + d, lanes), difference, (uint8_t)times);
        vstrbq_p_u8(column + d, sums, lanes);
    }
}

void tsr_mve_add_row(const struct tsr_match *match, unsigned y, unsigned times)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned disparities = config->disparities;
    const uint8_t *left = match->left.pixels + (size_t)y * match->left.stride;
    const uint8_t *right = match->right.pixels + (size_t)y * match->right.stride + (config->width - 1u);
    for (unsigned x = 0; x < config->width; x++) {
        unsigned lane_of_first = x > start ? x - start : 0u; /* the d whose right pixel is 0 */
        unsigned limit = lane_of_first < disparities ? lane_of_first : disparities - 1u;
        add_column(scratch.columns + (size_t)x * disparities, disparities, times, left[x], right - lane_of_first,
                   limit);
    }
    for (unsigned x = 0; x < config->width; x += BYTES) {
        mve_pred16_t lanes = vctp8q(config->width - x);
        uint8x16_t difference = vabdq_u8(vldrbq_z_u8(left + x, lanes), vdupq_n_u8(config->prefilter_cap));
        uint8x16_t sums = vmlaq_n_u8(vldrbq_z_u8(scratch.texture + x, lanes), difference, (uint8_t)times);
        vstrbq_p_u8(scratch.texture + x, sums, lanes);
    }
}
#endif
