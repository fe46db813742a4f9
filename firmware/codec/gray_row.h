/*
 * The pixel model of the gray-image codec, docs/codec.md, chapter 3.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_GRAY_ROW_H
#define TSR_CODEC_GRAY_ROW_H

#include "range_port.h"
#include "tsr/codec/gray.h"

/* An image that has cost this much more than its literal size is stored literally until it is cheap again. */
#define TSR_GRAY_SLACK_LEN 256u

/* What contexts of packets start from: lossless, of one near, by activity. */
extern const uint16_t tsr_gray_packet_prior[3][TSR_GRAY_CONTEXT_COUNT];

/* Forget everything; scratch and info are set by the caller. */
void tsr_gray_model_reset(struct tsr_gray_model *model);

/* Pixels of row model->row: the encoder fills them before, the coder replaces them by the decoded ones. */
uint8_t *tsr_gray_row_pixels(const struct tsr_gray_model *model);

/* Prediction errors of the row, of which those of the row above take the place until they are coded. */
static inline uint8_t *tsr_gray_row_errors(const struct tsr_gray_model *model)
{
    return model->scratch + 2u * (size_t)model->info.width;
}

/* Code columns x .. end - 1 of the row. */
void tsr_gray_code_span(struct tsr_gray_model *model, const struct tsr_range_port *port, unsigned x, unsigned end);

/* Code the row and step to the next. */
void tsr_gray_code_row(struct tsr_gray_model *model, const struct tsr_range_port *port);

#endif
