/* The body of a MAP message. SPDX-License-Identifier: Apache-2.0 */
#include "map_message.h"

#include <cmath>

extern "C" {
#include "tsr/wire/body.h"
}

namespace tsr
{
namespace
{

/* The header rounds d0 to 1/16 px. */
constexpr double kOffsetErrorMaxQ4 = 1.0;

bool same_settings(const tsr_map_info &info, const SitePair &pair)
{
    return info.width == pair.width && info.height == pair.height && info.disparities == pair.disparities &&
           std::abs(info.d0_q4 - pair.d0_px * TSR_DISPARITY_ONE_Q4) <= kOffsetErrorMaxQ4;
}

} // namespace

std::variant<MapMessage, Cause> read_map_message(std::span<const std::uint8_t> body, const SitePair &pair)
{
    tsr_body_map parts{};
    if (tsr_body_read_map(body.data(), body.size(), &parts) != TSR_OK) {
        return Cause::body_format;
    }
    MapMessage message;
    message.stored.capture_time_us = parts.capture_time_us;
    message.stored.capture_id = parts.capture_id;
    message.stored.coded_map.assign(parts.map, parts.map + parts.map_len);
    auto map = decode_map(message.stored.coded_map);
    if (!map) {
        return Cause::map_format;
    }
    if (!same_settings(map->info, pair)) {
        return Cause::other_settings;
    }
    message.map = std::move(*map);
    if (parts.reference_len > 0) {
        message.stored.coded_reference.assign(parts.reference, parts.reference + parts.reference_len);
        const auto reference = decode_reference(message.stored.coded_reference);
        if (!reference || reference->size() != ImageSize{pair.width, pair.height}) {
            return Cause::reference_format;
        }
    }
    return message;
}

} // namespace tsr
