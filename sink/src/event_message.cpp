/* The body of an EVENT message. SPDX-License-Identifier: Apache-2.0 */
#include "event_message.h"

extern "C" {
#include "tsr/wire/body.h"
}

namespace tsr
{
namespace
{

bool belongs_to(const tsr_body_event &event, const SitePair &pair)
{
    if (event.rule >= pair.zones.size()) {
        return false;
    }
    const bool of_surface = event.kind == TSR_EVENT_MEASURED || event.kind == TSR_EVENT_VANISHED;
    return of_surface == (pair.zones[event.rule].kind == ZoneKind::changed);
}

} // namespace

std::variant<StoredEvents, Cause> read_event_message(std::span<const std::uint8_t> body, const SitePair &pair)
{
    tsr_body_events read{};
    if (tsr_body_read_events(body.data(), body.size(), &read) != TSR_OK) {
        return Cause::body_format;
    }
    StoredEvents stored;
    stored.capture_time_us = read.capture_time_us;
    stored.capture_id = read.capture_id;
    for (const tsr_body_event &event : std::span(read.events, read.count)) {
        if (!belongs_to(event, pair)) {
            return Cause::other_settings;
        }
        stored.events.push_back({event.rule, event.kind, event.share_q12, event.disparity_q8});
    }
    return stored;
}

} // namespace tsr
