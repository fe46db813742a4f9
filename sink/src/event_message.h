/*
 * The body of an EVENT message, checked against the zones of the pair that sent it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_EVENT_MESSAGE_H
#define TSR_SINK_EVENT_MESSAGE_H

#include <cstdint>
#include <span>
#include <variant>

#include "tsr/host/site.h"
#include "tsr/sink/store.h"
#include "tsr/sink/tally.h"

namespace tsr
{

/* Node and counter are the caller's. A Cause if any part is wrong. */
std::variant<StoredEvents, Cause> read_event_message(std::span<const std::uint8_t> body, const SitePair &pair);

} // namespace tsr

#endif
