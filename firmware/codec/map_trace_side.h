/*
 * Someone who writes down the questions, for map_pixel.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_TRACE_SIDE_H
#define TSR_CODEC_MAP_TRACE_SIDE_H

#include <string.h>

#include "map_model.h"

struct side {
    tsr_map_question_fn tell;
    void *user;
};

static inline bool side_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    const struct tsr_map_question question = {.bit = bit, .coding = model->coding, .cell = (uint16_t)cell};
    side->tell(side->user, &question);
    return bit;
}

static inline bool side_rare_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    return side_bit(side, model, cell, bit);
}

static inline bool side_choice(struct side *side, struct tsr_map_model *model, unsigned kind, const uint8_t *index,
                               unsigned cell, bool bit)
{
    (void)cell;
    const unsigned table_count = model->reference.map != NULL ? TSR_MAP_TABLE_COUNT : TSR_MAP_TABLE_COUNT_ALONE;
    struct tsr_map_question question = {.bit = bit,
                                        .is_candidate = true,
                                        .coding = model->coding,
                                        .kind = (uint8_t)kind,
                                        .table_count = (uint8_t)table_count};
    memcpy(question.index, index, table_count);
    side->tell(side->user, &question);
    return bit;
}

static inline uint32_t side_direct(struct side *side, uint32_t value, unsigned bit_count)
{
    (void)side;
    (void)bit_count;
    return value;
}

static inline size_t side_spent_bits(const struct side *side)
{
    (void)side;
    return 0;
}

void tsr_map_trace_row(struct tsr_map_model *model, struct side *side);
void tsr_map_trace_reference_row(struct tsr_map_model *model, struct side *side);
void tsr_map_trace_span(struct tsr_map_model *model, struct side *side, unsigned first, unsigned end);

#endif
