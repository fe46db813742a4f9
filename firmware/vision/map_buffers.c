/*
 * The check that opens every filter of a map.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "map_buffers.h"

#include <stdbool.h>

#include "tsr/base/image.h"

static bool is_misaligned(const void *pointer)
{
    return (uintptr_t)pointer % sizeof(uint16_t) != 0;
}

enum tsr_status tsr_map_check_buffers(const struct tsr_map_buffers *buffers)
{
    if (buffers->map == NULL || is_misaligned(buffers->map) || buffers->width == 0 ||
        buffers->width > TSR_IMAGE_WIDTH_MAX || buffers->height == 0 || buffers->height > TSR_IMAGE_HEIGHT_MAX) {
        return TSR_ERR_ARG;
    }
    if (buffers->scratch_len > 0 && (buffers->scratch == NULL || is_misaligned(buffers->scratch))) {
        return TSR_ERR_ARG;
    }
    if (buffers->map_cap < (size_t)buffers->width * buffers->height || buffers->scratch_cap < buffers->scratch_len) {
        return TSR_ERR_NOBUF;
    }
    return TSR_OK;
}
