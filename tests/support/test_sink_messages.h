/*
 * What nodes send, made here: coded maps and images, sealed messages, fragments.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_SINK_MESSAGES_H
#define TSR_TEST_SINK_MESSAGES_H

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "tsr/host/aes.h"
#include "tsr/host/keys.h"
#include "tsr/host/site.h"
#include "tsr/sink/decoded_map.h"

extern "C" {
#include "tsr/codec/map.h"
#include "tsr/codec/picture.h"
#include "tsr/wire/body.h"
#include "tsr/wire/link.h"
}

namespace tsr::test
{

using Bytes = std::vector<std::uint8_t>;

inline void require_ok(tsr_status status)
{
    if (status != TSR_OK) {
        throw std::runtime_error(tsr_status_name(status));
    }
}

/* A map of pair's shape whose every pixel is disparity_q4 (a multiple of 4). */
inline DecodedMap flat_map(const SitePair &pair, std::uint16_t disparity_q4)
{
    DecodedMap map;
    map.info.width = static_cast<std::uint16_t>(pair.width);
    map.info.height = static_cast<std::uint16_t>(pair.height);
    map.info.disparities = static_cast<std::uint16_t>(pair.disparities);
    map.info.step_log2 = 2;
    map.info.d0_q4 = static_cast<std::int16_t>(std::lround(16 * pair.d0_px));
    map.disparity_q4.assign(static_cast<std::size_t>(pair.width) * static_cast<std::size_t>(pair.height), disparity_q4);
    return map;
}

inline Bytes code_map(const DecodedMap &map)
{
    Bytes bytes(tsr_map_encoded_len_max(&map.info));
    std::vector<std::uint16_t> scratch(TSR_MAP_SCRATCH_COUNT(map.info.width));
    const auto encoder = std::make_unique<tsr_map_encoder>();
    std::size_t len = 0;
    require_ok(
        tsr_map_encode_start(encoder.get(), &map.info, bytes.data(), bytes.size(), scratch.data(), scratch.size()));
    require_ok(tsr_map_encode_rows(encoder.get(), map.disparity_q4.data(), map.info.width, map.info.height));
    require_ok(tsr_map_encode_finish(encoder.get(), &len));
    bytes.resize(len);
    return bytes;
}

/* As finely as pictures are coded, as nodes send them. */
inline Bytes code_reference(const GrayImage &image, std::uint8_t prior = TSR_PICTURE_PRIOR_TRAINED)
{
    const tsr_picture_info info{static_cast<std::uint16_t>(image.width), static_cast<std::uint16_t>(image.height), 0,
                                prior};
    Bytes bytes(tsr_picture_encoded_len_max(&info));
    Bytes scratch(TSR_PICTURE_SCRATCH_LEN(info.width));
    const auto encoder = std::make_unique<tsr_picture_encoder>();
    std::size_t len = 0;
    require_ok(
        tsr_picture_encode_start(encoder.get(), &info, 0, bytes.data(), bytes.size(), scratch.data(), scratch.size()));
    require_ok(tsr_picture_encode_rows(encoder.get(), image.pixels.data(), info.width, info.height));
    require_ok(tsr_picture_encode_finish(encoder.get(), &len));
    bytes.resize(len);
    return bytes;
}

/* A picture that codes to several fragments. */
inline GrayImage textured_image(const SitePair &pair)
{
    GrayImage image{pair.width, pair.height, {}};
    for (int i = 0; i < pair.width * pair.height; i++) {
        image.pixels.push_back(static_cast<std::uint8_t>(i * i * 31 % 251));
    }
    return image;
}

inline Bytes map_body(const Bytes &coded_map, const Bytes &coded_reference, std::uint64_t capture_time_us = 1000)
{
    Bytes body(TSR_BODY_MAP_HEADER_LEN);
    tsr_body_write_map_header(capture_time_us, 7, coded_reference.size(), body.data());
    body.insert(body.end(), coded_reference.begin(), coded_reference.end());
    body.insert(body.end(), coded_map.begin(), coded_map.end());
    return body;
}

inline tsr_cipher cipher_of(const Key &key)
{
    tsr_cipher cipher{};
    require_ok(tsr_cipher_init(&cipher, &mbedtls_aes_ops(), key.data()));
    return cipher;
}

inline Bytes seal(const tsr_message_header &header, const Key &key, const Bytes &body)
{
    const tsr_cipher cipher = cipher_of(key);
    Bytes message(body.size() + TSR_MESSAGE_OVERHEAD_LEN);
    std::copy(body.begin(), body.end(), message.begin() + TSR_MESSAGE_HEADER_LEN);
    std::size_t len = 0;
    require_ok(tsr_message_seal(&header, &cipher, message.data(), message.size(), body.size(), &len));
    message.resize(len);
    return message;
}

/* The fragments of a message; the last one polls. */
inline std::vector<Bytes> fragments_of(const Bytes &message, std::uint16_t origin, std::uint16_t message_id,
                                       std::uint16_t destination = 0)
{
    std::vector<Bytes> result;
    const std::uint16_t count = tsr_fragment_count(message.size());
    for (std::uint16_t i = 0; i < count; i++) {
        tsr_fragment fragment = tsr_fragment_of(message.data(), message.size(), i);
        fragment.origin = origin;
        fragment.destination = destination;
        fragment.message_id = message_id;
        fragment.poll = i + 1 == count;
        Bytes bytes(TSR_FRAME_PAYLOAD_MAX);
        std::size_t len = 0;
        require_ok(tsr_fragment_write(&fragment, bytes.data(), bytes.size(), &len));
        bytes.resize(len);
        result.push_back(bytes);
    }
    return result;
}

inline Bytes event_body(const std::vector<tsr_body_event> &events, std::uint64_t capture_time_us = 1000)
{
    tsr_body_events body{};
    body.capture_time_us = capture_time_us;
    body.capture_id = 7;
    body.count = static_cast<std::uint8_t>(events.size());
    std::copy(events.begin(), events.end(), body.events);
    Bytes bytes(TSR_FRAGMENT_PIECE_MAX - TSR_MESSAGE_OVERHEAD_LEN);
    std::size_t len = 0;
    require_ok(tsr_body_write_events(&body, bytes.data(), bytes.size(), &len));
    bytes.resize(len);
    return bytes;
}

/* An EVENT message from node: one fragment. */
inline std::vector<Bytes> event_fragments(const KeyRing &keys, std::uint16_t node, std::uint32_t counter,
                                          const Bytes &body)
{
    const tsr_message_header header{TSR_MESSAGE_EVENT, TSR_KEY_NODE, node, 0, counter};
    return fragments_of(seal(header, *keys.node_key(node), body), node, static_cast<std::uint16_t>(counter));
}

/* A MAP message from node, whole. */
inline std::vector<Bytes> map_fragments(const KeyRing &keys, std::uint16_t node, std::uint32_t counter,
                                        const Bytes &body)
{
    const tsr_message_header header{TSR_MESSAGE_MAP, TSR_KEY_NODE, node, 0, counter};
    return fragments_of(seal(header, *keys.node_key(node), body), node, static_cast<std::uint16_t>(counter));
}

/* The STATUS in a fragment that the sink sent down to node. */
inline tsr_body_status open_status(const KeyRing &keys, std::uint16_t node, const Bytes &bytes,
                                   std::uint32_t *counter = nullptr)
{
    tsr_fragment fragment{};
    require_ok(tsr_fragment_read(bytes.data(), bytes.size(), &fragment));
    if (fragment.destination != node || fragment.origin != 0 || fragment.count != 1) {
        throw std::runtime_error("not a STATUS to this node");
    }
    Bytes message(fragment.piece, fragment.piece + fragment.piece_len);
    tsr_message_header header{};
    require_ok(tsr_message_parse(message.data(), message.size(), 0, node, &header));
    const tsr_cipher cipher = cipher_of(*keys.node_key(node));
    std::size_t body_len = 0;
    require_ok(tsr_message_open(&header, &cipher, message.data(), message.size(), &body_len));
    tsr_body_status status{};
    require_ok(tsr_body_read_status(message.data() + TSR_MESSAGE_HEADER_LEN, body_len, &status));
    if (counter != nullptr) {
        *counter = header.counter;
    }
    return status;
}

} // namespace tsr::test

#endif
