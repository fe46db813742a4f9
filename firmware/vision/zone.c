/*
 * One part of a disparity map, measured.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/zone.h"

#include <string.h>

/* A surface begins with its median: the whole pixels of it, then the sixteenths. */
enum pass {
    PASS_WHOLE,
    PASS_FRACTION,
    PASS_SUM,
    PASS_DONE
};

#define SURFACE_BAND_Q4 TSR_DISPARITY_ONE_Q4
#define WHOLE_LOG2 4u

static void start_pass(struct tsr_zone *zone, enum pass pass, uint16_t low_q4, uint16_t high_q4)
{
    zone->pass = (uint8_t)pass;
    zone->row = 0;
    zone->low_q4 = low_q4;
    zone->high_q4 = high_q4;
    memset(zone->histogram, 0, sizeof zone->histogram);
}

/* Between two invalid ones lies no disparity. */
static void sum_nothing(struct tsr_zone *zone)
{
    start_pass(zone, PASS_SUM, TSR_DISPARITY_INVALID, TSR_DISPARITY_INVALID);
}

enum tsr_status tsr_zone_start(struct tsr_zone *zone, const struct tsr_zone_config *config, const uint16_t *map,
                               uint16_t width, uint16_t height)
{
    if (zone == NULL || config == NULL || map == NULL || config->kind < TSR_ZONE_NEARER ||
        config->kind > TSR_ZONE_SURFACE || !tsr_rectangle_is_inside(&config->part, width, height)) {
        return TSR_ERR_ARG;
    }
    memset(zone, 0, sizeof *zone);
    zone->config = *config;
    zone->map = map;
    zone->stride = width;
    if (config->kind == TSR_ZONE_SURFACE) {
        start_pass(zone, PASS_WHOLE, 0, TSR_DISPARITY_INVALID - 1u);
    } else if (config->kind == TSR_ZONE_NEARER && config->limit_q4 < TSR_DISPARITY_INVALID) {
        start_pass(zone, PASS_SUM, config->limit_q4, TSR_DISPARITY_INVALID - 1u);
    } else if (config->kind == TSR_ZONE_FARTHER && config->limit_q4 > 0) {
        start_pass(zone, PASS_SUM, 0, (uint16_t)(config->limit_q4 - 1u));
    } else {
        sum_nothing(zone);
    }
    return TSR_OK;
}

static void sum_row(struct tsr_zone *zone, const uint16_t *row)
{
    uint32_t low_q4 = zone->low_q4;
    uint32_t span_q4 = (uint32_t)zone->high_q4 - low_q4;
    uint32_t valid = 0;
    uint32_t counted = 0;
    uint32_t sum_q4 = 0;
    for (unsigned x = 0; x < zone->config.part.width; x++) {
        uint32_t d = row[x];
        if (d != TSR_DISPARITY_INVALID) {
            valid++;
            if (d - low_q4 <= span_q4) { /* below low wraps to far above */
                counted++;
                sum_q4 += d;
            }
        }
    }
    zone->valid += valid;
    zone->counted += counted;
    zone->sum_q4 += sum_q4;
}

/* Invalid ones are beyond the last entry, too. */
static void sort_row(struct tsr_zone *zone, const uint16_t *row, unsigned entry_log2, uint32_t entries)
{
    uint32_t low_q4 = zone->low_q4;
    for (unsigned x = 0; x < zone->config.part.width; x++) {
        uint32_t entry = (row[x] - low_q4) >> entry_log2;
        if (entry < entries) {
            zone->histogram[entry]++;
        }
    }
}

/* The entry of the pixel with the rank, which becomes its rank inside the entry. */
static uint16_t entry_of_rank(struct tsr_zone *zone)
{
    uint16_t entry = 0;
    while (zone->rank >= zone->histogram[entry]) {
        zone->rank -= zone->histogram[entry];
        entry++;
    }
    return entry;
}

static void finish_whole(struct tsr_zone *zone)
{
    uint32_t count = 0;
    for (unsigned i = 0; i < TSR_DISPARITY_COUNT_MAX; i++) {
        count += zone->histogram[i];
    }
    if (count == 0) {
        sum_nothing(zone);
        return;
    }
    zone->rank = (count - 1u) / 2u;
    uint16_t low_q4 = (uint16_t)(entry_of_rank(zone) << WHOLE_LOG2);
    start_pass(zone, PASS_FRACTION, low_q4, (uint16_t)(low_q4 + TSR_DISPARITY_ONE_Q4 - 1u));
}

static void finish_fraction(struct tsr_zone *zone)
{
    uint16_t median_q4 = (uint16_t)(zone->low_q4 + entry_of_rank(zone));
    start_pass(zone, PASS_SUM, median_q4 > SURFACE_BAND_Q4 ? (uint16_t)(median_q4 - SURFACE_BAND_Q4) : 0,
               (uint16_t)(median_q4 + SURFACE_BAND_Q4));
}

/* TSR_OK when that was the last one. */
static enum tsr_status run_row(struct tsr_zone *zone)
{
    const struct tsr_rectangle *part = &zone->config.part;
    const uint16_t *row = zone->map + ((size_t)part->y + zone->row) * zone->stride + part->x;
    bool last = ++zone->row == part->height;
    zone->rows_done++;
    switch (zone->pass) {
    case PASS_WHOLE:
        sort_row(zone, row, WHOLE_LOG2, TSR_DISPARITY_COUNT_MAX);
        if (last) {
            finish_whole(zone);
        }
        return TSR_AGAIN;
    case PASS_FRACTION:
        sort_row(zone, row, 0, TSR_DISPARITY_ONE_Q4);
        if (last) {
            finish_fraction(zone);
        }
        return TSR_AGAIN;
    default: sum_row(zone, row);
    }
    if (last) {
        zone->pass = PASS_DONE;
    }
    return last ? TSR_OK : TSR_AGAIN;
}

enum tsr_status tsr_zone_run(struct tsr_zone *zone, uint16_t rows)
{
    if (zone == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    enum tsr_status status = zone->pass == PASS_DONE ? TSR_OK : TSR_AGAIN;
    for (; rows > 0 && status == TSR_AGAIN; rows--) {
        status = run_row(zone);
    }
    return status;
}

uint16_t tsr_zone_rows_done(const struct tsr_zone *zone)
{
    return zone->rows_done;
}

struct tsr_zone_result tsr_zone_get_result(const struct tsr_zone *zone)
{
    struct tsr_zone_result result = {zone->valid, zone->counted, TSR_ZONE_NO_DISPARITY};
    uint32_t count = zone->counted;
    if (count > 0) {
        uint32_t whole_q4 = zone->sum_q4 / count;
        uint32_t rest = zone->sum_q4 % count;
        result.disparity_q8 = (uint16_t)(16u * whole_q4 + (16u * rest + count / 2u) / count);
    }
    return result;
}
