/*
 * The decoder's direction of the label model.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"
#include "range_fixed.h"

struct side {
    struct tsr_range_decoder range;
};

static inline bool side_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    (void)bit;
    return tsr_fixed_decode(&side->range, &model->cells[cell]);
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
    (void)value;
    return tsr_range_decode_direct(&side->range, bit_count);
}

static inline size_t side_spent_bits(const struct side *side)
{
    return 8u * side->range.at;
}

#include "map_pixel.h"

bool tsr_map_decode_row(struct tsr_map_model *model, struct tsr_range_decoder *range)
{
    struct side side = {*range};
    const bool exists = code_span(model, &side, 0, 0, model->info.width);
    *range = side.range;
    model->row++;
    return exists;
}
