/*
 * Islands of a disparity map.
 *
 * A node stands for a pixel of the current row or the one above; which half of
 * the links a row has goes by its parity. A link is the node's parent, or, of a
 * root, minus the pixels of its component, counted up to min_size:
 *
 *   row y - 1   [ 0 .. W-1 ]     row y   [ W .. 2W-1 ]      (y odd)
 *
 * Where two components meet, a node of the current row becomes the root. So no
 * link leads from the current row to the one above, and a root left above says
 * that its component is complete.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/speckle.h"

#include <stdbool.h>

#include "map_buffers.h"

#define MIN_SIZE_DEFAULT 50
#define MIN_SIZE_MIN 2
#define DIFFERENCE_DEFAULT TSR_DISPARITY_ONE_Q4
#define NO_NODE INT16_MAX /* of an invalid pixel; above every index */

_Static_assert(2 * TSR_IMAGE_WIDTH_MAX < NO_NODE && 2 * TSR_SPECKLE_SIZE_MAX <= INT16_MAX, "links are 16 bit");

struct pixel {
    uint16_t x;
    uint16_t y;
    uint16_t value;
};

/* The links and the list of pixels in scratch, which is aligned to 2. */
static int16_t *links_of(const struct tsr_speckle *speckle)
{
    return (int16_t *)(void *)speckle->scratch;
}

static struct pixel *pixels_of(const struct tsr_speckle *speckle)
{
    return (struct pixel *)(void *)(links_of(speckle) + 2u * speckle->width);
}

static struct tsr_speckle_config resolve(const struct tsr_speckle_config *config)
{
    struct tsr_speckle_config resolved = *config;
    resolved.min_size = config->min_size != 0 ? config->min_size : MIN_SIZE_DEFAULT;
    resolved.max_difference_q4 = config->max_difference_q4 != 0 ? config->max_difference_q4 : DIFFERENCE_DEFAULT;
    return resolved;
}

enum tsr_status tsr_speckle_check(const struct tsr_speckle_config *config, const char **field)
{
    const char *bad = NULL;
    if (config == NULL) {
        bad = "config";
    } else if (resolve(config).min_size < MIN_SIZE_MIN || config->min_size > TSR_SPECKLE_SIZE_MAX) {
        bad = "min_size";
    }
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

size_t tsr_speckle_scratch_len(const struct tsr_speckle_config *config, uint16_t width)
{
    return tsr_speckle_check(config, NULL) == TSR_OK ? TSR_SPECKLE_SCRATCH_LEN(width, resolve(config).min_size) : 0;
}

enum tsr_status tsr_speckle_start(struct tsr_speckle *speckle, const struct tsr_speckle_config *config, uint16_t width,
                                  uint16_t height, uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap)
{
    if (speckle == NULL || tsr_speckle_check(config, NULL) != TSR_OK) {
        return TSR_ERR_ARG;
    }
    size_t scratch_len = tsr_speckle_scratch_len(config, width);
    const struct tsr_map_buffers buffers = {map, map_cap, scratch, scratch_cap, scratch_len, width, height};
    enum tsr_status status = tsr_map_check_buffers(&buffers);
    if (status == TSR_OK) {
        *speckle = (struct tsr_speckle){resolve(config), map, scratch, width, height, 0};
    }
    return status;
}

/* Both valid and near each other. */
static bool is_joined(const struct tsr_speckle *speckle, unsigned a, unsigned b)
{
    unsigned difference = a > b ? a - b : b - a;
    return a != TSR_DISPARITY_INVALID && b != TSR_DISPARITY_INVALID && difference <= speckle->config.max_difference_q4;
}

/* Halves the path on its way. */
static unsigned find_root(int16_t *links, unsigned node)
{
    while (links[node] >= 0) {
        int16_t parent = links[node];
        if (links[parent] >= 0) {
            links[node] = links[parent];
        }
        node = (unsigned)parent;
    }
    return node;
}

/* current is a node of the current row; so is the root of what comes out. */
static void join(const struct tsr_speckle *speckle, unsigned current, unsigned other)
{
    int16_t *links = links_of(speckle);
    unsigned root = find_root(links, current);
    unsigned child = find_root(links, other);
    if (root == child) {
        return;
    }
    int size = -links[root] - links[child];
    links[child] = (int16_t)root;
    links[root] = (int16_t)(size < speckle->config.min_size ? -size : -speckle->config.min_size);
}

static void label_row(const struct tsr_speckle *speckle, unsigned y)
{
    unsigned width = speckle->width;
    unsigned current = y % 2u * width;
    unsigned above = width - current;
    int16_t *links = links_of(speckle);
    const uint16_t *row = speckle->map + (size_t)y * width;
    for (unsigned x = 0; x < width; x++) {
        links[current + x] = row[x] != TSR_DISPARITY_INVALID ? -1 : NO_NODE;
        if (x > 0 && is_joined(speckle, row[x], row[x - 1u])) {
            join(speckle, current + x, current + x - 1u);
        }
        if (y > 0 && is_joined(speckle, row[x], *(row + x - width))) {
            join(speckle, current + x, above + x);
        }
    }
}

/* Invalidate a pixel that is joined to value, and list it. */
static unsigned take_pixel(const struct tsr_speckle *speckle, unsigned x, unsigned y, unsigned value, unsigned count)
{
    uint16_t *at = speckle->map + (size_t)y * speckle->width + x;
    if (!is_joined(speckle, *at, value)) {
        return count;
    }
    pixels_of(speckle)[count] = (struct pixel){(uint16_t)x, (uint16_t)y, *at};
    *at = TSR_DISPARITY_INVALID;
    return count + 1u;
}

/* The component has fewer than min_size pixels: as many as the list has room for. */
static void erase_component(const struct tsr_speckle *speckle, unsigned x, unsigned y)
{
    unsigned count = take_pixel(speckle, x, y, speckle->map[(size_t)y * speckle->width + x], 0);
    for (unsigned i = 0; i < count; i++) {
        const struct pixel at = pixels_of(speckle)[i];
        if (at.x > 0) {
            count = take_pixel(speckle, at.x - 1u, at.y, at.value, count);
        }
        if (at.x + 1u < speckle->width) {
            count = take_pixel(speckle, at.x + 1u, at.y, at.value, count);
        }
        if (at.y > 0) {
            count = take_pixel(speckle, at.x, at.y - 1u, at.value, count);
        }
        if (at.y + 1u < speckle->height) {
            count = take_pixel(speckle, at.x, at.y + 1u, at.value, count);
        }
    }
}

/* Erase the small components that end in row y. */
static void close_row(const struct tsr_speckle *speckle, unsigned y)
{
    const int16_t *links = links_of(speckle) + y % 2u * speckle->width;
    for (unsigned x = 0; x < speckle->width; x++) {
        if (links[x] < 0 && -links[x] < speckle->config.min_size) {
            erase_component(speckle, x, y);
        }
    }
}

enum tsr_status tsr_speckle_run(struct tsr_speckle *speckle, uint16_t rows)
{
    if (speckle == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    for (; rows > 0 && speckle->rows_done < speckle->height; rows--, speckle->rows_done++) {
        unsigned y = speckle->rows_done;
        label_row(speckle, y);
        if (y > 0) {
            close_row(speckle, y - 1u);
        }
        if (y + 1u == speckle->height) {
            close_row(speckle, y);
        }
    }
    return speckle->rows_done < speckle->height ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_speckle_rows_done(const struct tsr_speckle *speckle)
{
    return speckle->rows_done;
}
