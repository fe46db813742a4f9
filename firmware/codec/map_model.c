/*
 * The state that the directions of the map codec share: checks, the way from
 * disparities to labels, and where the contexts start.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"

#include <string.h>

bool tsr_map_is_valid_info(const struct tsr_map_info *info)
{
    return info->width >= 1 && info->width <= TSR_IMAGE_WIDTH_MAX && info->height >= 1 &&
           info->height <= TSR_IMAGE_HEIGHT_MAX && info->disparities >= 1 &&
           info->disparities <= TSR_DISPARITY_COUNT_MAX && info->step_log2 <= TSR_MAP_STEP_LOG2_MAX &&
           info->near <= TSR_MAP_NEAR_MAX;
}

enum tsr_status tsr_map_model_start(struct tsr_map_model *model, const struct tsr_map_info *info,
                                    const struct tsr_map_reference *reference, uint16_t *scratch, size_t scratch_cap)
{
    if (scratch == NULL || !tsr_map_is_valid_info(info) || (reference != NULL && reference->map == NULL)) {
        return TSR_ERR_ARG;
    }
    if (reference != NULL && reference->stride < info->width) {
        return TSR_ERR_SIZE;
    }
    const size_t scratch_count = TSR_MAP_SCRATCH_COUNT(info->width);
    if (scratch_cap < scratch_count) {
        return TSR_ERR_NOBUF;
    }
    model->info = *info;
    model->reference = reference != NULL ? *reference : (struct tsr_map_reference){0};
    model->scratch = scratch;
    model->row = 0;
    model->invalid = TSR_MAP_LABEL(TSR_DISPARITY_INVALID, info->step_log2);
    model->label_count = (uint16_t)((info->disparities * TSR_DISPARITY_ONE_Q4) >> info->step_log2);
    model->last_label = model->label_count / 4u;
    model->label_bits = (uint8_t)TSR_MAP_LABEL_BITS(info->disparities, info->step_log2);
    model->allowed_bits = 8u * TSR_MAP_SLACK_LEN;
    for (size_t i = 0; i < scratch_count; i++) {
        scratch[i] = model->invalid;
    }
    model->coding = reference != NULL ? TSR_MAP_CODING_REFERENCE
                    : info->near > 0  ? TSR_MAP_CODING_NEAR
                                      : TSR_MAP_CODING_ALONE;
    memcpy(model->cells, tsr_map_prior.cells[model->coding], sizeof model->cells);
    return TSR_OK;
}

bool tsr_map_is_valid_row(const struct tsr_map_info *info, const uint16_t *row)
{
    const unsigned end = info->disparities * TSR_DISPARITY_ONE_Q4;
    const unsigned below_step = (1u << info->step_log2) - 1u;
    for (unsigned x = 0; x < info->width; x++) {
        if (row[x] != TSR_DISPARITY_INVALID && (row[x] >= end || (row[x] & below_step) != 0)) {
            return false;
        }
    }
    return true;
}

void tsr_map_take_row(struct tsr_map_model *model, const uint16_t *row)
{
    uint16_t *labels = tsr_map_row_labels(model, 0);
    for (unsigned x = 0; x < model->info.width; x++) {
        labels[x] = TSR_MAP_LABEL(row[x], model->info.step_log2);
    }
}
