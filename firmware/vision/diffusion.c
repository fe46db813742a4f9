/*
 * Anisotropic diffusion. Scratch holds the row above as it was before the
 * iteration; row y takes its place pixel by pixel.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/diffusion.h"

#include "map_buffers.h"

#define ITERATIONS_DEFAULT 5
#define EDGE_DEFAULT 16
#define RATE_MAX 64 /* 1/4: with four neighbours the step stays stable, Perona and Malik, section III */

_Static_assert((TSR_DIFFUSION_ITERATIONS_MAX * TSR_IMAGE_HEIGHT_MAX) <= UINT16_MAX, "rows of work fit 16 bits");

static struct tsr_diffusion_config resolve(const struct tsr_diffusion_config *config)
{
    struct tsr_diffusion_config resolved = *config;
    resolved.iterations = config->iterations != 0 ? config->iterations : ITERATIONS_DEFAULT;
    resolved.edge_q4 = config->edge_q4 != 0 ? config->edge_q4 : EDGE_DEFAULT;
    resolved.rate_q8 = config->rate_q8 != 0 ? config->rate_q8 : RATE_MAX;
    return resolved;
}

enum tsr_status tsr_diffusion_check(const struct tsr_diffusion_config *config, const char **field)
{
    const char *bad = NULL;
    if (config == NULL) {
        bad = "config";
    } else if (config->iterations > TSR_DIFFUSION_ITERATIONS_MAX) {
        bad = "iterations";
    } else if (config->rate_q8 > RATE_MAX) {
        bad = "rate_q8";
    }
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

enum tsr_status tsr_diffusion_start(struct tsr_diffusion *diffusion, const struct tsr_diffusion_config *config,
                                    uint16_t width, uint16_t height, uint16_t *map, size_t map_cap, uint8_t *scratch,
                                    size_t scratch_cap)
{
    if (diffusion == NULL || tsr_diffusion_check(config, NULL) != TSR_OK) {
        return TSR_ERR_ARG;
    }
    const struct tsr_map_buffers buffers = {map,   map_cap, scratch, scratch_cap, TSR_DIFFUSION_SCRATCH_LEN(width),
                                            width, height};
    enum tsr_status status = tsr_map_check_buffers(&buffers);
    if (status == TSR_OK) {
        *diffusion = (struct tsr_diffusion){resolve(config), map, scratch, width, height, 0, 0};
    }
    return status;
}

/* Eq. (86) times the difference, Q8: what flows from a neighbour. Squares of
 * differences fit 32 bits with K^2 added; the product is at most 2^16. */
static int32_t flow(unsigned value, unsigned neighbour, uint32_t edge_squared)
{
    if (neighbour == TSR_DISPARITY_INVALID || neighbour == value) {
        return 0;
    }
    int32_t difference = (int32_t)neighbour - (int32_t)value;
    uint32_t magnitude = (uint32_t)(difference < 0 ? -difference : difference);
    uint32_t sum = edge_squared + magnitude * magnitude;
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): the sum is between 2 and 2^32 - 1 */
    return (int32_t)((256u * edge_squared + sum / 2u) / sum) * difference;
}

/* To nearest, ties away from zero; |flows| is below 2^18. */
static int32_t scale(int32_t flows, unsigned rate_q8)
{
    int32_t magnitude = ((flows < 0 ? -flows : flows) * (int32_t)rate_q8 + 0x8000) >> 16;
    return flows < 0 ? -magnitude : magnitude;
}

static void diffuse_row(const struct tsr_diffusion *diffusion, unsigned y)
{
    unsigned width = diffusion->width;
    uint32_t edge_squared = (uint32_t)diffusion->config.edge_q4 * diffusion->config.edge_q4;
    uint16_t *above = (uint16_t *)(void *)diffusion->scratch;
    uint16_t *row = diffusion->map + (size_t)y * width;
    const uint16_t *below = y + 1u < diffusion->height ? row + width : NULL;
    int32_t from_left = 0;
    for (unsigned x = 0; x < width; x++) {
        unsigned value = row[x];
        int32_t from_right = 0;
        if (value != TSR_DISPARITY_INVALID) {
            from_right = x + 1u < width ? flow(value, row[x + 1u], edge_squared) : 0;
            int32_t flows = from_left + from_right;
            flows += y > 0 ? flow(value, above[x], edge_squared) : 0;
            flows += below != NULL ? flow(value, below[x], edge_squared) : 0;
            row[x] = (uint16_t)((int32_t)value + scale(flows, diffusion->config.rate_q8));
        }
        above[x] = (uint16_t)value;
        from_left = -from_right; /* what a neighbour gives the other loses */
    }
}

enum tsr_status tsr_diffusion_run(struct tsr_diffusion *diffusion, uint16_t rows)
{
    if (diffusion == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    uint16_t total = tsr_diffusion_rows_total(&diffusion->config, diffusion->height);
    for (; rows > 0 && diffusion->rows_done < total; rows--, diffusion->rows_done++) {
        diffuse_row(diffusion, diffusion->row);
        diffusion->row = diffusion->row + 1u < diffusion->height ? (uint16_t)(diffusion->row + 1u) : 0;
    }
    return diffusion->rows_done < total ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_diffusion_rows_done(const struct tsr_diffusion *diffusion)
{
    return diffusion->rows_done;
}

uint16_t tsr_diffusion_rows_total(const struct tsr_diffusion_config *config, uint16_t height)
{
    return (uint16_t)(resolve(config).iterations * height);
}
