/*
 * Where the packets' encoders keep their contexts, for tools/train/packet_prior.py.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "prior_trace.h"
#include "tsr/codec/gray_packet.h"
#include "tsr/codec/view_packet.h"

const struct tsr_range_bit *prior_trace_gray_contexts(const struct tsr_gray_packet_encoder *packets)
{
    return packets->state.model.contexts;
}

const struct tsr_range_bit *prior_trace_view_contexts(const struct tsr_view_packet_encoder *packets)
{
    return packets->state.model.contexts;
}
