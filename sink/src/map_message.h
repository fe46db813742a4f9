/*
 * The body of a MAP message, checked against the pair that sent it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_MAP_MESSAGE_H
#define TSR_SINK_MAP_MESSAGE_H

#include <span>
#include <variant>

#include "tsr/host/site.h"
#include "tsr/sink/decoded_map.h"
#include "tsr/sink/store.h"
#include "tsr/sink/tally.h"

namespace tsr
{

struct MapMessage {
    DecodedMap map;
    StoredMap stored; /* node, counter, kept and mse are the caller's */
};

/* Reads and decodes everything; a Cause if any part is wrong. */
std::variant<MapMessage, Cause> read_map_message(std::span<const std::uint8_t> body, const SitePair &pair);

} // namespace tsr

#endif
