/*
 * The filters of a map, each on the matcher's map, in the node's quanta.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/refine.h"
#include "workbench.h"

#define ROWS_PER_STEP 4u
#define MIN_SIZE 50u

static uint16_t refined[WORKBENCH_PIXELS_MAX];
static _Alignas(2) uint8_t scratch[TSR_SPECKLE_SCRATCH_LEN(WORKBENCH_WIDTH_MAX, MIN_SIZE)];

static void run_filter(const struct workbench_case *bench, const uint16_t *map, enum tsr_refine_step step,
                       const char *work, const char *file)
{
    size_t pixels = (size_t)bench->width * bench->height;
    const struct tsr_refine_config config = {
        .width = bench->width, .height = bench->height, .steps = {(uint8_t)step}, .speckle = {.min_size = MIN_SIZE}};
    struct tsr_refine refine;
    memcpy(refined, map, pixels * sizeof *map);
    workbench_begin();
    enum tsr_status status = tsr_refine_start(&refine, &config, refined, pixels, scratch, sizeof scratch);
    workbench_expect(status == TSR_OK, work);
    do {
        status = tsr_refine_run(&refine, ROWS_PER_STEP);
    } while (status == TSR_AGAIN);
    workbench_end(work, step == TSR_REFINE_DIFFUSION ? tsr_refine_rows_total(&refine) * bench->width : pixels);
    workbench_expect(status == TSR_OK, work);
    workbench_store(file, refined, pixels * sizeof *map);
}

void workbench_run_refinements(const struct workbench_case *bench, const uint16_t *map)
{
    run_filter(bench, map, TSR_REFINE_MEDIAN5, "median5", "median5.out");
    run_filter(bench, map, TSR_REFINE_SPECKLE, "speckle", "speckle.out");
    run_filter(bench, map, TSR_REFINE_FILL, "fill", "fill.out");
    run_filter(bench, map, TSR_REFINE_GAUSSIAN3, "gaussian3", "gaussian3.out");
    run_filter(bench, map, TSR_REFINE_GAUSSIAN5, "gaussian5", "gaussian5.out");
    run_filter(bench, map, TSR_REFINE_DIFFUSION, "diffusion", "diffusion.out");
}
