/*
 * The model of pictures: each question of a block in its context.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "picture_block.h"

#include <string.h>

#include "picture_transform.h"

#define LAST_CLASS_COUNT 12u
#define ACTIVITY_COUNT (TSR_PICTURE_ACTIVITY_MAX + 1u)
#define PLACE_COUNT 11u /* classes of a coefficient's position */
#define ABOVE_FIRST_ROW 128

/* Where each question's contexts begin. */
#define CHANGE_AT 0u
#define MODE_AT (CHANGE_AT + 2u)
#define LAST_AT (MODE_AT + 16u * 3u)
#define LAST_HALF_AT (LAST_AT + 6u * (LAST_CLASS_COUNT - 1u))
#define ACTIVITY_AT (LAST_HALF_AT + 9u)
#define NONZERO_AT (ACTIVITY_AT + ACTIVITY_COUNT * 4u * TSR_PICTURE_ACTIVITY_MAX)
#define ABOVE_ONE_AT (NONZERO_AT + PLACE_COUNT * 6u)
#define MAGNITUDE_AT (ABOVE_ONE_AT + 3u * 6u)
#define CONTEXTS_END (MAGNITUDE_AT + 4u * TSR_MAGNITUDE_CONTEXT_COUNT)
_Static_assert(CONTEXTS_END == TSR_PICTURE_CONTEXT_COUNT, "the public header sizes the model");

/* First value of each class of `last`; a class from 3 on has 1, 1, 1, 2, 2, 3, 3, 4, 4 bits. */
static const uint8_t last_starts[LAST_CLASS_COUNT + 1] = {0, 1, 2, 3, 5, 7, 9, 13, 17, 25, 33, 49, 65};
static const uint8_t last_bits[LAST_CLASS_COUNT] = {0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 4, 4};

/* Class of a coefficient's position, by 8 u + v. */
static const uint8_t places[TSR_PICTURE_COEFFICIENTS] = {
    0,  1, 4, 9, 9, 9, 9, 9, 2,  3, 6, 7, 7, 8, 8, 8, 5,  6, 7, 7, 8, 8, 8, 8, 10, 7, 7, 8, 8, 8, 8, 8,
    10, 7, 8, 8, 8, 8, 8, 8, 10, 8, 8, 8, 8, 8, 8, 8, 10, 8, 8, 8, 8, 8, 8, 8, 10, 8, 8, 8, 8, 8, 8, 8};

/* What is known of the blocks on the left and above; an unknown one is as the other. */
struct around {
    unsigned mode_context;
    unsigned last_class; /* rounded mean of both, 0..11 */
    unsigned activity;   /* rounded mean of both */
};

struct tsr_picture_rows tsr_picture_rows_of(const struct tsr_picture_model *model)
{
    const size_t blocks = TSR_PICTURE_BLOCKS(model->info.width);
    uint8_t *const after = model->scratch + 10u * TSR_PICTURE_BLOCK * blocks;
    const size_t odd = model->band % 2u;
    return (struct tsr_picture_rows){.blocks = blocks,
                                     .stride = TSR_PICTURE_BLOCK * blocks,
                                     .pixels = model->scratch,
                                     .modes = after,
                                     .lasts = after + blocks,
                                     .activities = after + 2u * blocks,
                                     .limits = after + (3u + odd) * blocks,
                                     .limits_above = after + (4u - odd) * blocks};
}

void tsr_picture_keep_last_rows(const struct tsr_picture_rows *rows)
{
    memcpy(rows->pixels, rows->pixels + TSR_PICTURE_BLOCK * rows->stride, 2u * rows->stride);
}

void tsr_picture_model_reset(struct tsr_picture_model *model)
{
    memset(model->scratch, 0, TSR_PICTURE_SCRATCH_LEN(model->info.width));
    if (model->info.prior == TSR_PICTURE_PRIOR_TRAINED) {
        tsr_range_bits_load(model->contexts, tsr_picture_prior, TSR_PICTURE_CONTEXT_COUNT);
    } else {
        tsr_range_bits_reset(model->contexts, TSR_PICTURE_CONTEXT_COUNT);
    }
    model->row = 0;
    model->band = 0;
    model->step = model->info.step;
    model->allowed_bits = 8u * TSR_PICTURE_SLACK_LEN;
}

static unsigned class_of_last(unsigned last)
{
    unsigned class = 0;
    while (last >= last_starts[class + 1u]) {
        class ++;
    }
    return class;
}

static struct around look_around(const struct tsr_picture_rows *rows, size_t x, struct tsr_picture_known known)
{
    struct around a = {.mode_context = 0, .last_class = 5, .activity = 2};
    if (known.left || known.above) {
        const size_t left = known.left ? x - 1u : x, above = known.above ? x : x - 1u;
        a.mode_context = (known.left ? 4u * rows->modes[left] : 0u) + (known.above ? rows->modes[above] : 0u);
        a.last_class = (class_of_last(rows->lasts[left]) + class_of_last(rows->lasts[above]) + 1u) / 2u;
        a.activity = ((unsigned)rows->activities[left] + rows->activities[above] + 1u) / 2u;
    }
    return a;
}

static uint8_t code_mode(struct tsr_range_bit *contexts, const struct tsr_range_port *port, unsigned mode)
{
    const bool high = tsr_port_bit(port, &contexts[0], mode >= 2u);
    const bool low = tsr_port_bit(port, &contexts[high ? 2 : 1], (mode & 1u) != 0);
    return (uint8_t)((high ? 2 : 0) + (low ? 1 : 0));
}

static uint8_t code_last(struct tsr_picture_model *model, const struct tsr_range_port *port, const struct around *a,
                         unsigned last)
{
    struct tsr_range_bit *const contexts = &model->contexts[LAST_AT + a->last_class / 2u * (LAST_CLASS_COUNT - 1u)];
    const unsigned known = class_of_last(last);
    unsigned class = 0;
    while (class < LAST_CLASS_COUNT - 1u && tsr_port_bit(port, &contexts[class], class < known)) {
        class ++;
    }
    const unsigned bits = last_bits[class];
    unsigned place = 0;
    if (bits > 0) {
        const unsigned wanted = last - last_starts[class];
        place = tsr_port_bit(port, &model->contexts[LAST_HALF_AT + class - 3u], (wanted >> (bits - 1u) & 1u) != 0);
        if (bits > 1u) {
            const unsigned rest = bits - 1u;
            place = place << rest | tsr_port_direct(port, wanted & ((1u << rest) - 1u), rest);
        }
    }
    return (uint8_t)(last_starts[class] + place);
}

static uint8_t code_activity(struct tsr_picture_model *model, const struct tsr_range_port *port, const struct around *a,
                             const struct tsr_picture_block *block)
{
    const unsigned size = block->last <= 1u ? 0u : block->last <= 5u ? 1u : block->last <= 20u ? 2u : 3u;
    struct tsr_range_bit *const contexts =
        &model->contexts[ACTIVITY_AT + (4u * a->activity + size) * TSR_PICTURE_ACTIVITY_MAX];
    unsigned activity = 0;
    while (activity < TSR_PICTURE_ACTIVITY_MAX && tsr_port_bit(port, &contexts[activity], activity < block->activity)) {
        activity++;
    }
    return (uint8_t)activity;
}

/* Sums of magnitudes at (u, v + 1), (u + 1, v), (u + 1, v + 1), (u, v + 2), (u + 2, v), kept at 10 (u + 2) + v + 2:
 * room for two positions outside. */
#define SUMS_STRIDE 10u
#define SUMS_LEN (SUMS_STRIDE * SUMS_STRIDE)
#define MAGNITUDE_CAP 15u

static void add_to_sums(uint8_t *sum, unsigned magnitude)
{
    const uint8_t added = (uint8_t)(magnitude < MAGNITUDE_CAP ? magnitude : MAGNITUDE_CAP);
    sum[-1] = (uint8_t)(sum[-1] + added);
    sum[-2] = (uint8_t)(sum[-2] + added);
    sum[-(int)SUMS_STRIDE] = (uint8_t)(sum[-(int)SUMS_STRIDE] + added);
    sum[-(int)SUMS_STRIDE - 1] = (uint8_t)(sum[-(int)SUMS_STRIDE - 1] + added);
    sum[-2 * (int)SUMS_STRIDE] = (uint8_t)(sum[-2 * (int)SUMS_STRIDE] + added);
}

/* A level that is not 0. */
static int16_t code_level(struct tsr_picture_model *model, const struct tsr_range_port *port, size_t k, unsigned sum,
                          int level)
{
    const unsigned known = (unsigned)(level < 0 ? -level : level);
    const unsigned third = k == 0 ? 0u : k < 3u ? 1u : 2u;
    unsigned magnitude = 1;
    if (tsr_port_bit(port, &model->contexts[ABOVE_ONE_AT + 6u * third + (sum < 5u ? sum : 5u)], known > 1u)) {
        const unsigned set = k == 0 ? 0u : sum < 3u ? 1u : sum < 8u ? 2u : 3u;
        magnitude = 2u + tsr_port_magnitude(port, &model->contexts[MAGNITUDE_AT + set * TSR_MAGNITUDE_CONTEXT_COUNT],
                                            known - 2u);
    }
    const bool below = tsr_port_direct(port, level < 0, 1) != 0;
    return (int16_t)(below ? -(int)magnitude : (int)magnitude);
}

static void code_levels(struct tsr_picture_model *model, const struct tsr_range_port *port,
                        struct tsr_picture_block *block)
{
    uint8_t sums[SUMS_LEN];
    memset(sums, 0, sizeof sums);
    for (size_t k = block->last; k-- > 0;) {
        const unsigned at = tsr_picture_zigzag[k];
        uint8_t *const sum = &sums[SUMS_STRIDE * (at / 8u + 2u) + at % 8u + 2u];
        struct tsr_range_bit *const nonzero = &model->contexts[NONZERO_AT + 6u * places[at] + (*sum < 5u ? *sum : 5u)];
        if (k + 1u < block->last && !tsr_port_bit(port, nonzero, block->levels[k] != 0)) {
            block->levels[k] = 0;
            continue;
        }
        const int16_t level = code_level(model, port, k, *sum, block->levels[k]);
        block->levels[k] = level;
        add_to_sums(sum, (unsigned)(level < 0 ? -level : level));
    }
}

static void take_border(struct tsr_picture_border *border, const struct tsr_picture_rows *rows, size_t x,
                        struct tsr_picture_known known)
{
    static const uint8_t nothing[TSR_PICTURE_BLOCK] = {ABOVE_FIRST_ROW, ABOVE_FIRST_ROW, ABOVE_FIRST_ROW,
                                                       ABOVE_FIRST_ROW, ABOVE_FIRST_ROW, ABOVE_FIRST_ROW,
                                                       ABOVE_FIRST_ROW, ABOVE_FIRST_ROW};
    const uint8_t *const band = rows->pixels + 2u * rows->stride + TSR_PICTURE_BLOCK * x;
    const uint8_t *above = band - rows->stride, *left = band - 1;
    size_t left_stride = rows->stride;
    uint8_t same[TSR_PICTURE_BLOCK];
    if (!known.above && !known.left) {
        above = nothing;
        left = nothing;
        left_stride = 1;
    } else if (!known.above) {
        memset(same, left[0], sizeof same);
        above = same;
    } else if (!known.left) {
        memset(same, above[0], sizeof same);
        left = same;
        left_stride = 1;
    }
    tsr_picture_border_of(border, above, left, left_stride);
}

void tsr_picture_code_block(struct tsr_picture_model *model, const struct tsr_range_port *port,
                            const struct tsr_picture_rows *rows, size_t x, struct tsr_picture_known known)
{
    const struct around a = look_around(rows, x, known);
    uint8_t *const pixels = rows->pixels + 2u * rows->stride + TSR_PICTURE_BLOCK * x;
    struct tsr_picture_border border;
    struct tsr_picture_block block = {.mode = TSR_PICTURE_MEAN, .last = 0};
    take_border(&border, rows, x, known);
    const bool predicted_only = tsr_port_spent_bits(port) > model->allowed_bits;
    model->allowed_bits += 8u * TSR_PICTURE_COEFFICIENTS;
    if (!predicted_only) {
        if (port->encoder != NULL) {
            block.activity = tsr_picture_activity(pixels, rows->stride);
            tsr_picture_quantise(&block, &border, tsr_picture_step_q6(model->step + 4u * block.activity), pixels,
                                 rows->stride);
        }
        block.mode = code_mode(&model->contexts[MODE_AT + 3u * a.mode_context], port, block.mode);
        block.last = code_last(model, port, &a, block.last);
    }
    if (block.last > 0) {
        block.activity = code_activity(model, port, &a, &block);
        code_levels(model, port, &block);
    } else {
        block.activity = (uint8_t)a.activity;
    }
    const uint32_t step_q6 = tsr_picture_step_q6(model->step + 4u * block.activity);
    tsr_picture_reconstruct(&block, &border, step_q6, pixels, rows->stride);
    rows->limits[x] = tsr_picture_limit_of(step_q6);
    rows->modes[x] = block.mode;
    rows->lasts[x] = block.last;
    rows->activities[x] = block.activity;
}

/* 0, or a sign and 1 .. 8. */
static int code_change(struct tsr_picture_model *model, const struct tsr_range_port *port, int change)
{
    if (!tsr_port_bit(port, &model->contexts[CHANGE_AT], change != 0)) {
        return 0;
    }
    const bool down = tsr_port_bit(port, &model->contexts[CHANGE_AT + 1u], change < 0);
    const int size = 1 + (int)tsr_port_direct(port, (uint32_t)((change < 0 ? -change : change) - 1), 3);
    return down ? -size : size;
}

void tsr_picture_code_band(struct tsr_picture_model *model, const struct tsr_range_port *port, int change)
{
    const struct tsr_picture_rows rows = tsr_picture_rows_of(model);
    const int step = model->step + code_change(model, port, change);
    model->step = (uint8_t)(step < 0 ? 0 : step > TSR_PICTURE_STEP_MAX ? TSR_PICTURE_STEP_MAX : step);
    for (size_t x = 0; x < rows.blocks; x++) {
        tsr_picture_code_block(model, port, &rows, x, (struct tsr_picture_known){x > 0, model->band > 0});
    }
    model->band++;
}
