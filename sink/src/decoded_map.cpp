/* Whole maps and images out of the resumable codecs. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/decoded_map.h"

#include <memory>
#include <stdexcept>
#include <string>

extern "C" {
#include "tsr/codec/map_restore.h"
#include "tsr/codec/picture.h"
}

namespace tsr
{

std::optional<DecodedMap> decode_map(std::span<const std::uint8_t> coded)
{
    DecodedMap map;
    if (tsr_map_read_info(coded.data(), coded.size(), &map.info) != TSR_OK) {
        return std::nullopt;
    }
    const std::size_t width = map.info.width;
    map.disparity_q4.resize(width * map.info.height);
    std::vector<std::uint16_t> scratch(TSR_MAP_SCRATCH_COUNT(width));
    const auto decoder = std::make_unique<tsr_map_decoder>();
    if (tsr_map_decode_start(decoder.get(), coded.data(), coded.size(), nullptr, scratch.data(), scratch.size(),
                             &map.info) != TSR_OK ||
        tsr_map_decode_rows(decoder.get(), map.disparity_q4.data(), width, map.info.height) != TSR_OK) {
        return std::nullopt;
    }
    return map;
}

std::optional<GrayImage> decode_reference(std::span<const std::uint8_t> coded)
{
    tsr_picture_info info{};
    if (tsr_picture_read_info(coded.data(), coded.size(), &info) != TSR_OK || info.prior != TSR_PICTURE_PRIOR_TRAINED) {
        return std::nullopt;
    }
    const std::size_t width = info.width;
    GrayImage image{info.width, info.height, std::vector<std::uint8_t>(width * info.height)};
    std::vector<std::uint8_t> scratch(TSR_PICTURE_SCRATCH_LEN(width));
    const auto decoder = std::make_unique<tsr_picture_decoder>();
    if (tsr_picture_decode_start(decoder.get(), coded.data(), coded.size(), scratch.data(), scratch.size(), &info) !=
            TSR_OK ||
        tsr_picture_decode_rows(decoder.get(), image.pixels.data(), width, info.height) != TSR_OK) {
        return std::nullopt;
    }
    return image;
}

DecodedMap restored(const DecodedMap &map)
{
    DecodedMap result = map;
    std::vector<std::uint16_t> scratch(TSR_MAP_RESTORE_SCRATCH_COUNT(map.info.width, map.info.height));
    const tsr_status status = tsr_map_restore(&map.info, result.disparity_q4.data(), result.disparity_q4.size(),
                                              scratch.data(), scratch.size());
    if (status != TSR_OK) {
        throw std::invalid_argument(std::string("restored: ") + tsr_status_name(status));
    }
    return result;
}

} // namespace tsr
