/*
 * The encoder's direction of the label model.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"
#include "range_fixed.h"

struct side {
    struct tsr_range_encoder range;
};

static inline bool side_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    tsr_fixed_encode(&side->range, &model->cells[cell], bit);
    return bit;
}

static TSR_OUT_OF_LINE bool side_rare_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    return side_bit(side, model, cell, bit);
}

static inline bool side_choice(struct side *side, struct tsr_map_model *model, unsigned kind, const uint8_t *index,
                               unsigned table_count, bool bit)
{
    return side_bit(side, model, tsr_map_choice_cell(kind, index, table_count), bit);
}

static inline uint32_t side_direct(struct side *side, uint32_t value, unsigned bit_count)
{
    tsr_fixed_encode_direct(&side->range, value, bit_count);
    return value;
}

static inline size_t side_spent_bits(const struct side *side)
{
    return 8u * side->range.at;
}

#include "map_pixel.h"

void tsr_map_encode_row(struct tsr_map_model *model, struct tsr_range_encoder *range)
{
    struct side side = {*range};
    (void)code_span(model, &side, model->info.near, 0, model->info.width); /* an encoder's labels exist */
    *range = side.range;
    model->row++;
}
