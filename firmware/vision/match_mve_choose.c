/*
 * The choices of a row and its map with MVE, eight pixels at once: tests of
 * texture and left-right consistency, and the sub-pixel offset.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <arm_mve.h>

#include "match_mve.h"

#define HALVES 8u /* lanes of a vector */

/* clang-format off */
/* One bit of floor((16 lean + slope) / (2 slope)), of which 8 is the most: q6 the rest, q5 the divisor, q7 the quotient.
 * With 16-bit sums 17 slope fits 16 bits. */
#define DIVIDE(bit)                   \
    "vptt.u16 cs, q6, q5\n\t"         \
    "vsubt.i16 q6, q6, q5\n\t"        \
    "vorrt.i16 q7, #" #bit "\n\t"     \
    "vshr.u16 q5, q5, #1\n\t"
#define FIND_OFFSET                   \
    "vmax.u16 q5, q2, q3\n\t"         \
    "vabd.u16 q6, q2, q3\n\t"         \
    "vsub.i16 q5, q5, q0\n\t"         \
    "vshl.i16 q6, q6, #4\n\t"         \
    "vmov.i16 q7, #0\n\t"             \
    "vadd.i16 q6, q6, q5\n\t"         \
    "vshl.i16 q5, q5, #4\n\t"         \
    DIVIDE(8) DIVIDE(4) DIVIDE(2) DIVIDE(1) \
    "vpt.u16 cs, q3, q2\n\t"          \
    "vnegt.s16 q7, q7\n\t"            \
    "vpt.s16 lt, q4, zr\n\t"          \
    "vmovt.i16 q7, #0\n\t"
/* clang-format on */

void tsr_mve_choose(const struct tsr_mve_found found[TSR_MVE_FOUND_COUNT], unsigned count, unsigned shift,
                    unsigned texture_least, uint16_t *choices)
{
    /* q0 sums, q1 disparities, q2 below, q3 above */
    __asm volatile(
        "vld40.16 {q0, q1, q2, q3}, [%[found]]\n\tvld41.16 {q0, q1, q2, q3}, [%[found]]\n\t"
        "vld42.16 {q0, q1, q2, q3}, [%[found]]\n\tvld43.16 {q0, q1, q2, q3}, [%[found]]\n\t"
        "vorr q4, q2, q3\n\t"
        "vshl.u16 q0, %[right]\n\tvshl.u16 q2, %[right]\n\tvshl.u16 q3, %[right]\n\t" FIND_OFFSET
        "vshl.i16 q0, q1, #5\n\t"
        "vadd.i16 q0, q0, q7\n\t"
        "vldrh.u16 q2, [%[choices]]\n\t"
        "vadd.i16 q0, q0, %[zero]\n\t"
        "vdup.16 q3, %[texture]\n\t"
        "vpt.u16 hi, q3, q2\n\tvmvnt.i16 q0, #0\n\t"
        "vpt.i16 eq, q1, %[none]\n\tvmvnt.i16 q0, #0\n\t"
        "vctp.16 %[count]\n\tvpst\n\tvstrht.16 q0, [%[choices]]"
        :
        : [found] "r"(found), [right] "r"(-(int)shift), [choices] "r"(choices), [zero] "r"(TSR_MATCH_CHOICE(0, 0)),
          [texture] "r"(texture_least), [none] "r"(TSR_MATCH_CHOICE_NONE), [count] "r"(count)
        : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "q7", "memory");
}
_Static_assert(TSR_MATCH_CHOICE_NONE == 0xffff, "as VMVN makes it");

/* The choices hold the sums of `window` columns of texture, those outside being the nearest inside. */
static void sum_texture(const struct tsr_match *match)
{
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned window = match->config.window;
    int last = match->config.width - 1;
    for (int x = 0; x <= last; x += (int)HALVES) {
        uint16x8_t sum = vdupq_n_u16(0);
        int first = x - (int)window / 2;
        if (first >= 0 && first + (int)(window - 1u + HALVES) - 1 <= last) {
            for (unsigned i = 0; i < window; i++) {
                sum = vaddq_u16(sum, vldrbq_u16(scratch.texture + first + i));
            }
        } else {
            int16x8_t places = vaddq_n_s16(vreinterpretq_s16_u16(vidupq_n_u16(0, 1)), (int16_t)first);
            for (unsigned i = 0; i < window; i++) {
                int16x8_t inside = vmaxq_s16(vminq_s16(places, vdupq_n_s16((int16_t)last)), vdupq_n_s16(0));
                sum = vaddq_u16(sum, vldrbq_gather_offset_u16(scratch.texture, vreinterpretq_u16_s16(inside)));
                places = vaddq_n_s16(places, 1);
            }
        }
        vstrhq_p_u16(scratch.choices + x, sum, vctp16q((uint32_t)(last + 1 - x)));
    }
}

void tsr_mve_move_texture(const struct tsr_match *match, unsigned y_new, unsigned y_old)
{
    const uint8_t *new_row = match->left.pixels + (size_t)y_new * match->left.stride;
    const uint8_t *old_row = match->left.pixels + (size_t)y_old * match->left.stride;
    uint8_t *texture = tsr_match_share_scratch(match).texture;
    __asm volatile("vdup.8 q3, %[cap]\n\t"
                   "dlstp.8 lr, %[width]\n"
                   "1:\n\t"
                   "vldrb.u8 q0, [%[new_row]], #16\n\t"
                   "vldrb.u8 q1, [%[old_row]], #16\n\t"
                   "vabd.u8 q0, q0, q3\n\t"
                   "vldrb.u8 q2, [%[texture]]\n\t"
                   "vabd.u8 q1, q1, q3\n\t"
                   "vadd.i8 q2, q2, q0\n\t"
                   "vsub.i8 q2, q2, q1\n\t"
                   "vstrb.8 q2, [%[texture]], #16\n\t"
                   "letp lr, 1b"
                   : [new_row] "+r"(new_row), [old_row] "+r"(old_row), [texture] "+r"(texture)
                   : [cap] "r"(match->config.prefilter_cap), [width] "r"(match->config.width)
                   : "q0", "q1", "q2", "q3", "lr", "memory");
    sum_texture(match);
}

/* docs/math.md, eq. (17): the choices that agree with the claims. The lane of TSR_MATCH_CHOICE_NONE agrees with none,
 * whichever claim it meets. */
void tsr_mve_write_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    uint16_t *map_row = match->map + (size_t)y * config->width;
    const uint16_t *choices = scratch.choices;
    bool off = config->lr_tolerance_px == TSR_MATCH_TEST_OFF;
    unsigned tolerance = off ? TSR_DISPARITY_COUNT_MAX : config->lr_tolerance_px;
    uint16x8_t places = vsubq_n_u16(vidupq_n_u16(0, 1), (uint16_t)config->search_start_px); /* x - s */
    /* q1 the lanes, q2 what the claims say; 32 d + offset + 8 becomes 16 d + offset */
    __asm volatile("vdup.16 q4, %[last]\n\tvmov.i16 q5, %[mask]\n\tvdup.16 q6, %[reach]\n\t"
                   "dlstp.16 lr, %[width]\n"
                   "1:\n\t"
                   "vldrh.u16 q0, [%[choices]], #16\n\t"
                   "vshr.u16 q1, q0, #5\n\t"
                   "vsub.i16 q2, %q[places], q1\n\t"
                   "vmin.u16 q2, q2, q4\n\t"
                   "vldrh.u16 q3, [%[claims], q2, uxtw #1]\n\t"
                   "vand q3, q3, q5\n\t"
                   "vsub.i16 q2, q3, q1\n\t"
                   "vshl.i16 q1, q1, #4\n\t"
                   "vadd.i16 q2, q2, %[tolerance]\n\t"
                   "vsub.i16 q0, q0, q1\n\t"
                   "vadd.i16 %q[places], %q[places], %[eight]\n\t"
                   "vsub.i16 q0, q0, %[eight]\n\t"
                   "vpt.u16 hi, q2, q6\n\t"
                   "vdupt.16 q0, %[invalid]\n\t"
                   "vstrh.16 q0, [%[map_row]], #16\n\t"
                   "letp lr, 1b"
                   : [choices] "+r"(choices), [map_row] "+r"(map_row), [places] "+w"(places)
                   : [claims] "r"(scratch.claims), [width] "r"(config->width), [last] "r"(config->width - 1u),
                     [tolerance] "r"(tolerance), [reach] "r"(2u * tolerance), [eight] "r"(8),
                     [invalid] "r"(TSR_DISPARITY_INVALID), [mask] "i"(TSR_MATCH_CLAIM_D(UINT16_MAX))
                   : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "lr", "memory");
}
#endif
