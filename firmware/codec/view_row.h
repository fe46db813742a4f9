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

/* Forget everything; info, held and scratch are set by the caller. */
void tsr_view_model_reset(struct tsr_view_model *model);

/*
 * Code the next row: from pixels, which the encoder has filled, or into them.
 *
 *   pixels   [width]; the encoder's keep what they were
 *   tiles    of this row of tiles; null in a decoder or on its own
 */
void tsr_view_code_row(struct tsr_view_model *model, const struct tsr_range_port *port, uint8_t *out, const uint8_t *in,
                       const uint8_t *tiles);

#endif
