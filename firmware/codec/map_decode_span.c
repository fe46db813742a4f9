/*
 * Pieces of rows of a packet, decoded.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"

#define CONTEXT_SHIFT TSR_MAP_PACKET_SHIFT
#include "map_decode_side.h"
#define AGAINST_REFERENCE 0
#include "map_pixel.h"

bool tsr_map_decode_span(struct tsr_map_model *model, struct tsr_range_decoder *range, unsigned first, unsigned end)
{
    struct side side = {*range};
    const bool exists = code_span(model, &side, 0, first, end);
    *range = side.range;
    return exists;
}
