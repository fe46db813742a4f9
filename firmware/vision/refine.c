/*
 * The filters of a map as one piece of work.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/refine.h"

#include "map_buffers.h"

static bool has_step(const struct tsr_refine_config *config, unsigned step)
{
    return step < TSR_REFINE_STEPS_MAX && config->steps[step] != TSR_REFINE_END;
}

static const char *bad_field(const struct tsr_refine_config *config)
{
    if (config->width == 0 || config->width > TSR_IMAGE_WIDTH_MAX) {
        return "width";
    }
    if (config->height == 0 || config->height > TSR_IMAGE_HEIGHT_MAX) {
        return "height";
    }
    for (unsigned i = 0; i < TSR_REFINE_STEPS_MAX; i++) {
        bool after_end = i > 0 && config->steps[i - 1u] == TSR_REFINE_END && config->steps[i] != TSR_REFINE_END;
        if (config->steps[i] >= TSR_REFINE_STEP_COUNT || after_end) {
            return "steps";
        }
    }
    const char *field = NULL;
    if (tsr_speckle_check(&config->speckle, &field) == TSR_OK &&
        tsr_diffusion_check(&config->diffusion, &field) == TSR_OK && config->fill_rule >= TSR_FILL_RULE_COUNT) {
        field = "fill_rule";
    }
    return field;
}

enum tsr_status tsr_refine_check(const struct tsr_refine_config *config, const char **field)
{
    const char *bad = config != NULL ? bad_field(config) : "config";
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

static size_t step_scratch_len(const struct tsr_refine_config *config, unsigned step)
{
    switch (config->steps[step]) {
    case TSR_REFINE_MEDIAN3:
    case TSR_REFINE_MEDIAN5: return TSR_MEDIAN_SCRATCH_LEN(config->width);
    case TSR_REFINE_SPECKLE: return tsr_speckle_scratch_len(&config->speckle, config->width);
    case TSR_REFINE_FILL: return tsr_fill_scratch_len((enum tsr_fill_rule)config->fill_rule, config->width);
    case TSR_REFINE_GAUSSIAN3: return TSR_GAUSSIAN_SCRATCH_LEN(config->width, 3);
    case TSR_REFINE_GAUSSIAN5: return TSR_GAUSSIAN_SCRATCH_LEN(config->width, TSR_GAUSSIAN_WINDOW_MAX);
    case TSR_REFINE_DIFFUSION: return TSR_DIFFUSION_SCRATCH_LEN(config->width);
    default: return 0;
    }
}

size_t tsr_refine_scratch_len(const struct tsr_refine_config *config)
{
    size_t len = 0;
    if (tsr_refine_check(config, NULL) != TSR_OK) {
        return 0;
    }
    for (unsigned i = 0; has_step(config, i); i++) {
        size_t step_len = step_scratch_len(config, i);
        len = step_len > len ? step_len : len;
    }
    return len;
}

enum tsr_status tsr_refine_start(struct tsr_refine *refine, const struct tsr_refine_config *config, uint16_t *map,
                                 size_t map_cap, uint8_t *scratch, size_t scratch_cap)
{
    if (refine == NULL || tsr_refine_check(config, NULL) != TSR_OK) {
        return TSR_ERR_ARG;
    }
    const struct tsr_map_buffers buffers = {
        map, map_cap, scratch, scratch_cap, tsr_refine_scratch_len(config), config->width, config->height};
    enum tsr_status status = tsr_map_check_buffers(&buffers);
    if (status == TSR_OK) {
        *refine = (struct tsr_refine){.config = *config, .map = map, .scratch = scratch, .scratch_cap = scratch_cap};
    }
    return status;
}

/* The buffers were checked by start. */
static void start_step(struct tsr_refine *refine)
{
    const struct tsr_refine_config *config = &refine->config;
    const uint16_t width = config->width;
    const uint16_t height = config->height;
    const size_t map_cap = (size_t)width * height;
    uint16_t *map = refine->map;
    uint8_t *scratch = refine->scratch;
    const size_t cap = refine->scratch_cap;
    switch (config->steps[refine->step]) {
    case TSR_REFINE_MEDIAN3:
    case TSR_REFINE_MEDIAN5:
        (void)tsr_median_start_window(&refine->work.median,
                                      config->steps[refine->step] == TSR_REFINE_MEDIAN3 ? TSR_MEDIAN_WINDOW
                                                                                        : TSR_MEDIAN_WINDOW_MAX,
                                      width, height, map, map_cap, scratch, cap);
        break;
    case TSR_REFINE_SPECKLE:
        (void)tsr_speckle_start(&refine->work.speckle, &config->speckle, width, height, map, map_cap, scratch, cap);
        break;
    case TSR_REFINE_FILL:
        (void)tsr_fill_start(&refine->work.fill, (enum tsr_fill_rule)config->fill_rule, width, height, map, map_cap,
                             scratch, cap);
        break;
    case TSR_REFINE_GAUSSIAN3:
    case TSR_REFINE_GAUSSIAN5:
        (void)tsr_gaussian_start(&refine->work.gaussian,
                                 config->steps[refine->step] == TSR_REFINE_GAUSSIAN3 ? 3 : TSR_GAUSSIAN_WINDOW_MAX,
                                 width, height, map, map_cap, scratch, cap);
        break;
    default:
        (void)tsr_diffusion_start(&refine->work.diffusion, &config->diffusion, width, height, map, map_cap, scratch,
                                  cap);
        break;
    }
}

static enum tsr_status run_row_of_step(struct tsr_refine *refine)
{
    switch (refine->config.steps[refine->step]) {
    case TSR_REFINE_MEDIAN3:
    case TSR_REFINE_MEDIAN5: return tsr_median_run(&refine->work.median, 1);
    case TSR_REFINE_SPECKLE: return tsr_speckle_run(&refine->work.speckle, 1);
    case TSR_REFINE_FILL: return tsr_fill_run(&refine->work.fill, 1);
    case TSR_REFINE_GAUSSIAN3:
    case TSR_REFINE_GAUSSIAN5: return tsr_gaussian_run(&refine->work.gaussian, 1);
    default: return tsr_diffusion_run(&refine->work.diffusion, 1);
    }
}

enum tsr_status tsr_refine_run(struct tsr_refine *refine, uint16_t rows)
{
    if (refine == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    for (; rows > 0 && has_step(&refine->config, refine->step); rows--) {
        if (!refine->is_started) {
            start_step(refine);
            refine->is_started = true;
        }
        refine->rows_done++;
        if (run_row_of_step(refine) != TSR_AGAIN) {
            refine->step++;
            refine->is_started = false;
        }
    }
    return has_step(&refine->config, refine->step) ? TSR_AGAIN : TSR_OK;
}

uint32_t tsr_refine_rows_done(const struct tsr_refine *refine)
{
    return refine->rows_done;
}

static uint32_t step_rows(const struct tsr_refine_config *config, unsigned step)
{
    switch (config->steps[step]) {
    case TSR_REFINE_FILL: return TSR_FILL_ROWS_TOTAL(config->height);
    case TSR_REFINE_DIFFUSION: return tsr_diffusion_rows_total(&config->diffusion, config->height);
    default: return config->height;
    }
}

uint32_t tsr_refine_rows_total(const struct tsr_refine *refine)
{
    uint32_t rows = 0;
    for (unsigned i = 0; has_step(&refine->config, i); i++) {
        rows += step_rows(&refine->config, i);
    }
    return rows;
}
