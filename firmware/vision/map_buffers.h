/*
 * The check that opens every filter of a map.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MAP_BUFFERS_H
#define TSR_VISION_MAP_BUFFERS_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"

/* What a caller hands to a filter. scratch may be NULL if scratch_len is 0. */
struct tsr_map_buffers {
    const uint16_t *map;
    size_t map_cap; /* elements */
    const uint8_t *scratch;
    size_t scratch_cap; /* bytes */
    size_t scratch_len; /* bytes needed */
    uint16_t width;
    uint16_t height;
};

/* TSR_OK; TSR_ERR_ARG for a null pointer, one that is not aligned to 2, or a
 * shape out of range; TSR_ERR_NOBUF if a buffer is too small. */
enum tsr_status tsr_map_check_buffers(const struct tsr_map_buffers *buffers);

#endif
