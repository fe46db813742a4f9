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

/* Four pixels as two words of halves: columns (0, 2) and (1, 3). */
struct quad {
    uint32_t even;
    uint32_t odd;
};

/* above + 2 row + below of four columns. */
static inline struct quad add_vertically(uint32_t above, uint32_t row, uint32_t below)
{
    struct quad quad;
    __asm("uxtb16 %0, %2\n\tuxtab16 %0, %0, %2\n\tuxtab16 %0, %0, %3\n\tuxtab16 %0, %0, %4\n\t"
          "uxtb16 %1, %2, ror #8\n\tuxtab16 %1, %1, %2, ror #8\n\tuxtab16 %1, %1, %3, ror #8\n\t"
          "uxtab16 %1, %1, %4, ror #8"
          : "=&r"(quad.even), "=&r"(quad.odd)
          : "r"(row), "r"(above), "r"(below));
    return quad;
}

/* floor(difference / 4) with the rounding and 4 cap in bias, clipped to 0 .. 255. */
static inline uint32_t divide(uint32_t right, uint32_t left, uint32_t bias)
{
    uint32_t result;
    __asm("ssub16 %0, %1, %2\n\tsadd16 %0, %0, %3\n\tshadd16 %0, %0, %4\n\tshadd16 %0, %0, %4\n\tusat16 %0, #8, %0"
          : "=&r"(result)
          : "r"(right), "r"(left), "r"(bias), "r"(0));
    return result;
}

/* Bytes above the limit become the limit; room = 255 - limit in each byte. */
static inline uint32_t clip(uint32_t bytes, uint32_t room)
{
    uint32_t result;
    __asm("uqadd8 %0, %1, %2\n\tusub8 %0, %0, %2" : "=&r"(result) : "r"(bytes), "r"(room));
    return result;
}

/* What the columns left and right of two quads give: pixels 1 .. 4 of the first. */
static inline uint32_t derive(struct quad quad, struct quad next, uint32_t bias, uint32_t room)
{
    uint32_t even = quad.even >> 16 | next.even << 16;
    uint32_t odd = quad.odd >> 16 | next.odd << 16;
    return clip(divide(even, quad.even, bias) | divide(odd, quad.odd, bias) << 8, room);
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

static inline struct quad quad_at(const uint8_t *const rows[3], unsigned x)
{
    return add_vertically(tsr_dsp_load(rows[0] + x), tsr_dsp_load(rows[1] + x), tsr_dsp_load(rows[2] + x));
}

/* Row y of a frame in place: eq. (10). */
static inline __attribute__((always_inline)) void filter_row(const struct tsr_gray *frame, unsigned y, uint8_t *kept,
                                                             int cap, bool mirror)
{
    const uint8_t *rows[3];
    gather_rows(frame, y, kept, rows);
    unsigned last = frame->width - 1u;
    uint8_t *row = frame->pixels + (size_t)y * frame->stride;
    uint32_t bias = (2u + 4u * (unsigned)cap) * 0x10001u;
    uint32_t room = (255u - 2u * (unsigned)cap) * 0x01010101u;
    struct quad quad = quad_at(rows, 0);
    unsigned x = 0;
    for (; x + 8u <= last + 1u; x += 4u) {
        struct quad next = quad_at(rows, x + 4u);
        uint32_t bytes = derive(quad, next, bias, room);
        if (mirror) {
            tsr_dsp_store(row + (last - x - 4u), __builtin_bswap32(bytes));
        } else {
            tsr_dsp_store(row + x + 1u, bytes);
        }
        quad = next;
    }
    for (x++; x <= last; x++) {
        row[mirror ? last - x : x] = derive_pixel(rows, x - 1u, x < last ? x + 1u : last, cap);
    }
    row[mirror ? last : 0] = derive_pixel(rows, 0, 1, cap);
}

void tsr_dsp_prefilter_row(const struct tsr_match *match, unsigned y)
{
    uint8_t *kept = tsr_match_share_scratch(match).columns;
    int cap = match->config.prefilter_cap;
    filter_row(&match->left, y, kept, cap, false);
    filter_row(&match->right, y, kept + 2u * match->config.width, cap, true);
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

/* The claim of the right pixel at claims - 2 d is |d_right - d| away by USAD8. */
static inline unsigned find_distance(unsigned claim, unsigned d)
{
    unsigned distance;
    __asm("usad8 %0, %1, %2" : "=r"(distance) : "r"(TSR_MATCH_CLAIM_D(claim)), "r"(d));
    return distance;
}

void tsr_dsp_write_row(const struct tsr_match *match, unsigned y)
{
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    const uint16_t *choice = scratch.choices;
    const uint16_t *end = choice + match->config.width;
    const uint16_t *claim = scratch.claims - match->config.search_start_px;
    unsigned tolerance = match->config.lr_tolerance_px;
    uint16_t *value = match->map + (size_t)y * match->config.width;
    for (; choice < end; choice++, claim++, value++) {
        unsigned found = *choice;
        unsigned result = TSR_DISPARITY_INVALID;
        if (found != TSR_MATCH_CHOICE_NONE) {
            unsigned d = (found + 16u) >> 5;
            if (find_distance(*(claim - d), d) <= tolerance) {
                result = found - 16u * d;
            }
        }
        *value = (uint16_t)result;
    }
}
#endif
