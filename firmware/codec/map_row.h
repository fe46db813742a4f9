/*
 * The label model of the disparity-map codec, docs/codec.md, chapter 2.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_ROW_H
#define TSR_CODEC_MAP_ROW_H

#include "range_port.h"
#include "tsr/codec/map.h"

#define TSR_LABEL_INVALID 0u

/* A map that has cost this much more than its literal size is stored literally until it is cheap again. */
#define TSR_MAP_SLACK_LEN 256u

/* Forget everything; scratch, info and label_count are set by the caller. */
void tsr_map_model_reset(struct tsr_map_model *model);

/* Labels of row model->row: the encoder fills them before, the decoder reads them after. */
uint16_t *tsr_map_row_labels(const struct tsr_map_model *model);

/* Code the row and step to the next; false if the decoder met a label that does not exist. */
bool tsr_map_code_row(struct tsr_map_model *model, const struct tsr_range_port *port);

#endif
