/*
 * Binomial smoothing: the kernel down each column first, then along the row.
 *
 * Scratch holds the radius rows above as they were, row y at y % radius. Row y
 * takes the place of row y - radius behind the kernel, where that one is not
 * read any more.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/gaussian.h"

#include "map_buffers.h"

#define RADIUS_MAX (TSR_GAUSSIAN_WINDOW_MAX / 2u)

static const uint8_t kBinomial[RADIUS_MAX + 1u][TSR_GAUSSIAN_WINDOW_MAX] = {{1}, {1, 2, 1}, {1, 4, 6, 4, 1}};

/* At most 65534 * 256 and 256. */
struct sums {
    uint32_t value;
    uint32_t weight;
};

/* The rows y - radius .. y + radius before the filter; NULL outside the map. */
struct rows {
    const uint16_t *row[TSR_GAUSSIAN_WINDOW_MAX];
};

enum tsr_status tsr_gaussian_start(struct tsr_gaussian *gaussian, uint8_t window, uint16_t width, uint16_t height,
                                   uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap)
{
    if (gaussian == NULL || (window != 3 && window != TSR_GAUSSIAN_WINDOW_MAX)) {
        return TSR_ERR_ARG;
    }
    const struct tsr_map_buffers buffers = {
        map, map_cap, scratch, scratch_cap, TSR_GAUSSIAN_SCRATCH_LEN(width, window), width, height};
    enum tsr_status status = tsr_map_check_buffers(&buffers);
    if (status == TSR_OK) {
        *gaussian = (struct tsr_gaussian){map, scratch, width, height, 0, window / 2u};
    }
    return status;
}

static struct rows rows_around(const struct tsr_gaussian *gaussian, unsigned y)
{
    unsigned radius = gaussian->radius;
    size_t width = gaussian->width;
    const uint16_t *above = (const uint16_t *)(const void *)gaussian->scratch;
    struct rows rows = {{NULL}};
    for (unsigned j = 0; j <= 2u * radius; j++) {
        unsigned below = y + j; /* row below - radius */
        if (j < radius && below >= radius) {
            rows.row[j] = above + below % radius * width;
        } else if (j >= radius && below - radius < gaussian->height) {
            rows.row[j] = gaussian->map + (below - radius) * width;
        }
    }
    return rows;
}

static struct sums sum_column(const struct rows *rows, unsigned x, unsigned radius)
{
    struct sums sums = {0, 0};
    for (unsigned j = 0; j <= 2u * radius; j++) {
        if (rows->row[j] != NULL && rows->row[j][x] != TSR_DISPARITY_INVALID) {
            sums.value += (uint32_t)kBinomial[radius][j] * rows->row[j][x];
            sums.weight += kBinomial[radius][j];
        }
    }
    return sums;
}

static uint16_t smooth_pixel(const struct sums *columns, unsigned radius)
{
    uint32_t value = 0;
    uint32_t weight = 0;
    for (unsigned i = 0; i <= 2u * radius; i++) {
        value += kBinomial[radius][i] * columns[i].value;
        weight += kBinomial[radius][i] * columns[i].weight;
    }
    return (uint16_t)((2u * value + weight) / (2u * weight));
}

static void smooth_row(const struct tsr_gaussian *gaussian, unsigned y)
{
    unsigned radius = gaussian->radius;
    unsigned width = gaussian->width;
    uint16_t *saved = (uint16_t *)(void *)gaussian->scratch + (size_t)(y % radius) * width;
    uint16_t *row = gaussian->map + (size_t)y * width;
    const struct rows rows = rows_around(gaussian, y);
    struct sums columns[TSR_GAUSSIAN_WINDOW_MAX] = {{0, 0}}; /* x - radius .. x + radius */
    for (unsigned entering = 0; entering < width + radius; entering++) {
        for (unsigned i = 0; i < 2u * radius; i++) {
            columns[i] = columns[i + 1u];
        }
        columns[2u * radius] = entering < width ? sum_column(&rows, entering, radius) : (struct sums){0, 0};
        if (entering >= radius) {
            unsigned x = entering - radius;
            saved[x] = row[x];
            if (row[x] != TSR_DISPARITY_INVALID) {
                row[x] = smooth_pixel(columns, radius);
            }
        }
    }
}

enum tsr_status tsr_gaussian_run(struct tsr_gaussian *gaussian, uint16_t rows)
{
    if (gaussian == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    for (; rows > 0 && gaussian->rows_done < gaussian->height; rows--, gaussian->rows_done++) {
        smooth_row(gaussian, gaussian->rows_done);
    }
    return gaussian->rows_done < gaussian->height ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_gaussian_rows_done(const struct tsr_gaussian *gaussian)
{
    return gaussian->rows_done;
}
