/*
 * Sigma-delta change detection on a reduced image.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/change.h"

#define SIDE_MIN 8
#define REDUCTION_DEFAULT 4
#define AMPLIFICATION_DEFAULT 4
#define AMPLIFICATION_MAX 8
#define DEVIATION_MIN_DEFAULT 6
#define DEVIATION_MIN_MAX 127
#define DEVIATION_MAX_DEFAULT 64
#define MIN_CELLS_DEFAULT 2u
#define CELLS_PER_MIN_CELL 200u
#define SETTLE_FRAMES_DEFAULT 4

static uint8_t value_or(uint8_t value, uint8_t fallback)
{
    return value != 0 ? value : fallback;
}

static unsigned cells_of(const struct tsr_change_config *config)
{
    return (unsigned)(config->width / config->reduction) * (unsigned)(config->height / config->reduction);
}

static unsigned default_min_cells(unsigned cells)
{
    unsigned wanted = cells / CELLS_PER_MIN_CELL;
    wanted = wanted > MIN_CELLS_DEFAULT ? wanted : MIN_CELLS_DEFAULT;
    return wanted < cells ? wanted : cells;
}

static struct tsr_change_config resolve(const struct tsr_change_config *config)
{
    struct tsr_change_config resolved = *config;
    resolved.reduction = value_or(config->reduction, REDUCTION_DEFAULT);
    resolved.amplification = value_or(config->amplification, AMPLIFICATION_DEFAULT);
    resolved.deviation_min = value_or(config->deviation_min, DEVIATION_MIN_DEFAULT);
    resolved.deviation_max = value_or(config->deviation_max, DEVIATION_MAX_DEFAULT);
    resolved.settle_frames = value_or(config->settle_frames, SETTLE_FRAMES_DEFAULT);
    if (config->min_cells == 0) {
        resolved.min_cells = (uint16_t)default_min_cells(cells_of(&resolved));
    }
    return resolved;
}

/* Of resolved values. */
static const char *bad_field(const struct tsr_change_config *config)
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
    if (config->amplification > AMPLIFICATION_MAX) {
        return "amplification";
    }
    if (config->deviation_min > DEVIATION_MIN_MAX) {
        return "deviation_min";
    }
    if (config->deviation_max < config->deviation_min) {
        return "deviation_max";
    }
    if (config->min_cells > cells_of(config)) {
        return "min_cells";
    }
    return NULL;
}

enum tsr_status tsr_change_check(const struct tsr_change_config *config, const char **field)
{
    const char *bad = "config";
    if (config != NULL) {
        struct tsr_change_config resolved = resolve(config);
        bad = bad_field(&resolved);
    }
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

size_t tsr_change_state_len(const struct tsr_change_config *config)
{
    if (tsr_change_check(config, NULL) != TSR_OK) {
        return 0;
    }
    struct tsr_change_config resolved = resolve(config);
    return TSR_CHANGE_STATE_LEN(resolved.width, resolved.height, resolved.reduction);
}

enum tsr_status tsr_change_init(struct tsr_change *change, const struct tsr_change_config *config, uint8_t *state,
                                size_t state_cap)
{
    if (change == NULL || state == NULL || tsr_change_check(config, NULL) != TSR_OK) {
        return TSR_ERR_ARG;
    }
    if (state_cap < tsr_change_state_len(config)) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_change_config resolved = resolve(config);
    *change = (struct tsr_change){.config = resolved,
                                  .state = state,
                                  .cells_x = (uint16_t)(resolved.width / resolved.reduction),
                                  .cells_y = (uint16_t)(resolved.height / resolved.reduction),
                                  .frames = 0};
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

/* docs/math.md, eq. (6): the mean of a cell, to nearest, ties up. */
static uint8_t reduce_cell(const struct tsr_change *change, const struct tsr_gray_view *frame, unsigned cell_x,
                           unsigned cell_y)
{
    unsigned side = change->config.reduction;
    unsigned area_log2 = side == 2 ? 2u : side == 4 ? 4u : 6u;
    const uint8_t *row = frame->pixels + (size_t)cell_y * side * frame->stride + (size_t)cell_x * side;
    unsigned sum = 1u << (area_log2 - 1u);
    for (unsigned y = 0; y < side; y++, row += frame->stride) {
        for (unsigned x = 0; x < side; x++) {
            sum += row[x];
        }
    }
    return (uint8_t)(sum >> area_log2);
}

static unsigned step_towards(unsigned value, unsigned target)
{
    return value + (target > value ? 1u : 0u) - (target < value ? 1u : 0u);
}

/* docs/math.md, eqs. (7) to (9). True if the cell changed. */
static bool update_cell(const struct tsr_change_config *config, uint8_t *mean, uint8_t *deviation, uint8_t gray)
{
    unsigned moved = step_towards(*mean, gray);
    unsigned distance = moved > gray ? moved - gray : gray - moved;
    unsigned spread = step_towards(*deviation, config->amplification * distance);
    spread = spread < config->deviation_min ? config->deviation_min : spread;
    spread = spread > config->deviation_max ? config->deviation_max : spread;
    *mean = (uint8_t)moved;
    *deviation = (uint8_t)spread;
    return distance > spread;
}

static void teach_background(struct tsr_change *change, const struct tsr_gray_view *frame)
{
    size_t cells = (size_t)change->cells_x * change->cells_y;
    uint8_t *mean = change->state;
    for (unsigned y = 0; y < change->cells_y; y++) {
        for (unsigned x = 0; x < change->cells_x; x++) {
            *mean++ = reduce_cell(change, frame, x, y);
        }
    }
    for (size_t i = 0; i < cells && change->frames == 0; i++) {
        change->state[cells + i] = change->config.deviation_min;
    }
}

static unsigned update_background(struct tsr_change *change, const struct tsr_gray_view *frame)
{
    uint8_t *mean = change->state;
    uint8_t *deviation = mean + (size_t)change->cells_x * change->cells_y;
    unsigned changed = 0;
    for (unsigned y = 0; y < change->cells_y; y++) {
        for (unsigned x = 0; x < change->cells_x; x++) {
            uint8_t gray = reduce_cell(change, frame, x, y);
            changed += update_cell(&change->config, mean++, deviation++, gray) ? 1u : 0u;
        }
    }
    return changed;
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
    if (change->frames == 0) {
        teach_background(change, frame);
    } else {
        changed = update_background(change, frame);
    }
    bool settling = change->frames < change->config.settle_frames;
    result->settling = settling;
    result->changed_cells = (uint16_t)(settling ? 0u : changed);
    result->changed = !settling && changed >= change->config.min_cells;
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
