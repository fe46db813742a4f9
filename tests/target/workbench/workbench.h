/*
 * The workbench: every kind of work of a node once, on one pair, between
 * markers that the instruction counter knows.
 *
 * The same source runs on a Cortex-M4 and on the host. It reads and writes
 * files in the working folder:
 *
 *   in   before.gray left.gray right.gray   bytes, width x height
 *   out  NAME.out                           one per result, the same on every machine
 *        work.txt                           a line "WORK UNITS" per pair of markers, in order
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_WORKBENCH_H
#define TSR_TESTS_WORKBENCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/aes.h"

#define WORKBENCH_WIDTH_MAX 320u
#define WORKBENCH_HEIGHT_MAX 240u
#define WORKBENCH_PIXELS_MAX (WORKBENCH_WIDTH_MAX * WORKBENCH_HEIGHT_MAX)
#define WORKBENCH_STEP_LOG2 3u /* of the coded map: 1/2 px */

struct workbench_case {
    uint16_t width;
    uint16_t height;
    uint16_t disparities;
};

/* Given by the machine that it runs on. The calls say what failed and end the
 * program, so that nothing is measured that did not happen. */
void workbench_load(const char *name, uint8_t *bytes, size_t len);
void workbench_store(const char *name, const void *bytes, size_t len);
_Noreturn void workbench_fail(const char *what);
extern const struct tsr_aes_ops *const workbench_aes;

/* Instructions between the two calls are counted on the board. */
void workbench_begin(void);
void workbench_end(const char *work, size_t units);
/* work.txt, at the end. */
void workbench_store_work(void);

/* TSR_OK or the end of the program. */
void workbench_expect(bool held, const char *what);

void workbench_run(const struct workbench_case *bench);

/* refinements.c, codecs.c, rectify.c and seals.c */
void workbench_run_refinements(const struct workbench_case *bench, const uint16_t *map);
void workbench_run_gray(const struct workbench_case *bench, const uint8_t *left, const uint8_t *right);
/* Gives the right view as a lead has it, coarse and prefiltered. */
const uint8_t *workbench_run_view(const struct workbench_case *bench, const uint8_t *left, const uint8_t *right);
void workbench_run_picture(const struct workbench_case *bench, const uint8_t *left);
size_t workbench_run_map(const struct workbench_case *bench, const uint16_t *map, uint8_t *coded, size_t coded_cap);
void workbench_run_rectify(const struct workbench_case *bench, const uint8_t *view);
void workbench_run_seals(const uint8_t *text, size_t text_len);

#endif
