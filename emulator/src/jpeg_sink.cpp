/* The sink of baseline nodes. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/jpeg_sink.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "tsr/host/aes.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/sink_answer.h"

extern "C" {
#include "tsr/wire/address.h"
}

namespace tsr
{

namespace
{

constexpr std::size_t kFinishedMax = 16; /* messages a node may still be asking about */

std::string name_of(const tsr_message_header &header)
{
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%05u-%010u", unsigned{header.origin}, header.counter);
    return name.data();
}

} // namespace

JpegSink::JpegSink(const KeyRing &keys, std::filesystem::path folder) : folder_(std::move(folder))
{
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
        throw InputError(folder_.string(), "create", error.message());
    }
    tsr_link_decoder_init(&decoder_);
    for (const auto &[node, key] : keys.node_keys) {
        if (tsr_cipher_init(&origins_[node].cipher, &mbedtls_aes_ops(), key.data()) != TSR_OK) {
            throw std::runtime_error("Mbed TLS cannot expand a key");
        }
    }
}

std::vector<std::uint8_t> JpegSink::exchange(const std::uint8_t *frame, std::size_t len)
{
    for (std::size_t i = 0; i < len; ++i) {
        tsr_link_frame request{};
        if (tsr_link_decode(&decoder_, frame[i], &request) != TSR_OK) {
            continue;
        }
        if (request.type != TSR_LINK_UPLINK || request.body_len < TSR_LINK_UPLINK_HEADER_LEN) {
            return answer_frame(request.sequence, {});
        }
        return answer_frame(request.sequence, take_fragment(request.body + TSR_LINK_UPLINK_HEADER_LEN,
                                                            request.body_len - TSR_LINK_UPLINK_HEADER_LEN));
    }
    return {};
}

/* What was acknowledged is in files; what was being put together is not. */
void JpegSink::restart()
{
    ++restarts_;
    tsr_link_decoder_init(&decoder_);
    for (auto &[node, origin] : origins_) {
        origin.assembly.count = 0;
    }
}

/* The fragment to send down, or nothing. */
std::vector<std::uint8_t> JpegSink::take_fragment(const std::uint8_t *bytes, std::size_t len)
{
    tsr_fragment fragment{};
    if (tsr_fragment_read(bytes, len, &fragment) != TSR_OK || fragment.destination != TSR_ADDRESS_SINK) {
        return {};
    }
    const auto found = origins_.find(fragment.origin);
    if (found == origins_.end()) {
        return {};
    }
    const auto status = judge(found->second, fragment);
    return status ? status_fragment(found->second.cipher, fragment.origin, ++counter_, *status)
                  : std::vector<std::uint8_t>();
}

/* The answer to a poll, or to the fragment that completes a message; nothing to any other. */
std::optional<tsr_body_status> JpegSink::judge(Origin &origin, const tsr_fragment &fragment)
{
    tsr_body_status status{};
    status.message_id = fragment.message_id;
    const auto finished = std::find_if(origin.finished.begin(), origin.finished.end(),
                                       [&](const auto &entry) { return entry.first == fragment.message_id; });
    if (finished != origin.finished.end()) {
        status.state = static_cast<std::uint8_t>(finished->second);
        return fragment.poll ? std::optional(status) : std::nullopt;
    }
    if (!tsr_reassembly_matches(&origin.assembly, &fragment)) {
        origin.message.assign(std::size_t{fragment.count} * TSR_FRAGMENT_PIECE_MAX, 0);
        tsr_reassembly_init(&origin.assembly, origin.message.data(), origin.message.size());
        tsr_reassembly_begin(&origin.assembly, &fragment);
    }
    const tsr_status added = tsr_reassembly_add(&origin.assembly, &fragment);
    if (added == TSR_OK) {
        const tsr_delivery state = finish(origin, fragment);
        if (state != TSR_DELIVERY_MISSING) {
            status.state = static_cast<std::uint8_t>(state);
            return status;
        }
    } else if (added != TSR_AGAIN || !fragment.poll) {
        return std::nullopt;
    }
    return tsr_body_status_of(&origin.assembly, TSR_DELIVERY_COMMITTED);
}

/* Of a whole message. MISSING: it is not authentic, and is asked for from the start. */
tsr_delivery JpegSink::finish(Origin &origin, const tsr_fragment &fragment)
{
    const tsr_reassembly &whole = origin.assembly;
    tsr_message_header header{};
    std::size_t body_len = 0;
    if (tsr_message_parse(whole.message, whole.message_len, whole.origin, whole.destination, &header) != TSR_OK ||
        tsr_message_open(&header, &origin.cipher, whole.message, whole.message_len, &body_len) != TSR_OK) {
        tsr_reassembly_begin(&origin.assembly, &fragment);
        return TSR_DELIVERY_MISSING;
    }
    const tsr_delivery state = keep(header, {whole.message + TSR_MESSAGE_HEADER_LEN, body_len});
    origin.finished.emplace_back(fragment.message_id, state);
    if (origin.finished.size() > kFinishedMax) {
        origin.finished.pop_front();
    }
    origin.assembly.count = 0;
    return state;
}

tsr_delivery JpegSink::keep(const tsr_message_header &header, std::span<const std::uint8_t> body)
{
    tsr_body_map parts{};
    if (header.kind != TSR_MESSAGE_MAP || tsr_body_read_map(body.data(), body.size(), &parts) != TSR_OK) {
        return TSR_DELIVERY_REFUSED;
    }
    const std::span left(parts.reference, parts.reference_len);
    const std::span right(parts.map, parts.map_len);
    const std::string name = name_of(header);
    const bool reused =
        std::any_of(received_.begin(), received_.end(), [&](const Received &earlier) { return earlier.name == name; });
    if (reused) { /* by a node that has forgotten its counters: tarsier-sink refuses that too */
        return TSR_DELIVERY_REFUSED;
    }
    try {
        decode_gray_image(left, name + "-left.jpg");
        decode_gray_image(right, name + "-right.jpg");
    } catch (const InputError &) {
        return TSR_DELIVERY_REFUSED;
    }
    write_file_atomically(folder_ / (name + "-left.jpg"), left);
    write_file_atomically(folder_ / (name + "-right.jpg"), right);
    received_.push_back({header.origin, header.counter, parts.capture_time_us, left.size(), right.size(), name});
    return TSR_DELIVERY_COMMITTED;
}

} // namespace tsr
