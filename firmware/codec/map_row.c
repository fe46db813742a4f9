/*
 * The label model of the disparity-map codec: neighbour candidates first, then
 * a small difference to the median prediction.
 *
 * Scratch holds three rows of labels, used in turn, each with PAD elements on
 * both sides that stay 0: outside the map everything is invalid.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_row.h"

#include <string.h>

#define PAD 2u
#define ROW_COUNT 3u

/* Where each question's contexts begin. */
#define FLAT_AT 0u /* 24: is a flat neighbourhood continued? */
#define CANDIDATE_AT (FLAT_AT + 24u)
#define INVALID_AT (CANDIDATE_AT + 38u * 16u)
#define PREDICTED_AT (INVALID_AT + 6u * 16u)
#define SIGN_AT (PREDICTED_AT + 36u)
#define MAGNITUDE_AT (SIGN_AT + 54u)
#define CONTEXTS_END (MAGNITUDE_AT + 12u * TSR_MAGNITUDE_CONTEXT_COUNT)
_Static_assert(CONTEXTS_END == TSR_MAP_CONTEXT_COUNT, "the public header sizes the model");

/* Candidates this near to the prediction are left to the difference. */
#define CANDIDATE_NEAR 3u

/* A difference no two valid labels have. */
#define GAP_INVALID 0x4000u

/* One pixel: its neighbours, what follows from them, and the labels it is known not to be. */
struct pixel {
    uint16_t w, ww, n, nw, ne, nee, nn;
    uint16_t predicted;
    unsigned gap;      /* class of |w - n|, 0..5 */
    unsigned activity; /* class of the sum of four differences, 0..5 */
    uint16_t asked[5];
    unsigned asked_count;
};

void tsr_map_model_reset(struct tsr_map_model *model)
{
    memset(model->scratch, 0, TSR_MAP_SCRATCH_COUNT(model->info.width) * sizeof *model->scratch);
    tsr_range_bits_reset(model->contexts, TSR_MAP_CONTEXT_COUNT);
    model->row = 0;
    model->last_label = (uint16_t)(1u + (model->label_count - 1u) / 4u);
    model->allowed_bits = 8u * TSR_MAP_SLACK_LEN;
}

static uint16_t *row_labels(const struct tsr_map_model *model, unsigned rows_up)
{
    const size_t at = (model->row + ROW_COUNT - rows_up) % ROW_COUNT;
    return model->scratch + at * (model->info.width + 2u * PAD) + PAD;
}

uint16_t *tsr_map_row_labels(const struct tsr_map_model *model)
{
    return row_labels(model, 0);
}

static unsigned difference(uint16_t a, uint16_t b)
{
    if (a == TSR_LABEL_INVALID || b == TSR_LABEL_INVALID) {
        return a == b ? 0 : GAP_INVALID;
    }
    return a > b ? (unsigned)a - b : (unsigned)b - a;
}

static unsigned class_of_gap(unsigned gap)
{
    return gap == 0 ? 0u : gap == 1 ? 1u : gap <= 3 ? 2u : gap <= 8 ? 3u : gap < GAP_INVALID ? 4u : 5u;
}

static unsigned class_of_activity(unsigned sum)
{
    return sum == 0 ? 0u : sum <= 2 ? 1u : sum <= 5 ? 2u : sum <= 12 ? 3u : sum < GAP_INVALID ? 4u : 5u;
}

/* The median prediction if W, N and NW are valid, else the
 * first valid of W, N, NE, NW, else the last valid label coded. */
static uint16_t predict(const struct pixel *at, uint16_t last_label)
{
    if (at->w != TSR_LABEL_INVALID && at->n != TSR_LABEL_INVALID && at->nw != TSR_LABEL_INVALID) {
        return tsr_median_prediction(at->w, at->n, at->nw);
    }
    const uint16_t firsts[4] = {at->w, at->n, at->ne, at->nw};
    for (unsigned i = 0; i < 4; i++) {
        if (firsts[i] != TSR_LABEL_INVALID) {
            return firsts[i];
        }
    }
    return last_label;
}

static unsigned class_of_run(unsigned run)
{
    return run < 1 ? 0u : run < 2 ? 1u : run < 4 ? 2u : run < 8 ? 3u : run < 16 ? 4u : 5u;
}

/* W, WW, N, NW, NE and NN are one label. */
static bool is_flat(const uint16_t *here, const uint16_t *up, const uint16_t *up2)
{
    const uint16_t w = here[-1];
    return up[0] == w && up[1] == w && up[-1] == w && here[-2] == w && up2[0] == w;
}

static unsigned flat_context(uint16_t w, const uint16_t *up, const uint16_t *up2, unsigned run)
{
    const unsigned wide = up[2] == w && up2[1] == w;
    return FLAT_AT + (w == TSR_LABEL_INVALID) + 2u * class_of_run(run) + 12u * wide;
}

/* The group tells how the candidate relates to W and N (exactly one of them
 * equals it, if they differ and fewer than 2 were asked); the mask who else agrees. */
static unsigned candidate_context(const struct pixel *at, uint16_t candidate)
{
    const unsigned invalid = candidate == TSR_LABEL_INVALID;
    unsigned group;
    if (at->asked_count >= 2 || (at->asked_count == 1 && at->w == at->n)) {
        group = 26u + at->gap + 6u * invalid;
    } else if (at->w == at->n) {
        group = invalid;
    } else {
        group = 2u + 12u * at->asked_count + 6u * (candidate == at->n) + (at->gap - 1u) + invalid;
    }
    const unsigned mask = (unsigned)(at->ne == candidate) | (unsigned)(at->nw == candidate) << 1 |
                          (unsigned)(at->ww == candidate) << 2 | (unsigned)(at->nn == candidate) << 3;
    return CANDIDATE_AT + 16u * group + mask;
}

static bool was_asked(const struct pixel *at, uint16_t label)
{
    for (unsigned i = 0; i < at->asked_count; i++) {
        if (at->asked[i] == label) {
            return true;
        }
    }
    return false;
}

/* Is it this label? */
static bool ask(struct tsr_map_model *model, const struct tsr_range_port *port, struct pixel *at, unsigned context,
                uint16_t candidate, uint16_t *label)
{
    if (tsr_port_bit(port, &model->contexts[context], *label == candidate)) {
        *label = candidate;
        return true;
    }
    at->asked[at->asked_count++] = candidate;
    return false;
}

/* Is it W or N? The one that continues an edge first. */
static bool ask_nearest(struct tsr_map_model *model, const struct tsr_range_port *port, struct pixel *at,
                        uint16_t *label)
{
    const bool upper_first = at->n != at->w && at->nw == at->w;
    const uint16_t first = upper_first ? at->n : at->w;
    const uint16_t second = upper_first ? at->w : at->n;
    return ask(model, port, at, candidate_context(at, first), first, label) ||
           (second != first && ask(model, port, at, candidate_context(at, second), second, label));
}

/* Is it NE, NW or NEE, unless the difference is as good? */
static bool ask_farther(struct tsr_map_model *model, const struct tsr_range_port *port, struct pixel *at,
                        uint16_t *label)
{
    const uint16_t candidates[3] = {at->ne, at->nw, at->nee};
    for (unsigned i = 0; i < 3; i++) {
        const uint16_t candidate = candidates[i];
        if (difference(candidate, at->predicted) > CANDIDATE_NEAR && !was_asked(at, candidate) &&
            ask(model, port, at, candidate_context(at, candidate), candidate, label)) {
            return true;
        }
    }
    return false;
}

static unsigned side_of(uint16_t neighbour, uint16_t predicted)
{
    return neighbour == TSR_LABEL_INVALID ? 1u : tsr_side_of(neighbour, predicted);
}

/* A label that no candidate was; a decoder may find -1 or more than there are. */
static int32_t code_difference(struct tsr_map_model *model, const struct tsr_range_port *port, const struct pixel *at,
                               int32_t label)
{
    struct tsr_range_bit *const contexts = model->contexts;
    if (!was_asked(at, TSR_LABEL_INVALID)) {
        const unsigned mask = (unsigned)(at->ne == 0) | (unsigned)(at->nw == 0) << 1 | (unsigned)(at->ww == 0) << 2 |
                              (unsigned)(at->nn == 0) << 3;
        if (tsr_port_bit(port, &contexts[INVALID_AT + 6u * mask + at->gap], label == 0)) {
            return 0;
        }
    }
    const int32_t predicted = at->predicted;
    const bool excluded = was_asked(at, at->predicted);
    if (!excluded && tsr_port_bit(port, &contexts[PREDICTED_AT + 6u * at->gap + at->activity], label == predicted)) {
        return predicted;
    }
    const unsigned sides =
        side_of(at->w, at->predicted) + 3u * side_of(at->n, at->predicted) + 9u * side_of(at->ne, at->predicted);
    const bool below = tsr_port_bit(port, &contexts[SIGN_AT + 2u * sides + excluded], label < predicted);
    const uint32_t known = (uint32_t)(below ? predicted - label : label - predicted) - 1u;
    struct tsr_range_bit *const magnitudes =
        &contexts[MAGNITUDE_AT + TSR_MAGNITUDE_CONTEXT_COUNT * (2u * at->activity + excluded)];
    const int32_t distance = (int32_t)tsr_port_magnitude(port, magnitudes, known) + 1;
    const int32_t coded = below ? predicted - distance : predicted + distance;
    return coded > 0 ? coded : -1;
}

static void look_around(struct pixel *at, const uint16_t *here, const uint16_t *up, const uint16_t *up2)
{
    at->w = here[-1];
    at->ww = here[-2];
    at->n = up[0];
    at->nw = up[-1];
    at->ne = up[1];
    at->nee = up[2];
    at->nn = up2[0];
    at->gap = class_of_gap(difference(at->w, at->n));
    at->asked_count = 0;
}

/* Code *here; false if the label does not exist. What a question needs is
 * computed just before it: most pixels end at the first. */
static bool code_label(struct tsr_map_model *model, const struct tsr_range_port *port, uint16_t *here,
                       const uint16_t *up, const uint16_t *up2, unsigned run)
{
    const uint16_t w = here[-1];
    const bool flat = is_flat(here, up, up2);
    if (flat && tsr_port_bit(port, &model->contexts[flat_context(w, up, up2, run)], *here == w)) {
        *here = w;
        return true;
    }
    struct pixel at;
    look_around(&at, here, up, up2);
    if (flat) {
        at.asked[at.asked_count++] = w;
    } else if (ask_nearest(model, port, &at, here)) {
        return true;
    }
    at.predicted = predict(&at, model->last_label);
    if (ask_farther(model, port, &at, here)) {
        return true;
    }
    at.activity = class_of_activity(difference(at.w, at.n) + difference(at.n, at.ne) + difference(at.w, at.nw) +
                                    difference(at.nw, at.n));
    const int32_t coded = code_difference(model, port, &at, *here);
    *here = (uint16_t)coded;
    return coded >= 0 && coded < (int32_t)model->label_count;
}

static bool code_literal(const struct tsr_map_model *model, const struct tsr_range_port *port, uint16_t *here)
{
    *here = (uint16_t)tsr_port_direct(port, *here, model->label_bits);
    return *here < model->label_count;
}

bool tsr_map_code_row(struct tsr_map_model *model, const struct tsr_range_port *port)
{
    uint16_t *here = row_labels(model, 0);
    const uint16_t *up = row_labels(model, 1);
    const uint16_t *up2 = row_labels(model, 2);
    unsigned run = 0;
    for (unsigned x = 0; x < model->info.width; x++, here++, up++, up2++) {
        const bool literal = tsr_port_spent_bits(port) > model->allowed_bits;
        if (literal ? !code_literal(model, port, here) : !code_label(model, port, here, up, up2, run)) {
            return false;
        }
        run = *here == here[-1] ? run + 1 : 0;
        model->last_label = *here != TSR_LABEL_INVALID ? *here : model->last_label;
        model->allowed_bits += model->label_bits;
    }
    model->row++;
    return true;
}
