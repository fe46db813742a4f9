/*
 * The census modes of the matcher: their scratch and the order of their rows.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "match_census.h"

static bool has_paths(const struct tsr_match_config *config)
{
    return config->mode == TSR_MATCH_SMOOTH;
}

unsigned tsr_match_census_radius(const struct tsr_match_config *config)
{
    return has_paths(config) ? 1u : config->window / 2u;
}

static unsigned rows_total(const struct tsr_match_config *config)
{
    return config->height + tsr_match_census_radius(config);
}

static unsigned plane_rows(const struct tsr_match_config *config)
{
    return has_paths(config) ? 1u : config->window + 1u;
}

static size_t plane_row_len(const struct tsr_match_config *config)
{
    return TSR_MATCH_CENSUS_PLANES * (2u * (size_t)config->width + config->disparities);
}

size_t tsr_match_census_columns_len(const struct tsr_match_config *config)
{
    size_t row_len = (size_t)config->width * config->disparities;
    return has_paths(config) ? (TSR_MATCH_SMOOTH_ROWS + 2u) * row_len + 2u * (size_t)config->disparities : row_len;
}

size_t tsr_match_census_planes_len(const struct tsr_match_config *config)
{
    return plane_row_len(config) * plane_rows(config) + (has_paths(config) ? 2u * (size_t)config->width : 0u);
}

static uint8_t *behind_common(const struct tsr_match *match)
{
    return tsr_match_share_scratch(match).texture + match->config.width;
}

struct tsr_match_planes tsr_match_planes_at(const struct tsr_match *match, unsigned y)
{
    size_t width = match->config.width;
    size_t right_len = width + match->config.disparities;
    uint8_t *row = behind_common(match) + plane_row_len(&match->config) * (y % plane_rows(&match->config));
    struct tsr_match_planes planes = {{row, row + width}, {row + 2u * width, row + 2u * width + right_len}};
    return planes;
}

struct tsr_match_paths tsr_match_share_paths(const struct tsr_match *match)
{
    size_t width = match->config.width;
    size_t disparities = match->config.disparities;
    size_t row_len = width * disparities;
    struct tsr_match_paths paths;
    paths.above[0] = tsr_match_share_scratch(match).columns + TSR_MATCH_SMOOTH_ROWS * row_len;
    paths.above[1] = paths.above[0] + row_len;
    paths.before = paths.above[1] + row_len;
    paths.cost = paths.before + disparities;
    paths.least[0] = behind_common(match) + plane_row_len(&match->config) * plane_rows(&match->config);
    paths.least[1] = paths.least[0] + width;
    return paths;
}

uint8_t *tsr_match_costs_at(const struct tsr_match *match, unsigned y)
{
    size_t row_len = (size_t)match->config.width * match->config.disparities;
    return tsr_match_share_scratch(match).columns + row_len * (y % TSR_MATCH_SMOOTH_ROWS);
}

/* Path costs of the row above the image: none. */
static void begin_paths(const struct tsr_match *match)
{
    struct tsr_match_paths paths = tsr_match_share_paths(match);
    size_t width = match->config.width;
    memset(paths.above[0], 0, 2u * width * match->config.disparities);
    memset(paths.least[0], 0, 2u * width);
}

static void step_smooth(const struct tsr_match *match, unsigned step)
{
    const struct tsr_match_census_kernel *kernel = tsr_match_census_kernel_of(match);
    if (step == 0) {
        begin_paths(match);
    }
    if (step < match->config.height) {
        kernel->describe_row(match, step);
        kernel->cost_row(match, step);
    }
    if (step > 0) {
        kernel->smooth_row(match, step - 1u);
    }
}

/* The columns one row above the image hold row 0 r + 2 times and rows 1 .. r - 1
 * once, so that moving them down to map row 0 is a step like every other. */
static void warm_up(const struct tsr_match *match, unsigned row, unsigned radius)
{
    const struct tsr_match_census_kernel *kernel = tsr_match_census_kernel_of(match);
    if (row == 0) {
        memset(tsr_match_share_scratch(match).columns, 0, (size_t)match->config.width * match->config.disparities);
    }
    kernel->describe_row(match, row);
    kernel->add_census(match, row, row == 0 ? radius + 2u : 1u);
}

static void step_census(const struct tsr_match *match, unsigned step)
{
    unsigned last = match->config.height - 1u;
    unsigned radius = tsr_match_census_radius(&match->config);
    if (step < radius) {
        warm_up(match, step, radius);
        return;
    }
    const struct tsr_match_census_kernel *kernel = tsr_match_census_kernel_of(match);
    unsigned y = step - radius;
    if (y + radius <= last) {
        kernel->describe_row(match, y + radius);
    }
    kernel->census_row(match, y, y + radius < last ? y + radius : last, y > radius ? y - radius - 1u : 0u);
}

static void step(const struct tsr_match *match, unsigned row)
{
    if (has_paths(&match->config)) {
        step_smooth(match, row);
    } else {
        step_census(match, row);
    }
}

const struct tsr_match_method tsr_match_method_census = {rows_total, step};
