/*
 * The matcher's configuration, buffers and order of rows.
 *
 * Of the SAD modes:
 *
 *   rows_done   0 .. H - 1        prefilter row rows_done
 *               H .. H + r - 1    warm-up: column sums one row above the image
 *               H + r .. 2H + r   map rows 0 .. H - 1
 *
 * with r = window / 2. The column sums of the row above the image hold row 0
 * r + 2 times and rows 1 .. r - 1 once, so that moving them down to map row 0
 * is a step like every other.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/match.h"

#include <stdbool.h>
#include <string.h>

#include "match_census.h"
#include "match_plain.h"

#define DISPARITIES_DEFAULT 32
#define WINDOW_DEFAULT 9
#define CAP_MAX 7         /* prefiltered pixels 0 .. 2 cap fit 4 bits: a vector kernel looks differences up */
#define CAP_ROOM 63       /* cap * window <= 63: column sums of 2 cap, and their differences, fit 8 bits with a sign */
#define SAD8_CAP_ROOM 127 /* cap * window^2 <= 127: window sums fit 8 bits */
#define UNIQUENESS_DEFAULT 15
#define UNIQUENESS_DEFAULT_SMOOTH 25
#define UNIQUENESS_DEFAULT_SSD 30
#define UNIQUENESS_MAX 100
#define TEXTURE_DEFAULT 1
#define TOLERANCE_DEFAULT 1
#define TEST_MAX 127

static uint8_t value_or(uint8_t value, uint8_t fallback)
{
    return value != 0 ? value : fallback;
}

/* The largest cap whose sums fit; 0 if none does. */
static uint8_t cap_max(const struct tsr_match_config *config)
{
    int by_columns = CAP_ROOM / config->window;
    int by_window = SAD8_CAP_ROOM / (config->window * config->window);
    int cap = by_columns < CAP_MAX ? by_columns : CAP_MAX;
    return (uint8_t)(config->mode == TSR_MATCH_SAD8 && by_window < cap ? by_window : cap);
}

/* The modes with prefilter, cap and test of texture. */
static bool is_prefiltered(const struct tsr_match_config *config)
{
    return config->mode == TSR_MATCH_SAD || config->mode == TSR_MATCH_SAD8;
}

static bool is_census(const struct tsr_match_config *config)
{
    return config->mode == TSR_MATCH_CENSUS || config->mode == TSR_MATCH_SMOOTH;
}

static uint8_t uniqueness_default(uint8_t mode)
{
    switch (mode) {
    case TSR_MATCH_SMOOTH: return UNIQUENESS_DEFAULT_SMOOTH;
    case TSR_MATCH_SSD: return UNIQUENESS_DEFAULT_SSD;
    default: return UNIQUENESS_DEFAULT;
    }
}

/* Inlined into everything that begins with a check, these two would take a kilobyte of an image. */
static __attribute__((noinline)) struct tsr_match_config resolve(const struct tsr_match_config *config)
{
    struct tsr_match_config resolved = *config;
    resolved.disparities = config->disparities != 0 ? config->disparities : DISPARITIES_DEFAULT;
    bool smooth = config->mode == TSR_MATCH_SMOOTH;
    resolved.window = smooth ? TSR_MATCH_SMOOTH_WINDOW : value_or(config->window, WINDOW_DEFAULT);
    resolved.prefilter_cap = value_or(config->prefilter_cap, cap_max(&resolved));
    resolved.uniqueness_percent = value_or(config->uniqueness_percent, uniqueness_default(config->mode));
    resolved.texture_min = value_or(config->texture_min, TEXTURE_DEFAULT);
    resolved.lr_tolerance_px = value_or(config->lr_tolerance_px, TOLERANCE_DEFAULT);
    resolved.kernel = config->kernel != NULL ? config->kernel : tsr_match_kernel_at(0);
    return resolved;
}

static bool is_above(uint8_t value, uint8_t max)
{
    return value > max && value != TSR_MATCH_TEST_OFF;
}

/* Of resolved values. */
static __attribute__((noinline)) const char *bad_field(const struct tsr_match_config *config)
{
    if (config->width < TSR_MATCH_DISPARITIES_MIN || config->width > TSR_IMAGE_WIDTH_MAX) {
        return "width";
    }
    if (config->height < TSR_MATCH_WINDOW_MIN || config->height > TSR_IMAGE_HEIGHT_MAX) {
        return "height";
    }
    if (config->disparities < TSR_MATCH_DISPARITIES_MIN || config->disparities > TSR_MATCH_DISPARITIES_MAX ||
        config->disparities % TSR_MATCH_LANES != 0 || config->disparities > config->width) {
        return "disparities";
    }
    if (config->mode > TSR_MATCH_SSD) {
        return "mode";
    }
    if (config->window > config->height) {
        return config->mode == TSR_MATCH_SMOOTH ? "height" : "window"; /* smooth's window is not the caller's */
    }
    if (config->window < TSR_MATCH_WINDOW_MIN || config->window > TSR_MATCH_WINDOW_MAX || config->window % 2 == 0) {
        return "window";
    }
    if (is_prefiltered(config) && cap_max(config) == 0) {
        return "window";
    }
    if (is_prefiltered(config) && config->prefilter_cap > cap_max(config)) {
        return "prefilter_cap";
    }
    if (!is_prefiltered(config) && config->right_is_prefiltered) {
        return "right_is_prefiltered";
    }
    if (is_above(config->uniqueness_percent, UNIQUENESS_MAX)) {
        return "uniqueness_percent";
    }
    if (is_prefiltered(config) && is_above(config->texture_min, TEST_MAX)) {
        return "texture_min";
    }
    if (is_above(config->lr_tolerance_px, TEST_MAX)) {
        return "lr_tolerance_px";
    }
    int room = config->width - config->disparities;
    if (config->search_start_px < -room || config->search_start_px > room) {
        return "search_start_px";
    }
    return NULL;
}

enum tsr_status tsr_match_check(const struct tsr_match_config *config, const char **field)
{
    const char *bad = "config";
    if (config != NULL) {
        struct tsr_match_config resolved = resolve(config);
        bad = bad_field(&resolved);
    }
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

uint8_t tsr_match_prefilter_cap(const struct tsr_match_config *config)
{
    if (tsr_match_check(config, NULL) != TSR_OK || !is_prefiltered(config)) {
        return 0;
    }
    return resolve(config).prefilter_cap;
}

/* Bytes of the scratch's columns and what the mode keeps with them, and of what it keeps behind all. */
static size_t columns_len(const struct tsr_match_config *config)
{
    if (tsr_match_is_plain(config->mode)) {
        return tsr_match_plain_columns_len(config);
    }
    return is_census(config) ? tsr_match_census_columns_len(config) : (size_t)config->width * config->disparities;
}

static size_t behind_len(const struct tsr_match_config *config)
{
    if (tsr_match_is_plain(config->mode)) {
        return tsr_match_plain_met_len(config);
    }
    return is_census(config) ? tsr_match_census_planes_len(config) : 0u;
}

size_t tsr_match_scratch_len(const struct tsr_match_config *config)
{
    if (tsr_match_check(config, NULL) != TSR_OK) {
        return 0;
    }
    struct tsr_match_config resolved = resolve(config);
    size_t width_by_disparities = (size_t)resolved.width * resolved.disparities;
    return TSR_MATCH_SCRATCH_LEN(resolved.width, resolved.disparities) - width_by_disparities + columns_len(&resolved) +
           behind_len(&resolved);
}

size_t tsr_match_pair_len(const struct tsr_match_config *config)
{
    if (tsr_match_check(config, NULL) != TSR_OK) {
        return 0;
    }
    struct tsr_match_config resolved = resolve(config);
    return TSR_MATCH_PAIR_LEN(resolved.width, resolved.height, resolved.window);
}

struct tsr_gray tsr_match_pair_left(uint8_t *pair, const struct tsr_match_config *config)
{
    unsigned rows_above = resolve(config).window / 2u + 1u;
    struct tsr_gray left = {pair + 2u * (size_t)config->width * rows_above, config->width, config->height,
                            (uint16_t)(2u * config->width)};
    return left;
}

struct tsr_gray tsr_match_pair_right(uint8_t *pair, const struct tsr_match_config *config)
{
    struct tsr_gray right = tsr_match_pair_left(pair, config);
    right.pixels += config->width;
    return right;
}

uint16_t *tsr_match_pair_map(uint8_t *pair)
{
    return (uint16_t *)(void *)pair;
}

/* Claims take 16 bits: window sums up to 1890 >> 2, 3600 >> 3, 204. */
unsigned tsr_match_claim_shift(uint8_t mode)
{
    return mode == TSR_MATCH_SMOOTH ? 0u : mode == TSR_MATCH_CENSUS ? 3u : 2u;
}

struct tsr_match_scratch tsr_match_share_scratch(const struct tsr_match *match)
{
    size_t width = match->config.width;
    size_t disparities = match->config.disparities;
    struct tsr_match_scratch scratch;
    scratch.sums = (int16_t *)(void *)match->scratch;
    scratch.offered = scratch.sums + disparities;
    scratch.columns = (uint8_t *)(scratch.offered + disparities) + TSR_MATCH_EDGE_ROOM;
    scratch.claims = (uint16_t *)(void *)(scratch.columns + columns_len(&match->config));
    scratch.choices = scratch.claims + width;
    scratch.texture = (uint8_t *)(scratch.choices + width);
    return scratch;
}

/* A map row may be written once the frame rows below its end are all that is
 * still read. Both ends grow linearly with y: the first and the last row decide. */
static bool may_overlay(const struct tsr_match_config *config, const struct tsr_gray *frame, const uint16_t *map)
{
    uintptr_t map_at = (uintptr_t)map;
    uintptr_t frame_at = (uintptr_t)frame->pixels;
    size_t map_row_len = sizeof(uint16_t) * config->width;
    size_t radius = config->window / 2u;
    size_t last = config->height - 1u;
    bool apart =
        map_at + map_row_len * config->height <= frame_at || frame_at + frame->stride * last + config->width <= map_at;
    bool behind = map_at + map_row_len * (radius + 1u) <= frame_at &&
                  map_at + map_row_len * (last + 1u) <= frame_at + frame->stride * (last - radius);
    return apart || behind;
}

static bool has_shape(const struct tsr_gray *frame, const struct tsr_match_config *config)
{
    return frame->width == config->width && frame->height == config->height && frame->stride >= config->width;
}

/* As tsr_match_start(), by the method of the mode. */
static enum tsr_status start(struct tsr_match *match, const struct tsr_match_config *config, struct tsr_gray left,
                             struct tsr_gray right, uint16_t *map, size_t map_cap, uint8_t *scratch, size_t scratch_cap,
                             const struct tsr_match_method *method)
{
    if (match == NULL || left.pixels == NULL || right.pixels == NULL || map == NULL || scratch == NULL ||
        tsr_match_check(config, NULL) != TSR_OK || (uintptr_t)map % sizeof(uint16_t) != 0 ||
        (uintptr_t)scratch % TSR_MATCH_SCRATCH_ALIGN != 0) {
        return TSR_ERR_ARG;
    }
    struct tsr_match_config resolved = resolve(config);
    if (!has_shape(&left, &resolved) || !has_shape(&right, &resolved)) {
        return TSR_ERR_SIZE;
    }
    if (map_cap < (size_t)resolved.width * resolved.height || scratch_cap < tsr_match_scratch_len(config)) {
        return TSR_ERR_NOBUF;
    }
    if (!may_overlay(&resolved, &left, map) || !may_overlay(&resolved, &right, map)) {
        return TSR_ERR_ARG;
    }
    bool covered = resolved.search_start_px >= 0 || resolved.kernel->any_start;
    const struct tsr_match_kernel *kernel = covered ? resolved.kernel : &tsr_match_kernel_portable;
    *match = (struct tsr_match){resolved, left, right, map, scratch, kernel, method, 0};
    return TSR_OK;
}

static void warm_up(const struct tsr_match *match, unsigned row, unsigned radius)
{
    if (row == 0) {
        memset(match->scratch, 0, TSR_MATCH_SCRATCH_LEN(match->config.width, match->config.disparities));
    }
    match->kernel->add_row(match, row, row == 0 ? radius + 2u : 1u);
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned radius)
{
    unsigned last = match->config.height - 1u;
    unsigned enter = y + radius < last ? y + radius : last;
    unsigned leave = y > radius ? y - radius - 1u : 0u;
    match->kernel->match_row(match, y, enter, leave);
}

static unsigned rows_total(const struct tsr_match_config *config)
{
    return 2u * config->height + config->window / 2u;
}

static void step(const struct tsr_match *match, unsigned row)
{
    unsigned height = match->config.height;
    unsigned radius = match->config.window / 2u;
    if (row < height) {
        match->kernel->prefilter_row(match, row);
    } else if (row < height + radius) {
        warm_up(match, row - height, radius);
    } else {
        match_row(match, row - height - radius, radius);
    }
}

static const struct tsr_match_method method_sad = {rows_total, step};

enum tsr_status tsr_match_start_sad(struct tsr_match *match, const struct tsr_match_config *config,
                                    struct tsr_gray left, struct tsr_gray right, uint16_t *map, size_t map_cap,
                                    uint8_t *scratch, size_t scratch_cap)
{
    if (config != NULL && !is_prefiltered(config)) {
        return TSR_ERR_ARG;
    }
    return start(match, config, left, right, map, map_cap, scratch, scratch_cap, &method_sad);
}

enum tsr_status tsr_match_start(struct tsr_match *match, const struct tsr_match_config *config, struct tsr_gray left,
                                struct tsr_gray right, uint16_t *map, size_t map_cap, uint8_t *scratch,
                                size_t scratch_cap)
{
    const struct tsr_match_method *method = &method_sad;
    if (config != NULL && is_census(config)) {
        method = &tsr_match_method_census;
    } else if (config != NULL && tsr_match_is_plain(config->mode)) {
        method = &tsr_match_method_plain;
    }
    return start(match, config, left, right, map, map_cap, scratch, scratch_cap, method);
}

enum tsr_status tsr_match_run(struct tsr_match *match, uint16_t rows)
{
    if (match == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    unsigned total = match->method->rows_total(&match->config);
    for (; rows > 0 && match->rows_done < total; rows--, match->rows_done++) {
        match->method->step(match, match->rows_done);
    }
    return match->rows_done < total ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_match_rows_done(const struct tsr_match *match)
{
    return match->rows_done;
}

uint16_t tsr_match_rows_total(const struct tsr_match *match)
{
    return (uint16_t)match->method->rows_total(&match->config);
}
