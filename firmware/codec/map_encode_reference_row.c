/*
 * Rows of a map against a reference, encoded.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"

#define CONTEXT_SHIFT TSR_MAP_SHIFT
#include "map_encode_side.h"
#define AGAINST_REFERENCE 1
#include "map_pixel.h"

void tsr_map_encode_reference_row(struct tsr_map_model *model, struct tsr_range_encoder *range)
{
    struct side side = {*range};
    (void)code_span(model, &side, model->info.near, 0, model->info.width); /* an encoder's labels exist */
    *range = side.range;
    model->row++;
}
