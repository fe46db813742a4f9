/*
 * Sigma-delta change detection on a reduced image: configuration and frames.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/change.h"

#include <string.h>

#include "change_cells.h"

#define SIDE_MIN 8
#define REDUCTION_DEFAULT 4
#define AMPLIFICATION_DEFAULT 4
#define AMPLIFICATION_MAX 8
#define DEVIATION_MIN_DEFAULT 5
#define DEVIATION_MAX_DEFAULT 64
#define DEVIATION_MAX_MAX 127
#define MIN_CELLS_DEFAULT 2u
#define CELLS_PER_MIN_CELL 400u
#define SETTLE_FRAMES_DEFAULT 4

static unsigned cells_of(const struct tsr_change_config *config)
{
    return (unsigned)(config->width / config->reduction) * (unsigned)(config->height / config->reduction);
}

/* A small region has few cells that noise could change together, so fewer are enough. */
static uint16_t default_min_cells(const struct tsr_change_config *config)
{
    uint32_t pixels = config->watched_count == 0 ? (uint32_t)config->width * config->height : 0;
    for (unsigned i = 0; i < config->watched_count; i++) {
        pixels += (uint32_t)config->watched[i].width * config->watched[i].height;
    }
    uint32_t wanted = pixels / (CELLS_PER_MIN_CELL * config->reduction * config->reduction);
    wanted = wanted > MIN_CELLS_DEFAULT ? wanted : MIN_CELLS_DEFAULT;
    return (uint16_t)(wanted < cells_of(config) ? wanted : cells_of(config));
}

static void set_default(uint8_t *value, uint8_t fallback)
{
    *value = *value != 0 ? *value : fallback;
}

static const char *bad_picture(const struct tsr_change_config *config)
{
    if (config->width < SIDE_MIN || config->width > TSR_IMAGE_WIDTH_MAX) {
        return "width";
    }
    if (config->height < SIDE_MIN || config->height > TSR_IMAGE_HEIGHT_MAX) {
        return "height";
    }
    if (config->reduction != 2 && config->reduction != 4 && config->reduction != 8) {
        return "reduction";
    }
    if (config->watched_count > TSR_CHANGE_WATCHED_MAX) {
        return "watched_count";
    }
    for (unsigned i = 0; i < config->watched_count; i++) {
        if (!tsr_rectangle_is_inside(&config->watched[i], config->width, config->height)) {
            return "watched";
        }
    }
    return NULL;
}

static const char *bad_rule(const struct tsr_change_config *config)
{
    if (config->amplification > AMPLIFICATION_MAX) {
        return "amplification";
    }
    if (config->deviation_min > DEVIATION_MAX_MAX) {
        return "deviation_min";
    }
    if (config->deviation_max < config->deviation_min || config->deviation_max > DEVIATION_MAX_MAX) {
        return "deviation_max";
    }
    return config->min_cells > cells_of(config) ? "min_cells" : NULL;
}

/* Fills in the defaults; the first bad field, or null. */
static const char *resolve(const struct tsr_change_config *config, struct tsr_change_config *resolved)
{
    if (config == NULL) {
        return "config";
    }
    *resolved = *config;
    set_default(&resolved->reduction, REDUCTION_DEFAULT);
    set_default(&resolved->amplification, AMPLIFICATION_DEFAULT);
    set_default(&resolved->deviation_min, DEVIATION_MIN_DEFAULT);
    set_default(&resolved->deviation_max, DEVIATION_MAX_DEFAULT);
    set_default(&resolved->settle_frames, SETTLE_FRAMES_DEFAULT);
    const char *bad = bad_picture(resolved);
    if (bad != NULL) {
        return bad;
    }
    if (resolved->min_cells == 0) {
        resolved->min_cells = default_min_cells(resolved);
    }
    return bad_rule(resolved);
}

enum tsr_status tsr_change_check(const struct tsr_change_config *config, const char **field)
{
    struct tsr_change_config resolved;
    const char *bad = resolve(config, &resolved);
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

size_t tsr_change_state_len(const struct tsr_change_config *config)
{
    struct tsr_change_config resolved;
    return resolve(config, &resolved) != NULL ? 0 : (size_t)3 * cells_of(&resolved);
}

enum tsr_status tsr_change_init(struct tsr_change *change, const struct tsr_change_config *config, uint8_t *state,
                                size_t state_cap)
{
    struct tsr_change_config resolved;
    if (change == NULL || state == NULL || resolve(config, &resolved) != NULL) {
        return TSR_ERR_ARG;
    }
    if (state_cap < (size_t)3 * cells_of(&resolved)) {
        return TSR_ERR_NOBUF;
    }
    *change = (struct tsr_change){.config = resolved,
                                  .state = state,
                                  .cells_x = (uint16_t)(resolved.width / resolved.reduction),
                                  .cells_y = (uint16_t)(resolved.height / resolved.reduction)};
    return TSR_OK;
}

static enum tsr_status check_frame(const struct tsr_change *change, const struct tsr_gray_view *frame)
{
    if (change == NULL || frame == NULL || frame->pixels == NULL) {
        return TSR_ERR_ARG;
    }
    bool fits =
        frame->width == change->config.width && frame->height == change->config.height && frame->stride >= frame->width;
    return fits ? TSR_OK : TSR_ERR_SIZE;
}

static void teach_background(struct tsr_change *change, const struct tsr_gray_view *frame)
{
    size_t cells = cells_of(&change->config);
    tsr_change_reduce(change, frame, change->state + cells);
    if (change->frames == 0) {
        memset(change->state + 2 * cells, change->config.deviation_min, cells);
    }
}

static void count_frame(struct tsr_change *change)
{
    if (change->frames < change->config.settle_frames) {
        change->frames++;
    }
}

enum tsr_status tsr_change_update(struct tsr_change *change, const struct tsr_gray_view *frame,
                                  struct tsr_change_result *result)
{
    enum tsr_status status = result == NULL ? TSR_ERR_ARG : check_frame(change, frame);
    if (status != TSR_OK) {
        return status;
    }
    unsigned changed = 0;
    unsigned light_q8 = TSR_CHANGE_LIGHT_ONE_Q8;
    if (change->frames == 0) {
        teach_background(change, frame);
    } else {
        tsr_change_reduce(change, frame, change->state);
        light_q8 = tsr_change_measure_light(change);
        changed = tsr_change_follow(change, light_q8);
        change->beat++;
    }
    bool settling = change->frames < change->config.settle_frames;
    unsigned min_cells = change->config.min_cells;
    result->settling = settling;
    result->light_q8 = (uint16_t)light_q8;
    result->changed_cells = (uint16_t)(settling ? 0u : changed);
    result->changed = !settling && changed >= min_cells && tsr_change_has_region(change, min_cells);
    count_frame(change);
    return TSR_OK;
}

enum tsr_status tsr_change_rebase(struct tsr_change *change, const struct tsr_gray_view *frame)
{
    enum tsr_status status = check_frame(change, frame);
    if (status == TSR_OK) {
        teach_background(change, frame);
        count_frame(change);
    }
    return status;
}
