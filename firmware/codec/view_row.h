/*
 * The model of the prefiltered-view codec, docs/codec.md, chapter 4.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_VIEW_ROW_H
#define TSR_CODEC_VIEW_ROW_H

#include "range_port.h"
#include "tsr/codec/view.h"

/* A view that has cost this much more than its literal size is stored literally until it is cheap again. */
#define TSR_VIEW_SLACK_LEN 256u

/* The trained start of the contexts, of coarse views. */
extern const uint16_t tsr_view_prior[TSR_VIEW_CONTEXT_COUNT];

/* The same of views in packets, exact and coarse. */
extern const uint16_t tsr_view_packet_prior[2][TSR_VIEW_CONTEXT_COUNT];

/* Forget everything; info, held and scratch are set by the caller. */
void tsr_view_model_reset(struct tsr_view_model *model);

/* Enter a strip of model->info.width columns: nothing is known of it. */
void tsr_view_clear_rows(struct tsr_view_model *model);

/* Pixels of row model->row, 0 .. 2 cap. */
uint8_t *tsr_view_row_pixels(const struct tsr_view_model *model);

/* Code columns x .. end - 1 of the row, which the encoder has filled. */
void tsr_view_code_span(struct tsr_view_model *model, const struct tsr_range_port *port, unsigned x, unsigned end);

/*
 * Code the next row: from pixels, which the encoder has filled, or into them.
 *
 *   pixels   [width]; the encoder's keep what they were
 *   tiles    of this row of tiles; null in a decoder or on its own
 */
void tsr_view_code_row(struct tsr_view_model *model, const struct tsr_range_port *port, uint8_t *out, const uint8_t *in,
                       const uint8_t *tiles);

#endif
