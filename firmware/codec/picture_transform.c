/*
 * Prediction among a picture's coefficients, and the quantiser. Predicting coefficients instead of pixels lets the
 * encoder weigh every mode after one transform.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "picture_dct.h"
#include "picture_transform.h"

#define SIZE 8u
#define ACTIVITY_MAX ((int32_t)TSR_PICTURE_ACTIVITY_MAX)
/* |level * step| beyond which the sums of the transform could leave 32 bits: 4096 gray levels, in 1/512. */
#define PRODUCT_MAX (1 << 21)

const uint8_t tsr_picture_zigzag[TSR_PICTURE_COEFFICIENTS] = {
    0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,  12, 19, 26, 33, 40, 48,
    41, 34, 27, 20, 13, 6,  7,  14, 21, 28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23,
    30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

/* 512 w / sqrt(n[u] n[v]), w = 1 + (u + v) / 70: a coarser step for fine detail. */
static const uint8_t inverse_scales[TSR_PICTURE_COEFFICIENTS] = {
    64,  61, 83, 63, 68, 65, 88,  66, 61, 58, 79,  60, 65, 62, 84, 63, 83, 79, 108, 82, 88, 84,
    114, 86, 63, 60, 82, 62, 66,  63, 86, 65, 68,  65, 88, 66, 71, 68, 93, 70, 65,  62, 84, 63,
    68,  65, 88, 66, 88, 84, 114, 86, 93, 88, 120, 90, 66, 63, 86, 65, 70, 66, 90,  68};

/* 2^14 / (w sqrt(n[u] n[v])): the encoder's side. */
static const uint16_t forward_scales[TSR_PICTURE_COEFFICIENTS] = {
    2048, 1900, 2519, 1848, 1937, 1799, 2386, 1752, 1900, 1764, 2338, 1716, 1799, 1671, 2217, 1628,
    2519, 2338, 3100, 2276, 2386, 2217, 2941, 2160, 1848, 1716, 2276, 1671, 1752, 1628, 2160, 1587,
    1937, 1799, 2386, 1752, 1838, 1708, 2267, 1666, 1799, 1671, 2217, 1628, 1708, 1587, 2107, 1549,
    2386, 2217, 2941, 2160, 2267, 2107, 2797, 2056, 1752, 1628, 2160, 1587, 1666, 1549, 2056, 1512};

/* 2^14 / n and 2^5 n. */
static const uint16_t inverse_norms[SIZE] = {2048, 1814, 3277, 1814, 2048, 1814, 3277, 1814};
static const uint16_t norms_q5[SIZE] = {256, 289, 160, 289, 256, 289, 160, 289};

uint32_t tsr_picture_step_q6(unsigned index)
{
    static const uint8_t octave[8] = {64, 70, 76, 83, 91, 99, 108, 117};
    return (uint32_t)octave[index % 8u] << (index / 8u);
}

void tsr_picture_border_of(struct tsr_picture_border *border, const uint8_t *above, const uint8_t *left,
                           size_t left_stride)
{
    int32_t pixels[2u * SIZE], made[TSR_PICTURE_COEFFICIENTS];
    for (size_t i = 0; i < SIZE; i++) {
        pixels[i] = above[i];
        pixels[SIZE + i] = left[i * left_stride];
    }
    tsr_picture_transform(pixels, made, 2);
    for (size_t i = 0; i < SIZE; i++) {
        border->above[i] = (int16_t)((made[SIZE * i] * inverse_norms[i] + 128) >> 8);
        border->left[i] = (int16_t)((made[SIZE * i + 1u] * inverse_norms[i] + 128) >> 8);
    }
    border->above_last = (uint8_t)pixels[SIZE - 1u];
    border->left_last = (uint8_t)pixels[2u * SIZE - 1u];
}

/* The plane (7 - x) left[y] + (x + 1) above_last + (7 - y) above[x] + (y + 1) left_last, over 16, of which the ramps'
 * frequencies 0 and 1 are kept: 7/32 and 17/128 of what they stand for. */
static void predict_plane(int32_t made[TSR_PICTURE_COEFFICIENTS], const struct tsr_picture_border *b)
{
    for (size_t i = 1; i < SIZE; i++) {
        made[i] = (7 * b->above[i]) >> 5;
        made[SIZE * i] = (7 * b->left[i]) >> 5;
        made[SIZE + i] = (17 * b->above[i]) >> 7;
    }
    made[SIZE + 1u] = (17 * (b->above[1] + b->left[1])) >> 7;
    for (size_t i = 2; i < SIZE; i++) {
        made[SIZE * i + 1u] = (17 * b->left[i]) >> 7;
    }
    made[0] = ((7 * (b->above[0] + b->left[0])) >> 5) + 18 * (b->above_last + b->left_last);
    made[1] += (17 * (b->left[0] - 64 * b->above_last)) >> 7;
    made[SIZE] += (17 * (b->above[0] - 64 * b->left_last)) >> 7;
}

/* Predicted coefficients, inverse scale. */
static void predict(int32_t made[TSR_PICTURE_COEFFICIENTS], const struct tsr_picture_border *border, unsigned mode)
{
    memset(made, 0, TSR_PICTURE_COEFFICIENTS * sizeof *made);
    switch (mode) {
    case TSR_PICTURE_VERTICAL:
        for (size_t i = 0; i < SIZE; i++) {
            made[i] = border->above[i];
        }
        break;
    case TSR_PICTURE_HORIZONTAL:
        for (size_t i = 0; i < SIZE; i++) {
            made[SIZE * i] = border->left[i];
        }
        break;
    case TSR_PICTURE_PLANE: predict_plane(made, border); break;
    default: made[0] = (border->above[0] + border->left[0]) >> 1; break;
    }
}

static void transform_block(int32_t made[TSR_PICTURE_COEFFICIENTS], const uint8_t *pixels, size_t stride)
{
    int32_t columns[TSR_PICTURE_COEFFICIENTS];
    for (size_t y = 0; y < SIZE; y++) {
        for (size_t x = 0; x < SIZE; x++) {
            made[SIZE * y + x] = pixels[y * stride + x];
        }
    }
    tsr_picture_transform(made, columns, SIZE);
    tsr_picture_transform(columns, made, SIZE);
}

/* From inverse to forward scale. */
static int32_t forward_of(int32_t value, size_t at)
{
    return (((value * norms_q5[at / SIZE]) >> 8) * norms_q5[at % SIZE]) >> 8;
}

static int32_t magnitude_of(int32_t value)
{
    return value < 0 ? -value : value;
}

/* What predicting this coefficient saves, as a share of its step. */
static int32_t saving(const int32_t *coefficients, int32_t predicted, size_t at)
{
    const int32_t whole = coefficients[at];
    const int32_t rest = whole - forward_of(predicted, at);
    return (magnitude_of(whole) - magnitude_of(rest)) * inverse_scales[at];
}

/* The mode that saves most; what is saved of the mean is in each of them. */
static uint8_t choose_mode(const int32_t *coefficients, const struct tsr_picture_border *border)
{
    int32_t plane[TSR_PICTURE_COEFFICIENTS];
    predict(plane, border, TSR_PICTURE_PLANE);
    int32_t saved[4] = {[TSR_PICTURE_MEAN] = saving(coefficients, (border->above[0] + border->left[0]) >> 1, 0),
                        [TSR_PICTURE_PLANE] =
                            saving(coefficients, plane[0], 0) + saving(coefficients, plane[SIZE], SIZE),
                        [TSR_PICTURE_VERTICAL] = saving(coefficients, border->above[0], 0),
                        [TSR_PICTURE_HORIZONTAL] = saving(coefficients, border->left[0], 0)};
    for (size_t i = 1; i < SIZE; i++) {
        saved[TSR_PICTURE_VERTICAL] += saving(coefficients, border->above[i], i);
        saved[TSR_PICTURE_HORIZONTAL] += saving(coefficients, border->left[i], SIZE * i);
        saved[TSR_PICTURE_PLANE] += saving(coefficients, plane[i], i) + saving(coefficients, plane[SIZE + i], SIZE + i);
        if (i > 1u) {
            saved[TSR_PICTURE_PLANE] += saving(coefficients, plane[SIZE * i], SIZE * i) +
                                        saving(coefficients, plane[SIZE * i + 1u], SIZE * i + 1u);
        }
    }
    unsigned best = 0;
    for (unsigned mode = 1; mode < 4u; mode++) {
        best = saved[mode] > saved[best] ? mode : best;
    }
    return (uint8_t)best;
}

static void subtract_prediction(int32_t *coefficients, const struct tsr_picture_border *border, unsigned mode)
{
    int32_t predicted[TSR_PICTURE_COEFFICIENTS];
    predict(predicted, border, mode);
    /* Only the plane has a second row and column. */
    const size_t lines = mode == TSR_PICTURE_PLANE ? 2u : 1u;
    for (size_t line = 0; line < lines; line++) {
        for (size_t i = line; i < SIZE; i++) {
            const size_t across = SIZE * line + i, down = SIZE * i + line;
            coefficients[across] -= forward_of(predicted[across], across);
            if (across != down) {
                coefficients[down] -= forward_of(predicted[down], down);
            }
        }
    }
}

/* Rounding, in 1/256 step: 110 for the mean, then a dead zone that widens with the frequency. */
#define ROUNDING_MAX 110u
static uint32_t rounding_at(uint32_t k)
{
    return k == 0 ? ROUNDING_MAX : 100u - (k < 32u ? k : 32u) * 19u / 16u;
}

static int16_t level_of(int32_t scaled, uint32_t step_q6, uint32_t k)
{
    const uint32_t level = ((uint32_t)scaled + ((step_q6 * rounding_at(k)) >> 8)) / step_q6;
    return (int16_t)(level < TSR_PICTURE_LEVEL_MAX ? level : TSR_PICTURE_LEVEL_MAX);
}

void tsr_picture_quantise(struct tsr_picture_block *block, const struct tsr_picture_border *border, uint32_t step_q6,
                          const uint8_t *pixels, size_t stride)
{
    int32_t coefficients[TSR_PICTURE_COEFFICIENTS];
    transform_block(coefficients, pixels, stride);
    block->mode = choose_mode(coefficients, border);
    subtract_prediction(coefficients, border, block->mode);
    /* Most coefficients are below this and 0 without another look. */
    const int32_t dead = (int32_t)((step_q6 * (256u - ROUNDING_MAX)) >> 8);
    block->last = 0;
    for (uint32_t k = 0; k < TSR_PICTURE_COEFFICIENTS; k++) {
        const size_t at = tsr_picture_zigzag[k];
        const int32_t value = coefficients[at];
        const int32_t scaled = (magnitude_of(value) * forward_scales[at]) >> 8;
        int16_t level = 0;
        if (scaled >= dead) {
            level = level_of(scaled, step_q6, k);
            if (level != 0) {
                block->last = (uint8_t)(k + 1u);
                level = value < 0 ? (int16_t)-level : level;
            }
        }
        block->levels[k] = level;
    }
}

/* All but the mean lie an eighth of a step further out than their level: SSIM rewards the contrast that the dead zone
 * took away. */
static int32_t dequantise(int32_t level, uint32_t step_q6, size_t at)
{
    const int32_t further = at == 0 ? 0 : level > 0 ? 1 : -1;
    int32_t product = (8 * level + further) * (int32_t)step_q6;
    product = product > PRODUCT_MAX ? PRODUCT_MAX : product < -PRODUCT_MAX ? -PRODUCT_MAX : product;
    return (product * inverse_scales[at] + 2048) >> 12;
}

void tsr_picture_reconstruct(const struct tsr_picture_block *block, const struct tsr_picture_border *border,
                             uint32_t step_q6, uint8_t *pixels, size_t stride)
{
    int32_t made[TSR_PICTURE_COEFFICIENTS], columns[TSR_PICTURE_COEFFICIENTS];
    const bool is_tall = block->mode == TSR_PICTURE_PLANE || block->mode == TSR_PICTURE_HORIZONTAL;
    size_t row_end = is_tall ? SIZE : 1u; /* rows of coefficients from here on are 0 */
    predict(made, border, block->mode);
    for (size_t k = 0; k < block->last; k++) {
        if (block->levels[k] != 0) {
            const size_t at = tsr_picture_zigzag[k];
            made[at] += dequantise(block->levels[k], step_q6, at);
            row_end = at / SIZE >= row_end ? at / SIZE + 1u : row_end;
        }
    }
    memset(columns, 0, sizeof columns);
    tsr_picture_transform_back(made, columns, row_end);
    tsr_picture_transform_back(columns, made, SIZE);
    for (size_t y = 0; y < SIZE; y++) {
        for (size_t x = 0; x < SIZE; x++) {
            const int32_t pixel = (made[SIZE * y + x] + 32) >> 6;
            pixels[y * stride + x] = (uint8_t)(pixel < 0 ? 0 : pixel > 255 ? 255 : pixel);
        }
    }
}

/* 16 log2(value) of a value of 13 to 31 bits, the fraction linear. */
static int32_t log2_q4(uint32_t value)
{
    int32_t octave = 0;
    while (value >= 1u << 16) {
        value >>= 1;
        octave += 16;
    }
    while (value < 1u << 15) {
        value <<= 1;
        octave -= 16;
    }
    return octave + 15 * 16 + (int32_t)((value >> 11) & 15u);
}

/* Half the logarithm of twice the variance plus (0.03 * 255)^2, SSIM's constant, averaged over four quadrants: SSIM
 * divides errors by that sum, so the step may grow with its root; a quarter power measures best. */
uint8_t tsr_picture_activity(const uint8_t *pixels, size_t stride)
{
    int32_t logs_q4 = 0;
    for (size_t quadrant = 0; quadrant < 4u; quadrant++) {
        const uint8_t *row = pixels + quadrant / 2u * 4u * stride + quadrant % 2u * 4u;
        uint32_t sum = 0, squares = 0;
        for (size_t y = 0; y < 4u; y++, row += stride) {
            for (size_t x = 0; x < 4u; x++) {
                sum += row[x];
                squares += (uint32_t)row[x] * row[x];
            }
        }
        logs_q4 += log2_q4(16u * squares - sum * sum + 58u * 128u); /* 128 times the sum */
    }
    const int32_t raised = logs_q4 - 4 * 206; /* 206 = 16 log2(58 * 128) */
    const int32_t activity = (raised + 40) >> 7;
    return (uint8_t)(activity < 0 ? 0 : activity > ACTIVITY_MAX ? ACTIVITY_MAX : activity);
}
