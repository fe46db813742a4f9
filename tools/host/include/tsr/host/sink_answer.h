/*
 * What a sink answers, as bytes: the STATUS of a message in its fragment, the
 * fragment in an ANSWER of the gateway link.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_SINK_ANSWER_H
#define TSR_HOST_SINK_ANSWER_H

#include <cstdint>
#include <vector>

extern "C" {
#include "tsr/wire/body.h"
#include "tsr/wire/link.h"
}

namespace tsr
{

/* An encoded ANSWER to the request of this sequence; fragment may be empty: nothing to send down. */
std::vector<std::uint8_t> answer_frame(std::uint16_t sequence, const std::vector<std::uint8_t> &fragment);

/* The fragment for node, sealed under the key it shares with the sink. counter: used by no other message of the sink
 * to that node. */
std::vector<std::uint8_t> status_fragment(const tsr_cipher &cipher, std::uint16_t node, std::uint32_t counter,
                                          const tsr_body_status &status);

} // namespace tsr

#endif
