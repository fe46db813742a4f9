/*
 * Rows of a map alone, encoded.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_encode_side.h"

#define AGAINST_REFERENCE 0
#include "map_pixel.h"

void tsr_map_encode_span(struct tsr_map_model *model, struct tsr_range_encoder *range, unsigned first, unsigned end)
{
    struct side side = {*range};
    (void)code_span(model, &side, model->info.near, first, end); /* an encoder's labels exist */
    *range = side.range;
}

void tsr_map_encode_row(struct tsr_map_model *model, struct tsr_range_encoder *range)
{
    tsr_map_encode_span(model, range, 0, model->info.width);
    model->row++;
}
