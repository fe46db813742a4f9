/*
 * All questions about the pixels of a packet.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_strip.h"
#include "map_trace_side.h"

enum tsr_status tsr_map_trace_packet(struct tsr_map_model *model, const struct tsr_map_info *info, const uint16_t *map,
                                     uint32_t first, uint32_t count, uint16_t *scratch, size_t scratch_cap,
                                     tsr_map_question_fn tell, void *user)
{
    if (model == NULL || info == NULL || map == NULL || scratch == NULL || tell == NULL ||
        !tsr_map_is_valid_info(info)) {
        return TSR_ERR_ARG;
    }
    const uint32_t pixels = (uint32_t)info->width * info->height;
    if (first >= pixels || count > pixels - first) {
        return TSR_ERR_SIZE;
    }
    const enum tsr_status status = tsr_map_strip_start(model, info, first, scratch, scratch_cap);
    if (status != TSR_OK) {
        return status;
    }
    struct side side = {tell, user};
    for (uint32_t done = 0; done < count;) {
        const struct tsr_map_span span = tsr_map_strip_next(model, info, first, done, count - done);
        uint16_t *labels = tsr_map_row_labels(model, 0);
        for (unsigned x = span.place.x; x < span.end; x++) {
            const uint16_t value = map[tsr_map_strip_index(&span, info->width, x)];
            if (!tsr_map_is_valid_value(info, value)) {
                return TSR_ERR_ARG;
            }
            labels[x] = TSR_MAP_LABEL(value, info->step_log2);
        }
        tsr_map_trace_span(model, &side, span.place.x, span.end);
        tsr_map_strip_close(model, &span, done);
        done += span.end - span.place.x;
    }
    return TSR_OK;
}
