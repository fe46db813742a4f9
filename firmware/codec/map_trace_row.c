/*
 * The questions about a row of a map alone.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_trace_side.h"

#define AGAINST_REFERENCE 0
#include "map_pixel.h"

void tsr_map_trace_row(struct tsr_map_model *model, struct side *side)
{
    (void)code_span(model, side, model->info.near, 0, model->info.width);
    model->row++;
}
