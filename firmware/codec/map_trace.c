/*
 * The label model with someone who writes down its questions.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map_trace.h"

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

static TSR_OUT_OF_LINE bool side_rare_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    return side_bit(side, model, cell, bit);
}

static inline bool side_choice(struct side *side, struct tsr_map_model *model, unsigned kind, const uint8_t *index,
                               unsigned table_count, bool bit)
{
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

#include "map_pixel.h"

unsigned tsr_map_candidate_level(const int8_t weights[TSR_MAP_TABLE_COUNT][TSR_MAP_TABLE_LEN],
                                 const uint8_t index[TSR_MAP_TABLE_COUNT], unsigned table_count)
{
    return tsr_map_level(weights, index, table_count);
}

enum tsr_status tsr_map_trace(struct tsr_map_model *model, const struct tsr_map_info *info,
                              const struct tsr_map_reference *reference, const uint16_t *map, uint16_t *scratch,
                              size_t scratch_cap, tsr_map_question_fn tell, void *user)
{
    if (model == NULL || info == NULL || map == NULL || tell == NULL) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status = tsr_map_model_start(model, info, reference, scratch, scratch_cap);
    if (status != TSR_OK) {
        return status;
    }
    struct side side = {tell, user};
    while (model->row < info->height) {
        const uint16_t *row = map + (size_t)model->row * info->width;
        if (!tsr_map_take_row(model, row)) {
            return TSR_ERR_ARG;
        }
        (void)code_span(model, &side, info->near, 0, info->width);
        model->row++;
    }
    return TSR_OK;
}
