/*
 * All questions about a map, and what a trainer needs to place them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map_trace.h"

#include "map_trace_side.h"

uint16_t tsr_map_prior_matcher_crc(void)
{
    return tsr_map_prior.matcher_crc;
}

enum tsr_status tsr_map_trace(struct tsr_map_model *model, const struct tsr_map_info *info,
                              const struct tsr_map_reference *reference, const uint16_t *map, uint16_t *scratch,
                              size_t scratch_cap, tsr_map_question_fn tell, void *user)
{
    if (model == NULL || info == NULL || map == NULL || tell == NULL) {
        return TSR_ERR_ARG;
    }
    const enum tsr_status status =
        tsr_map_model_start(model, info, reference, tsr_map_prior.cells[0], scratch, scratch_cap);
    if (status != TSR_OK) {
        return status;
    }
    struct side side = {tell, user};
    while (model->row < info->height) {
        const uint16_t *row = map + (size_t)model->row * info->width;
        if (!tsr_map_take_row(model, row)) {
            return TSR_ERR_ARG;
        }
        if (reference != NULL) {
            tsr_map_trace_reference_row(model, &side);
        } else {
            tsr_map_trace_row(model, &side);
        }
    }
    return TSR_OK;
}
