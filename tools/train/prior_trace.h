/*
 * What the contexts of a codec are asked, recorded while it codes. The codec's sources are compiled with
 * tsr_range_encode_bit renamed to prior_trace_bit (tools/train/prior_training.py).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TRAIN_PRIOR_TRACE_H
#define TSR_TRAIN_PRIOR_TRACE_H

#include "tsr/codec/range.h"

/* Begin a stream: contexts are the coder's, trace[trace_cap], kept, gets 2 * context + bit for each bit asked. What has
 * no room there is not recorded. */
void prior_trace_start(const struct tsr_range_bit *contexts, uint32_t *trace, size_t trace_cap);

/* Bits recorded since. */
size_t prior_trace_count(void);

#endif
