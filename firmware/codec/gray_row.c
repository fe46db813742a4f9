/*
 * The pixel model of the gray-image codec: median prediction, and the
 * prediction error in contexts of the local activity.
 *
 * Scratch holds two rows of decoded pixels, used in turn, and one row of
 * prediction errors: right of the pixel those of the row above, left of it
 * those of its own row.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "gray_row.h"

#include <string.h>

#define ABOVE_FIRST_ROW 128
#define ENERGY_COUNT 9u

/* Where each question's contexts begin. */
#define ZERO_AT 0u
#define SIGN_AT (ZERO_AT + ENERGY_COUNT)
#define MAGNITUDE_AT (SIGN_AT + 27u)
#define CONTEXTS_END (MAGNITUDE_AT + ENERGY_COUNT * TSR_MAGNITUDE_CONTEXT_COUNT)
_Static_assert(CONTEXTS_END == TSR_GRAY_CONTEXT_COUNT, "the public header sizes the model");

struct around {
    uint8_t w, n, nw, ne;
    uint8_t predicted;
    unsigned energy; /* class, 0..8 */
};

/* Noise decides a match where the image is flat, and what differs by it is lost between edges. */
static const uint8_t nears_by_activity[ENERGY_COUNT] = {0, 0, 0, 0, 0, 0, 1, 2, TSR_GRAY_NEAR_BY_ACTIVITY_MAX};
_Static_assert(ENERGY_COUNT == TSR_GRAY_ENERGY_COUNT, "the public header sizes the model");

void tsr_gray_model_reset(struct tsr_gray_model *model)
{
    const size_t width = model->info.width;
    memset(model->nears, model->info.near, ENERGY_COUNT);
    if (model->info.near == TSR_GRAY_NEAR_BY_ACTIVITY) {
        memcpy(model->nears, nears_by_activity, ENERGY_COUNT);
    }
    memset(model->scratch, ABOVE_FIRST_ROW, 2u * width);
    memset(model->scratch + 2u * width, 0, width);
    tsr_range_bits_reset(model->contexts, TSR_GRAY_CONTEXT_COUNT);
    model->row = 0;
    model->allowed_bits = 8u * TSR_GRAY_SLACK_LEN;
}

uint8_t *tsr_gray_row_pixels(const struct tsr_gray_model *model)
{
    return model->scratch + (size_t)(model->row % 2u) * model->info.width;
}

static unsigned class_of_energy(unsigned energy)
{
    static const uint8_t ends[ENERGY_COUNT - 1] = {3, 6, 10, 15, 22, 32, 48, 80};
    unsigned class = 0;
    while (class < ENERGY_COUNT - 1 && energy >= ends[class]) {
        class ++;
    }
    return class;
}

static unsigned difference(uint8_t a, uint8_t b)
{
    return a > b ? (unsigned)a - b : (unsigned)b - a;
}

/* Left of the first column lies the pixel above it, right of the last column the same. */
static void look_around(struct around *a, const uint8_t *here, const uint8_t *up, const uint8_t *errors, unsigned x,
                        unsigned width)
{
    a->n = up[x];
    a->w = x > 0 ? here[x - 1] : a->n;
    a->nw = x > 0 ? up[x - 1] : a->n;
    a->ne = x + 1 < width ? up[x + 1] : a->n;
    a->predicted = (uint8_t)tsr_median_prediction(a->w, a->n, a->nw);
    const unsigned w_error = x > 0 ? errors[x - 1] : 0u;
    const unsigned ne_error = x + 1 < width ? errors[x + 1] : 0u;
    a->energy = class_of_energy(difference(a->ne, a->n) + difference(a->n, a->nw) + difference(a->nw, a->w) +
                                2u * (w_error + errors[x]) + ne_error);
}

/* Round to the nearest multiple of 2 near + 1, symmetric about zero. */
static int quantise(int error, int near)
{
    const int step = 2 * near + 1;
    return error >= 0 ? (error + near) / step : -((near - error) / step);
}

static uint8_t code_pixel(struct tsr_gray_model *model, const struct tsr_range_port *port, const struct around *a,
                          uint8_t pixel)
{
    struct tsr_range_bit *const contexts = model->contexts;
    const int near = model->nears[a->energy];
    const int error = quantise((int)pixel - a->predicted, near);
    if (!tsr_port_bit(port, &contexts[ZERO_AT + a->energy], error != 0)) {
        return a->predicted;
    }
    const unsigned sides =
        tsr_side_of(a->w, a->predicted) + 3u * tsr_side_of(a->n, a->predicted) + 9u * tsr_side_of(a->ne, a->predicted);
    const bool below = tsr_port_bit(port, &contexts[SIGN_AT + sides], error < 0);
    struct tsr_range_bit *const magnitudes = &contexts[MAGNITUDE_AT + TSR_MAGNITUDE_CONTEXT_COUNT * a->energy];
    const int distance = 1 + (int)tsr_port_magnitude(port, magnitudes, (uint32_t)((error < 0 ? -error : error) - 1));
    const int coded = a->predicted + (below ? -distance : distance) * (2 * near + 1);
    return (uint8_t)(coded < 0 ? 0 : coded > 255 ? 255 : coded);
}

void tsr_gray_code_span(struct tsr_gray_model *model, const struct tsr_range_port *port, unsigned x, unsigned end)
{
    const unsigned width = model->info.width;
    uint8_t *const here = tsr_gray_row_pixels(model);
    const uint8_t *const up = model->scratch + (size_t)(1u - model->row % 2u) * width;
    uint8_t *const errors = tsr_gray_row_errors(model);
    for (; x < end; x++) {
        struct around a;
        look_around(&a, here, up, errors, x, width);
        if (tsr_port_spent_bits(port) > model->allowed_bits) {
            here[x] = (uint8_t)tsr_port_direct(port, here[x], 8);
        } else {
            here[x] = code_pixel(model, port, &a, here[x]);
        }
        errors[x] = (uint8_t)difference(here[x], a.predicted);
        model->allowed_bits += 8u;
    }
}

void tsr_gray_code_row(struct tsr_gray_model *model, const struct tsr_range_port *port)
{
    tsr_gray_code_span(model, port, 0, model->info.width);
    model->row++;
}
