/*
 * One row through the label model, written once for every direction.
 *
 * The file that includes this has defined its side of the questions:
 *
 *   AGAINST_REFERENCE         whether the map is coded against a reference: 0 or 1
 *   struct side               what answers them
 *   side_bit(side, model, cell, bit)                one adaptive bit, inline: of the questions that most pixels end at
 *   side_rare_bit(side, model, cell, bit)           the same, out of line
 *   side_choice(side, model, kind, index, cell, bit)
 *                             the same for a candidate, whose cell the trained tables have chosen by kind and index
 *   side_direct(side, value, bit_count)             equally likely bits
 *   side_spent_bits(side)                           shifted out so far
 *
 * Every question takes the bit that an encoder knows and returns the bit that
 * was coded; a decoder ignores the argument. *here holds the label when
 * encoding and whatever when decoding, and the coded label afterwards.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_PIXEL_H
#define TSR_CODEC_MAP_PIXEL_H

#include "map_around.h"
#include "range_port.h"

/* Candidates this near to the prediction are left to the difference. */
#define CANDIDATE_NEAR 3u
#define RUN_MAX 16u /* longer runs are alike */
/* Kinds of candidates: 0 W and N are one; W and N in the order of ask_nearest(), 1 N first, 2 W first, 3 N second, 4 W
 * second; 5 all others. */
#define KIND_BOTH 0u
#define KIND_N_FIRST 1u
#define KIND_W_FIRST 2u
#define KIND_N_SECOND 3u
#define KIND_W_SECOND 4u
#define KIND_OTHER 5u

/* The context that the trained tables choose. */
static inline unsigned candidate_cell(unsigned kind, const uint8_t *index)
{
    const int8_t(*const weights)[TSR_MAP_TABLE_LEN] = tsr_map_prior.weights[kind];
    int sum = weights[0][index[0]] + weights[1][index[1]] + weights[2][index[2]] + weights[3][index[3]] +
              weights[4][index[4]];
    if (AGAINST_REFERENCE) {
        const int8_t(*const more)[TSR_MAP_TABLE_LEN] = tsr_map_reference_prior.weights[kind];
        sum += more[0][index[5]] + more[1][index[6]] + more[2][index[7]];
    }
    return TSR_MAP_CANDIDATE_AT + TSR_MAP_LEVEL_COUNT * kind + tsr_map_level(sum);
}

/* Is it this label? */
static TSR_OUT_OF_LINE bool ask(struct tsr_map_model *model, struct side *side, const struct around *at,
                                struct asked *asked, unsigned kind, unsigned candidate)
{
    const unsigned w = at->here[-1], n = at->up[0];
    uint8_t index[TSR_MAP_TABLE_COUNT] = {
        (uint8_t)pair_index(pair_of(at->up + 1), candidate),
        (uint8_t)pair_index(pair_of(at->up - 2), candidate),
        (uint8_t)pair_index(pair_of(at->up2), candidate),
        (uint8_t)pair_index(pair_of(at->here - 3), candidate),
        (uint8_t)pair_index((candidate == w ? n : w) | (uint32_t)at->up2[-1] << 16, candidate),
    };
    if (AGAINST_REFERENCE) {
        index_reference(at, candidate, index + TSR_MAP_TABLE_COUNT_ALONE);
    }
    if (side_choice(side, model, kind, index, candidate_cell(kind, index), is_near(at, candidate))) {
        *at->here = (uint16_t)candidate;
        return true;
    }
    asked->label[asked->count++] = (uint16_t)candidate;
    return false;
}

/* Is it W or N? The one that continues an edge first. */
static inline bool ask_nearest(struct tsr_map_model *model, struct side *side, const struct around *at,
                               struct asked *asked)
{
    const unsigned w = at->here[-1], n = at->up[0];
    if (w == n) {
        return ask(model, side, at, asked, KIND_BOTH, w);
    }
    const bool upper_first = at->up[-1] == w;
    const unsigned first = upper_first ? n : w, second = upper_first ? w : n;
    return ask(model, side, at, asked, upper_first ? KIND_N_FIRST : KIND_W_FIRST, first) ||
           ask(model, side, at, asked, upper_first ? KIND_W_SECOND : KIND_N_SECOND, second);
}

/* Is it what the reference has there? */
static inline bool ask_still(struct tsr_map_model *model, struct side *side, const struct around *at,
                             struct asked *asked)
{
    return AGAINST_REFERENCE && !was_asked(asked, at->still.here) &&
           ask(model, side, at, asked, KIND_OTHER, at->still.here);
}

/* Is it NE, NW or NEE, unless the difference is as good? */
static inline bool ask_farther(struct tsr_map_model *model, struct side *side, const struct around *at,
                               struct asked *asked, unsigned predicted)
{
    const uint16_t candidates[3] = {at->up[1], at->up[-1], at->up[2]};
    for (unsigned i = 0; i < 3; i++) {
        if (difference(candidates[i], predicted) > CANDIDATE_NEAR && !was_asked(asked, candidates[i]) &&
            ask(model, side, at, asked, KIND_OTHER, candidates[i])) {
            return true;
        }
    }
    return false;
}

/* What the reference has, if W or N is as it was; else the median of W, N and W + N - NW (LOCO-I), or the first that
 * is a match. */
static inline unsigned predict(const struct tsr_map_model *model, const struct around *at)
{
    const unsigned invalid = model->invalid;
    const unsigned w = at->here[-1], n = at->up[0], nw = at->up[-1], ne = at->up[1];
    if (AGAINST_REFERENCE && at->still.here != invalid && (w == at->still.w || n == at->still.n)) {
        return at->still.here;
    }
    if (w != invalid && n != invalid && nw != invalid) {
        return tsr_median_prediction((uint16_t)w, (uint16_t)n, (uint16_t)nw);
    }
    return w != invalid ? w : n != invalid ? n : ne != invalid ? ne : nw != invalid ? nw : model->last_label;
}

/* 0, 1, 2: below the prediction; as it or no match; above it. */
static inline unsigned side_of(unsigned neighbour, unsigned predicted, unsigned invalid)
{
    return neighbour == invalid ? 1u : tsr_side_of(neighbour, predicted);
}

static inline uint32_t code_magnitude(struct tsr_map_model *model, struct side *side, unsigned context,
                                      uint32_t magnitude)
{
    const unsigned target = tsr_magnitude_bucket(magnitude);
    unsigned bucket = 0;
    while (bucket < TSR_MAGNITUDE_SINGLES &&
           side_rare_bit(side, model, TSR_MAP_NEARER_AT + 12u * bucket + context, target > bucket)) {
        bucket++;
    }
    while (bucket >= TSR_MAGNITUDE_SINGLES && bucket < TSR_MAGNITUDE_BUCKET_LAST &&
           side_rare_bit(side, model, TSR_MAP_FARTHER_AT + bucket - TSR_MAGNITUDE_SINGLES, target > bucket)) {
        bucket++;
    }
    if (bucket < TSR_MAGNITUDE_SINGLES) {
        return bucket;
    }
    const unsigned rest_bits = bucket - TSR_MAGNITUDE_SINGLES;
    const uint32_t first = (2u << rest_bits) + 2u;
    const uint32_t place = magnitude - first;
    const uint32_t upper = side_rare_bit(side, model, TSR_MAP_HALF_AT + rest_bits, (place >> rest_bits & 1u) != 0);
    const uint32_t rest = rest_bits > 0 ? side_direct(side, place & ((1u << rest_bits) - 1u), rest_bits) : 0;
    return first + (upper << rest_bits) + rest;
}

/* A label that no candidate was; false if it does not exist. */
static inline bool code_difference(struct tsr_map_model *model, struct side *side, const struct around *at,
                                   const struct asked *asked, unsigned predicted)
{
    const unsigned invalid = model->invalid;
    const unsigned w = at->here[-1], n = at->up[0], nw = at->up[-1], ne = at->up[1];
    if (!was_asked(asked, invalid)) {
        const unsigned mask = (unsigned)(ne == invalid) | (unsigned)(nw == invalid) << 1 |
                              (unsigned)(at->here[-2] == invalid) << 2 | (unsigned)(at->up2[0] == invalid) << 3;
        if (side_rare_bit(side, model, TSR_MAP_INVALID_AT + 6u * mask + asked->gap, *at->here == invalid)) {
            *at->here = (uint16_t)invalid;
            return true;
        }
    }
    const unsigned activity =
        class_of_activity(difference(w, n) + difference(n, ne) + difference(w, nw) + difference(nw, n));
    const bool excluded = was_asked(asked, predicted);
    if (!excluded &&
        side_rare_bit(side, model, TSR_MAP_PREDICTED_AT + 6u * asked->gap + activity, is_near(at, predicted))) {
        *at->here = (uint16_t)predicted;
        return true;
    }
    const unsigned sides =
        side_of(w, predicted, invalid) + 3u * side_of(n, predicted, invalid) + 9u * side_of(ne, predicted, invalid);
    const bool below = side_rare_bit(side, model, TSR_MAP_SIGN_AT + sides, *at->here < predicted);
    const uint32_t away = difference(*at->here, predicted) - 1u;
    const uint32_t magnitude = code_magnitude(model, side, 2u * activity + excluded, away) + 1u;
    if (below ? magnitude > predicted : predicted + magnitude >= model->label_count) {
        return false;
    }
    *at->here = (uint16_t)(below ? predicted - magnitude : predicted + magnitude);
    return true;
}

/* N, NE, NW, WW and NN all as W. After a pixel of a flat neighbourhood that was continued only NE and NN are new. */
static inline bool is_flat(const struct around *at, bool continued)
{
    const unsigned w = at->here[-1];
    return (continued || (at->up[0] == w && at->up[-1] == w && at->here[-2] == w)) && at->up[1] == w && at->up2[0] == w;
}

static const uint8_t twice_run_classes[RUN_MAX + 1u] = {0, 2, 4, 4, 6, 6, 6, 6, 8, 8, 8, 8, 8, 8, 8, 8, 10};

static inline unsigned flat_context(const struct tsr_map_model *model, const struct around *at)
{
    const unsigned w = at->here[-1];
    const unsigned context = w == model->invalid;
    if (AGAINST_REFERENCE) {
        return context + 2u * (unsigned)(at->still.here == w) + 4u * (unsigned)(at->still.e == w) +
               8u * (unsigned)(at->still.s == w) + 16u * (unsigned)(changes(at) != 0);
    }
    return context + twice_run_classes[at->run] + 12u * (unsigned)(at->up[2] == w) + 24u * (unsigned)(at->up2[1] == w);
}

/* What a flat neighbourhood did not continue, or one that is none; false if the label does not exist. What a question
 * needs is computed just before it. */
static TSR_OUT_OF_LINE bool code_label(struct tsr_map_model *model, struct side *side, const struct around *at,
                                       bool flat)
{
    struct asked asked; /* of which count says how much is set */
    asked.count = 0;
    if (flat) {
        asked.label[asked.count++] = at->here[-1];
    } else if (ask_nearest(model, side, at, &asked)) {
        return true;
    }
    if (ask_still(model, side, at, &asked)) {
        return true;
    }
    const unsigned predicted = predict(model, at);
    if (!flat && ask_farther(model, side, at, &asked, predicted)) {
        return true;
    }
    asked.gap = class_of_gap(difference(at->here[-1], at->up[0]));
    return code_difference(model, side, at, &asked, predicted);
}

/* A disparity of the reference, one that this map cannot have as none. */
static inline uint16_t reference_label(const struct tsr_map_model *model, uint16_t value)
{
    const uint16_t label = TSR_MAP_LABEL(value, model->info.step_log2);
    return label < model->label_count ? label : model->invalid;
}

static inline struct still look_up(const struct tsr_map_model *model, unsigned x)
{
    const struct tsr_map_reference *reference = &model->reference;
    const unsigned y = model->row, width = model->info.width;
    const uint16_t *row = reference->map + (size_t)y * reference->stride + x;
    const uint16_t *above = row - reference->stride, *below = row + reference->stride;
    const bool left = x > 0, right = x + 1u < width, top = y > 0, bottom = y + 1u < model->info.height;
    const uint16_t none = model->invalid;
    return (struct still){.here = reference_label(model, row[0]),
                          .w = left ? reference_label(model, row[-1]) : none,
                          .e = right ? reference_label(model, row[1]) : none,
                          .n = top ? reference_label(model, above[0]) : none,
                          .nw = top && left ? reference_label(model, above[-1]) : none,
                          .ne = top && right ? reference_label(model, above[1]) : none,
                          .s = bottom ? reference_label(model, below[0]) : none,
                          .se = bottom && right ? reference_label(model, below[1]) : none};
}

/* The same for the pixel x after the one before it: three of the eight are new. */
static inline void slide(const struct tsr_map_model *model, struct still *still, unsigned x)
{
    const struct tsr_map_reference *reference = &model->reference;
    const unsigned y = model->row;
    const uint16_t *row = reference->map + (size_t)y * reference->stride + x + 1u;
    const bool right = x + 1u < model->info.width;
    still->w = still->here;
    still->here = still->e;
    still->nw = still->n;
    still->n = still->ne;
    still->s = still->se;
    still->e = right ? reference_label(model, row[0]) : model->invalid;
    still->ne = right && y > 0 ? reference_label(model, *(row - reference->stride)) : model->invalid;
    still->se = right && y + 1u < model->info.height ? reference_label(model, row[reference->stride]) : model->invalid;
}

static inline bool code_literal(const struct tsr_map_model *model, struct side *side, uint16_t *here)
{
    const uint32_t none = model->label_count;
    const uint32_t label = side_direct(side, *here == model->invalid ? none : *here, model->label_bits);
    *here = (uint16_t)(label == none ? model->invalid : label);
    return label <= none;
}

/* Continue a flat neighbourhood, of a map alone, while the rows above are flat right of it too: up to count pixels.
 * Returns how many were continued; *missed tells whether the next one was asked and is not. This is where most pixels
 * end, so it is a loop of its own. */
static TSR_OUT_OF_LINE unsigned continue_flat(struct tsr_map_model *model, struct side *side, struct around *at,
                                              unsigned count, bool *missed)
{
    uint16_t *const here = at->here;
    const uint16_t *const up = at->up + 1, *const up2 = at->up2;
    const unsigned w = here[-1], near = at->near;
    const uint32_t both = w * 0x10001u;
    const unsigned context = TSR_MAP_FLAT_AT + 36u + (w == model->invalid);
    struct side local = *side; /* in registers */
    unsigned run = at->run, done = 0;
    for (; done < count && pair_of(up + done) == both && pair_of(up2 + done) == both; done++) {
        if (!side_bit(&local, model, context + twice_run_classes[run], difference(here[done], w) <= near)) {
            *missed = true;
            break;
        }
        here[done] = (uint16_t)w;
        run += run < RUN_MAX;
    }
    *side = local;
    at->run = run;
    at->here += done;
    at->up += done;
    at->up2 += done;
    return done;
}

/* An encoder that may take a near label takes the reference's, if that is near, and no other: neighbours that are near
 * would move the map from the reference, which predicts it. */
static inline void prefer_still(struct around *at)
{
    at->near_here = at->near;
    if (at->near > 0 && difference(*at->here, at->still.here) <= at->near) {
        *at->here = at->still.here;
        at->near_here = 0;
    }
}

/* A pixel as labels are coded; *continued for the next one. */
static inline bool code_pixel(struct tsr_map_model *model, struct side *side, struct around *at, bool *continued)
{
    const unsigned w = at->here[-1];
    if (AGAINST_REFERENCE) {
        prefer_still(at);
    }
    const bool flat = is_flat(at, *continued);
    *continued = flat && side_bit(side, model, TSR_MAP_FLAT_AT + flat_context(model, at), is_near(at, w));
    if (*continued) {
        *at->here = (uint16_t)w;
        return true;
    }
    return code_label(model, side, at, flat);
}

/* What follows from a pixel for the next one. */
static inline void step_on(struct tsr_map_model *model, struct around *at)
{
    const unsigned label = *at->here;
    at->run = label != at->here[-1] ? 0 : at->run < RUN_MAX ? at->run + 1u : RUN_MAX;
    if (label != model->invalid) {
        model->last_label = (uint16_t)label;
    }
    at->here++;
    at->up++;
    at->up2++;
}

/* Columns x .. end - 1, all coded as labels. */
static inline bool code_labels(struct tsr_map_model *model, struct side *side, struct around *at, unsigned x,
                               unsigned end, bool *continued)
{
    if (AGAINST_REFERENCE) {
        at->still = look_up(model, x);
    }
    while (x < end) {
        bool missed = false;
        if (*continued && !AGAINST_REFERENCE) {
            x += continue_flat(model, side, at, end - x, &missed);
            if (x == end) {
                return true;
            }
        }
        *continued = missed ? false : *continued;
        if (missed ? !code_label(model, side, at, true) : !code_pixel(model, side, at, continued)) {
            return false;
        }
        step_on(model, at);
        x++;
        if (AGAINST_REFERENCE && x < end) {
            slide(model, &at->still, x);
        }
    }
    return true;
}

/* Columns first .. end - 1 of the row, in one call or several; false if a label does not exist. */
static inline bool code_span(struct tsr_map_model *model, struct side *side, unsigned near, unsigned first,
                             unsigned end)
{
    struct around at = {.here = tsr_map_row_labels(model, 0) + first,
                        .up = tsr_map_row_labels(model, 1) + first,
                        .up2 = tsr_map_row_labels(model, 2) + first,
                        .near = near,
                        .run = first > 0 ? model->run : 0};
    bool continued = false;
    for (unsigned x = first; x < end;) {
        const unsigned left = TSR_MAP_LITERAL_PIXELS - x % TSR_MAP_LITERAL_PIXELS;
        const unsigned stop = left < end - x ? x + left : end;
        const bool literal = side_spent_bits(side) > model->allowed_bits;
        model->allowed_bits += (stop - x) * model->label_bits;
        if (!literal) {
            if (!code_labels(model, side, &at, x, stop, &continued)) {
                return false;
            }
            x = stop;
            continue;
        }
        for (; x < stop; x++) {
            if (!code_literal(model, side, at.here)) {
                return false;
            }
            step_on(model, &at);
        }
        continued = false;
    }
    model->run = (uint8_t)at.run;
    return true;
}

#endif
