/*
 * The decoder's side of the questions, for map_pixel.h. The file that includes this has defined CONTEXT_SHIFT.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_DECODE_SIDE_H
#define TSR_CODEC_MAP_DECODE_SIDE_H

#include "map_model.h"
#include "range_inline.h"

struct side {
    struct tsr_range_decoder range;
};

static inline bool side_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    (void)bit;
    return tsr_fixed_decode(&side->range, &model->cells[cell], CONTEXT_SHIFT);
}

static TSR_OUT_OF_LINE bool side_rare_bit(struct side *side, struct tsr_map_model *model, unsigned cell, bool bit)
{
    return side_bit(side, model, cell, bit);
}

static inline bool side_choice(struct side *side, struct tsr_map_model *model, unsigned kind, const uint8_t *index,
                               unsigned cell, bool bit)
{
    (void)kind;
    (void)index;
    return side_bit(side, model, cell, bit);
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

#endif
