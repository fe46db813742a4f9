/*
 * Holding to a reference: one pass from the top, a row of bits a column.
 *
 * Row y is compared, the windows centred on row y - 3 are then complete, and so
 * is what lies around row y - 6, which is written.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/map_hold.h"

#include <stdbool.h>

#define RADIUS TSR_MAP_HOLD_RADIUS
#define SIDE (2u * RADIUS + 1u)
#define SIDE_MASK ((1u << SIDE) - 1u)
/* A column's bits: the last 7 rows' differences, the newest lowest, and above them the last 7 rows of windows that
 * changed. */
#define WINDOWS_AT 8u
_Static_assert(WINDOWS_AT + SIDE <= 16u, "a column's bits fit its element");

static unsigned bit_count(unsigned bits)
{
    static const uint8_t of_nibble[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    return of_nibble[bits & 15u] + of_nibble[bits >> 4 & 15u];
}

static unsigned differences(uint16_t column)
{
    return bit_count(column & SIDE_MASK);
}

/* Shift in a row's differences; without rows (below the map) there are none. */
static void take_row(uint16_t *columns, unsigned width, const uint16_t *row, const uint16_t *reference)
{
    for (unsigned x = 0; x < width; x++) {
        const unsigned differs = row != NULL && row[x] != reference[x];
        const unsigned windows = columns[x] & SIDE_MASK << WINDOWS_AT;
        columns[x] = (uint16_t)(windows | (((unsigned)columns[x] << 1 | differs) & SIDE_MASK));
    }
}

/* Shift in which windows, centred three rows up, changed. */
static void vote(uint16_t *columns, unsigned width)
{
    unsigned sum = 0;
    for (unsigned x = 0; x < RADIUS && x < width; x++) {
        sum += differences(columns[x]);
    }
    for (unsigned x = 0; x < width; x++) {
        sum += x + RADIUS < width ? differences(columns[x + RADIUS]) : 0;
        const unsigned windows = ((unsigned)columns[x] >> WINDOWS_AT << 1 | (sum >= TSR_MAP_HOLD_COUNT)) & SIDE_MASK;
        columns[x] = (uint16_t)(windows << WINDOWS_AT | (columns[x] & SIDE_MASK));
        sum -= x >= RADIUS ? differences(columns[x - RADIUS]) : 0;
    }
}

/* Write the row six rows up: the reference where no window around a pixel changed. Returns what differs still. */
static uint32_t hold_row(const uint16_t *columns, unsigned width, uint16_t *row, const uint16_t *reference)
{
    uint32_t changed = 0;
    unsigned near = 0; /* columns still to come within the reach of the last window that changed */
    for (unsigned x = 0; x < RADIUS && x < width; x++) {
        near = columns[x] >> WINDOWS_AT != 0 ? x + RADIUS + 1u : near;
    }
    for (unsigned x = 0; x < width; x++) {
        near = x + RADIUS < width && columns[x + RADIUS] >> WINDOWS_AT != 0 ? x + SIDE : near;
        if (x >= near) {
            row[x] = reference[x];
        }
        changed += row[x] != reference[x];
    }
    return changed;
}

enum tsr_status tsr_map_hold(const struct tsr_map_info *info, const struct tsr_map_reference *reference, uint16_t *map,
                             size_t stride, uint16_t *scratch, size_t scratch_cap, uint32_t *changed)
{
    if (info == NULL || reference == NULL || reference->map == NULL || map == NULL || scratch == NULL ||
        info->width < 1 || info->width > TSR_IMAGE_WIDTH_MAX || info->height < 1 ||
        info->height > TSR_IMAGE_HEIGHT_MAX) {
        return TSR_ERR_ARG;
    }
    const unsigned width = info->width, height = info->height;
    if (stride < width || reference->stride < width) {
        return TSR_ERR_SIZE;
    }
    if (scratch_cap < TSR_MAP_HOLD_SCRATCH_COUNT(width)) {
        return TSR_ERR_NOBUF;
    }
    for (unsigned x = 0; x < width; x++) {
        scratch[x] = 0;
    }
    uint32_t left = 0;
    for (unsigned y = 0; y < height + 2u * RADIUS; y++) {
        const bool below = y >= height;
        take_row(scratch, width, below ? NULL : map + y * stride,
                 below ? NULL : reference->map + y * reference->stride);
        vote(scratch, width);
        if (y >= 2u * RADIUS) {
            const unsigned done = y - 2u * RADIUS;
            left += hold_row(scratch, width, map + done * stride, reference->map + done * reference->stride);
        }
    }
    if (changed != NULL) {
        *changed = left;
    }
    return TSR_OK;
}
