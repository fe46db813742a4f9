/*
 * A coded map and its coded reference image, decoded whole.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_DECODED_MAP_H
#define TSR_SINK_DECODED_MAP_H

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tsr/host/image_file.h"

extern "C" {
#include "tsr/codec/map.h"
}

namespace tsr
{

struct DecodedMap {
    tsr_map_info info{};
    std::vector<std::uint16_t> disparity_q4; /* width * height, px, UQ12.4 or TSR_DISPARITY_INVALID */
};

/* Nothing if the bytes are no coded map or picture of a version this build knows. Any bytes are safe. */
std::optional<DecodedMap> decode_map(std::span<const std::uint8_t> coded);

/* Only pictures with the trained prior are reference images; an image of tsr/codec/gray.h never passes for one. */
std::optional<GrayImage> decode_reference(std::span<const std::uint8_t> coded);

/*
 * What is known of the disparities that map was rounded from (tsr/codec/map_restore.h): for geometry and pictures. What
 * is stored, and compared with other maps, stays as it was sent. Throws std::invalid_argument for what decode_map
 * does not give.
 */
DecodedMap restored(const DecodedMap &map);

} // namespace tsr

#endif
