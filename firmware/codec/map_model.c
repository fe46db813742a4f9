/*
 * The state that the directions of the map codec share: checks, the way from
 * disparities to labels, and where the contexts start.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_model.h"

#include <string.h>

/* P(1) of a level, UQ0.16: 1 / (1 + exp((32 - level) / 4)), within 64 .. 65472, where adaptation
 * would stop. */
static const uint16_t level_starts[TSR_MAP_LEVEL_COUNT] = {
    64,    64,    64,    64,    64,    77,    98,    126,   162,   208,   267,   342,   439,   562,   720,   922,
    1179,  1506,  1921,  2446,  3108,  3938,  4971,  6249,  7812,  9702,  11955, 14595, 17625, 21025, 24743, 28693,
    32768, 36843, 40793, 44511, 47911, 50941, 53581, 55834, 57724, 59287, 60565, 61598, 62428, 63090, 63615, 64030,
    64357, 64614, 64816, 64974, 65097, 65194, 65269, 65328, 65374, 65410, 65438, 65459, 65472, 65472, 65472, 65472};

bool tsr_map_is_valid_info(const struct tsr_map_info *info)
{
    return info->width >= 1 && info->width <= TSR_IMAGE_WIDTH_MAX && info->height >= 1 &&
           info->height <= TSR_IMAGE_HEIGHT_MAX && info->disparities >= 1 &&
           info->disparities <= TSR_DISPARITY_COUNT_MAX && info->step_log2 <= TSR_MAP_STEP_LOG2_MAX &&
           info->near <= TSR_MAP_NEAR_MAX;
}

enum tsr_status tsr_map_model_start(struct tsr_map_model *model, const struct tsr_map_info *info,
                                    const struct tsr_map_reference *reference, const uint16_t *cells, uint16_t *scratch,
                                    size_t scratch_cap)
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
    model->run = 0;
    for (size_t i = 0; i < scratch_count; i++) {
        scratch[i] = model->invalid;
    }
    model->coding = reference != NULL ? TSR_MAP_CODING_REFERENCE
                    : info->near > 0  ? TSR_MAP_CODING_NEAR
                                      : TSR_MAP_CODING_ALONE;
    memcpy(model->cells, cells, TSR_MAP_TRAINED_CELL_COUNT * sizeof model->cells[0]);
    for (size_t kind = 0; kind < TSR_MAP_KIND_COUNT; kind++) {
        memcpy(model->cells + TSR_MAP_CANDIDATE_AT + kind * TSR_MAP_LEVEL_COUNT, level_starts, sizeof level_starts);
    }
    return TSR_OK;
}

bool tsr_map_is_valid_value(const struct tsr_map_info *info, unsigned value)
{
    const unsigned below_step = (1u << info->step_log2) - 1u;
    return value == TSR_DISPARITY_INVALID ||
           (value < info->disparities * TSR_DISPARITY_ONE_Q4 && (value & below_step) == 0);
}

/* Two values at once, in whatever order they lie in a word. One that is too large keeps its upper bit in
 * (value | 0x8000) - end. */
bool tsr_map_take_row(struct tsr_map_model *model, const uint16_t *row)
{
    const struct tsr_map_info *info = &model->info;
    const unsigned width = info->width, step_log2 = info->step_log2;
    const uint32_t end_twice = info->disparities * TSR_DISPARITY_ONE_Q4 * 0x10001u;
    const uint32_t below_step_twice = ((1u << step_log2) - 1u) * 0x10001u;
    const uint32_t labels_twice = model->invalid * 0x10001u;
    uint16_t *labels = tsr_map_row_labels(model, 0);
    unsigned x = 0;
    for (; x + 2u <= width; x += 2) {
        uint32_t pair;
        memcpy(&pair, row + x, sizeof pair);
        const uint32_t too_large = (((pair | 0x80008000u) - end_twice) | pair) & 0x80008000u;
        if (((pair & below_step_twice) | too_large) != 0 && pair != UINT32_MAX &&
            !(tsr_map_is_valid_value(info, row[x]) && tsr_map_is_valid_value(info, row[x + 1u]))) {
            return false;
        }
        pair = pair >> step_log2 & labels_twice;
        memcpy(labels + x, &pair, sizeof pair);
    }
    if (x < width) {
        labels[x] = TSR_MAP_LABEL(row[x], step_log2);
    }
    return x == width || tsr_map_is_valid_value(info, row[x]);
}
