/*
 * Rows of a map against a reference, decoded.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"

#define CONTEXT_SHIFT TSR_MAP_SHIFT
#include "map_decode_side.h"
#define AGAINST_REFERENCE 1
#include "map_pixel.h"

bool tsr_map_decode_reference_row(struct tsr_map_model *model, struct tsr_range_decoder *range)
{
    struct side side = {*range};
    const bool exists = code_span(model, &side, 0, 0, model->info.width);
    *range = side.range;
    model->row++;
    return exists;
}
