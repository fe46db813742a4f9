/*
 * Quantisation of a disparity map.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/quantise.h"

#define STEP_LOG2_MAX 4

enum tsr_status tsr_quantise(uint16_t *map, size_t count, uint8_t step_log2, uint16_t disparities)
{
    if (map == NULL || step_log2 > STEP_LOG2_MAX || disparities == 0 || disparities > TSR_DISPARITY_COUNT_MAX) {
        return TSR_ERR_ARG;
    }
    const uint32_t half = (1u << step_log2) / 2u;
    const uint32_t max = TSR_DISPARITY_ONE_Q4 * (disparities - 1u);
    for (size_t i = 0; i < count; i++) {
        if (map[i] != TSR_DISPARITY_INVALID) {
            const uint32_t rounded = (map[i] + half) >> step_log2 << step_log2;
            map[i] = (uint16_t)(rounded < max ? rounded : max);
        }
    }
    return TSR_OK;
}
