/*
 * The pixel model of the prefiltered-view codec: a linear expectation from
 * seven neighbours, and the level in contexts of it and of the local activity.
 *
 *                        NN
 *              NWW  NW   N    NE
 *              WW   W    x
 *
 * Contrast has no preferred sign: where the expectation is negative, all is
 * coded with the other sign.
 *
 * Scratch holds three rows of pixels, used in turn, and one row of errors: right of
 * the pixel those of the row above, left of it those of its own row. Each has two
 * elements in front and one behind that stand for what lies outside.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "view_row.h"

#include <string.h>

#include "frame.h"
#include "tsr/base/crc.h"

#define IN_FRONT 2u
#define BORDERS 3u
#define ROWS 3u

#define ACTIVITY_COUNT 6u
#define ACTIVITY_END 28
#define NODES 8u /* contexts of one level: differs, below, 3 of the distance below, 3 above */
#define DISTANCES 3u
#define LITERAL_BITS 4u
#define WEIGHTS 15 /* of all neighbours together */

/* Where each question's contexts begin. */
#define LEVELS_AT 0u
#define TILES_AT (LEVELS_AT + (TSR_VIEW_CAP_MAX + 1u) * ACTIVITY_COUNT * NODES)
#define CONTEXTS_END (TILES_AT + TSR_CODEC_FRAME_TILE_CONTEXTS)
_Static_assert(CONTEXTS_END == TSR_VIEW_CONTEXT_COUNT, "the public header sizes the model");

static const uint8_t exactly[TSR_VIEW_CAP_MAX + 1] = {0, 1, 2, 3, 4, 5, 6, 7};
static const uint8_t coarse_level_of[TSR_VIEW_CAP_MAX + 1] = {0, 1, 2, 2, 3, 3, 4, 4};
static const uint8_t coarse_value_of[TSR_VIEW_CAP_MAX + 1] = {0, 1, 2, 4, 7};

static const uint8_t class_of_activity[ACTIVITY_END] = {0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3,
                                                        3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4};

void tsr_view_clear_rows(struct tsr_view_model *model)
{
    const size_t rows_len = ROWS * ((size_t)model->info.width + BORDERS);
    memset(model->scratch, model->info.cap, rows_len);
    memset(model->scratch + rows_len, 0, TSR_VIEW_SCRATCH_LEN(model->info.width) - rows_len);
}

void tsr_view_model_reset(struct tsr_view_model *model)
{
    tsr_view_clear_rows(model);
    model->level_of = model->info.coarse ? coarse_level_of : exactly;
    model->value_of = model->info.coarse ? coarse_value_of : exactly;
    model->level_max = model->level_of[model->info.cap];
    if (model->info.coarse) {
        tsr_range_bits_load(model->contexts, tsr_view_prior, TSR_VIEW_CONTEXT_COUNT);
    } else {
        tsr_range_bits_reset(model->contexts, TSR_VIEW_CONTEXT_COUNT);
    }
    model->row = 0;
    model->check = TSR_CRC16_START_HDLC;
    model->allowed_bits = 8u * TSR_VIEW_SLACK_LEN;
}

static uint8_t *row_of(const struct tsr_view_model *model, unsigned row)
{
    return model->scratch + (size_t)(row % ROWS) * (model->info.width + BORDERS) + IN_FRONT;
}

uint8_t *tsr_view_row_pixels(const struct tsr_view_model *model)
{
    return row_of(model, model->row);
}

static uint8_t *errors_of(const struct tsr_view_model *model)
{
    return model->scratch + ROWS * (size_t)(model->info.width + BORDERS) + IN_FRONT;
}

/* What lies left and right of the row. */
static void open_row(const struct tsr_view_model *model, uint8_t *here)
{
    here[-1] = here[-2] = row_of(model, model->row + 2u)[0];
}

static void close_row(const struct tsr_view_model *model, uint8_t *here)
{
    here[model->info.width] = here[model->info.width - 1u];
}

/* The level, given the one that is expected. */
static int code_level(const struct tsr_view_model *model, const struct tsr_range_port *port,
                      struct tsr_range_bit *contexts, int expected, int level)
{
    const int max = model->level_max;
    if (!tsr_port_bit(port, &contexts[0], level != expected)) {
        return expected;
    }
    const bool below = expected == max || tsr_port_bit(port, &contexts[1], level < expected);
    const int farthest = below ? expected + max : max - expected;
    const int wanted = below ? expected - level : level - expected;
    contexts += below ? 2u : 2u + DISTANCES;
    int distance = 1;
    while (distance < farthest && tsr_port_bit(port, contexts, wanted > distance)) {
        contexts += distance < (int)DISTANCES ? 1 : 0;
        distance++;
    }
    return below ? expected - distance : expected + distance;
}

static int code_literal(const struct tsr_view_model *model, const struct tsr_range_port *port, int level)
{
    const int max = model->level_max;
    const int read = (int)tsr_port_direct(port, (uint32_t)(level + max), LITERAL_BITS);
    return (read < 2 * max ? read : 2 * max) - max;
}

/* Code a value, given 16 times the expected one; *error gets what it is off. */
static int code_value(struct tsr_view_model *model, const struct tsr_range_port *port, int expected_q4, int activity,
                      int value, uint8_t *error)
{
    const bool flip = expected_q4 < 0;
    int expected = ((flip ? -expected_q4 : expected_q4) + 8) >> 4;
    expected = expected < model->info.cap ? expected : model->info.cap;
    const int wanted = flip ? -value : value;
    int level = wanted < 0 ? -(int)model->level_of[-wanted] : (int)model->level_of[wanted];
    if (tsr_port_spent_bits(port) > model->allowed_bits) {
        level = code_literal(model, port, level);
    } else {
        const unsigned class = activity < ACTIVITY_END ? class_of_activity[activity] : ACTIVITY_COUNT - 1u;
        struct tsr_range_bit *contexts =
            &model->contexts[LEVELS_AT + ((unsigned)expected * ACTIVITY_COUNT + class) * NODES];
        level = code_level(model, port, contexts, model->level_of[expected], level);
    }
    const int coded = level < 0 ? -(int)model->value_of[-level] : (int)model->value_of[level];
    *error = (uint8_t)(coded < expected ? expected - coded : coded - expected);
    return flip ? -coded : coded;
}

static int distance_of(int a, int b)
{
    return a < b ? b - a : a - b;
}

/* Pixels x .. end - 1 of the row that is here. */
static void code_run(struct tsr_view_model *model, const struct tsr_range_port *port, uint8_t *here, uint8_t *errors,
                     unsigned x, unsigned end)
{
    const uint8_t *up = row_of(model, model->row + 2u);
    const uint8_t *up_twice = row_of(model, model->row + 1u);
    const int cap = model->info.cap;
    int ww = here[(int)x - 2], w = here[(int)x - 1];
    int nww = up[(int)x - 2], nw = up[(int)x - 1], n = up[x];
    int rise = distance_of(n, nw);
    for (; x < end; x++) {
        const int ne = up[x + 1u];
        const int next_rise = distance_of(ne, n);
        const int sum = 6 * w - 2 * ww + 15 * n - 2 * nw + 2 * ne - 5 * up_twice[x] + nww;
        const int activity = 2 * (errors[(int)x - 1] + errors[x]) + errors[(int)x - 2] + errors[x + 1u] +
                             distance_of(w, nw) + rise + next_rise;
        ww = w;
        w = cap + code_value(model, port, sum - WEIGHTS * cap, activity, here[x] - cap, &errors[x]);
        here[x] = (uint8_t)w;
        model->allowed_bits += LITERAL_BITS;
        nww = nw;
        nw = n;
        n = ne;
        rise = next_rise;
    }
}

void tsr_view_code_span(struct tsr_view_model *model, const struct tsr_range_port *port, unsigned x, unsigned end)
{
    uint8_t *here = tsr_view_row_pixels(model);
    if (x == 0) {
        open_row(model, here);
    }
    code_run(model, port, here, errors_of(model), x, end);
    if (end == model->info.width) {
        close_row(model, here);
    }
}

static uint8_t *held_row(const struct tsr_view_model *model)
{
    return model->held->packed + ((size_t)model->info.width + 1u) / 2u * model->row;
}

/* Pixels x .. end - 1 as they are held. */
static void keep_run(struct tsr_view_model *model, uint8_t *here, uint8_t *errors, unsigned x, unsigned end)
{
    const uint8_t *packed = held_row(model);
    model->allowed_bits += LITERAL_BITS * (end - x);
    for (; x < end; x++) {
        here[x] = (uint8_t)((unsigned)packed[x / 2u] >> 4u * (x % 2u) & 15u);
        errors[x] = 0;
    }
}

static void hold_row(struct tsr_view_model *model, const uint8_t *here)
{
    const unsigned width = model->info.width;
    uint8_t *packed = held_row(model);
    for (unsigned x = 0; x + 1u < width; x += 2u) {
        packed[x / 2u] = (uint8_t)(here[x] | here[x + 1u] << 4);
    }
    if (width % 2u != 0) {
        packed[width / 2u] = here[width - 1u];
    }
    model->check = tsr_crc16(model->check, packed, (width + 1u) / 2u);
}

void tsr_view_code_row(struct tsr_view_model *model, const struct tsr_range_port *port, uint8_t *out, const uint8_t *in,
                       const uint8_t *tiles)
{
    const unsigned width = model->info.width;
    const uint8_t max = (uint8_t)(2u * model->info.cap);
    uint8_t *here = row_of(model, model->row);
    uint8_t *errors = errors_of(model);
    uint8_t *flags = errors + width + 1u;
    for (unsigned x = 0; in != NULL && x < width; x++) {
        here[x] = in[x] < max ? in[x] : max;
    }
    open_row(model, here);
    if (!model->info.against_held) {
        code_run(model, port, here, errors, 0, width);
    } else {
        if (model->row % TSR_VIEW_TILE_PX == 0) {
            const unsigned count = (unsigned)TSR_VIEW_TILES_ACROSS(width);
            model->allowed_bits += tsr_codec_frame_code_tiles(port, &model->contexts[TILES_AT], flags, tiles, count);
        }
        for (unsigned x = 0; x < width; x += TSR_VIEW_TILE_PX) {
            const unsigned end = x + TSR_VIEW_TILE_PX < width ? x + TSR_VIEW_TILE_PX : width;
            if (flags[x / TSR_VIEW_TILE_PX + 1u] != 0) {
                code_run(model, port, here, errors, x, end);
            } else {
                keep_run(model, here, errors, x, end);
            }
        }
    }
    close_row(model, here);
    if (model->held != NULL) {
        hold_row(model, here);
    }
    if (out != NULL) {
        memcpy(out, here, width);
    }
    model->row++;
}
