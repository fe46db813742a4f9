/*
 * The questions about a row of a map alone, or a piece of one in a packet.
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

void tsr_map_trace_span(struct tsr_map_model *model, struct side *side, unsigned first, unsigned end)
{
    (void)code_span(model, side, model->info.near, first, end);
}
