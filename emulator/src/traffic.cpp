/*
 * Frames by link and kind, commits of the sink.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/traffic.h"

#include <algorithm>
#include <cstring>

extern "C" {
#include "tsr/wire/address.h"
#include "tsr/wire/body.h"
#include "tsr/wire/frame.h"
#include "tsr/wire/link.h"
}
#include "tsr/host/aes.h"
#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr std::size_t kOther = kMessageNames.size() - 1;

tsr_cipher cipher_of(const Key &key)
{
    tsr_cipher cipher{};
    const tsr_status status = tsr_cipher_init(&cipher, &mbedtls_aes_ops(), key.data());
    if (status != TSR_OK) {
        throw InputError("keys", "cipher", tsr_status_name(status));
    }
    return cipher;
}

} // namespace

std::size_t message_index(std::uint8_t kind)
{
    const auto *found = std::find_if(kMessageNames.begin(), kMessageNames.end(),
                                     [kind](const MessageName &name) { return name.kind == kind; });
    return found == kMessageNames.end() ? kOther : static_cast<std::size_t>(found - kMessageNames.begin());
}

FrameTally LinkTally::data() const
{
    FrameTally sum;
    for (const FrameTally &kind : kinds) {
        sum.frames += kind.frames;
        sum.bytes += kind.bytes;
    }
    return sum;
}

Traffic::Traffic(const Site &site, const KeyRing &keys) : link_cipher_(cipher_of(keys.link_key))
{
    for (const SiteNode &node : site.nodes) {
        if (const auto key = keys.node_key(node.id)) {
            node_ciphers_.emplace(node.id, cipher_of(*key));
        }
    }
}

/* The kind stands in the first fragment; the others know it by their message. */
std::size_t Traffic::kind_of(const tsr_fragment &fragment)
{
    if (fragment.index > 0) {
        return known_kind(fragment.origin, fragment.destination, fragment.message_id);
    }
    const std::size_t kind = message_index(fragment.piece_len > 0 ? fragment.piece[0] : std::uint8_t{0});
    Messages &messages = messages_[{fragment.origin, fragment.destination}];
    const std::pair<std::uint16_t, std::uint8_t> entry{fragment.message_id, static_cast<std::uint8_t>(kind)};
    const auto end = messages.latest.begin() + std::min(messages.seen, messages.latest.size());
    if (std::find(messages.latest.begin(), end, entry) == end) {
        messages.latest[messages.seen++ % messages.latest.size()] = entry;
    }
    return kind;
}

std::size_t Traffic::known_kind(std::uint16_t origin, std::uint16_t destination, std::uint16_t message_id) const
{
    const auto messages = messages_.find({origin, destination});
    if (messages == messages_.end()) {
        return kOther;
    }
    const auto &latest = messages->second.latest;
    const auto end = latest.begin() + std::min(messages->second.seen, latest.size());
    const auto found = std::find_if(latest.begin(), end, [&](const auto &entry) { return entry.first == message_id; });
    return found == end ? kOther : found->second;
}

void Traffic::count(const AirFrame &frame, std::uint16_t sender, std::uint16_t receiver)
{
    if (frame.acknowledged != AirFrame::kNobody) {
        LinkTally &link = links_[{receiver, sender}];
        ++link.acknowledgements.frames;
        link.acknowledgements.bytes += frame.psdu_len;
        link.acknowledged += frame.lost_at == 0 ? 1 : 0;
        return;
    }
    tsr_frame_header header{};
    std::array<std::uint8_t, TSR_FRAME_PAYLOAD_MAX> payload{};
    std::size_t payload_len = 0;
    tsr_fragment fragment{};
    if (tsr_frame_parse(frame.psdu, frame.psdu_len, &header) != TSR_OK) {
        return;
    }
    const bool readable = tsr_frame_open(frame.psdu, frame.psdu_len, &link_cipher_, payload.data(), payload.size(),
                                         &payload_len) == TSR_OK &&
                          tsr_fragment_read(payload.data(), payload_len, &fragment) == TSR_OK;
    LinkTally &link = links_[{sender, header.destination}];
    FrameTally &kind = link.kinds.at(readable ? kind_of(fragment) : kOther);
    ++kind.frames;
    kind.bytes += frame.psdu_len;
    link.received += frame.lost_at == 0 ? 1 : 0;
    link.received_bytes += frame.lost_at == 0 ? frame.psdu_len : 0;
    link.lost.at(static_cast<std::size_t>(frame.cause)) += frame.lost_at;
}

void Traffic::hear_sink(std::uint64_t time_us, const std::vector<std::uint8_t> &answer)
{
    tsr_link_decoder decoder;
    tsr_link_decoder_init(&decoder);
    tsr_link_frame frame{};
    for (const std::uint8_t byte : answer) {
        if (tsr_link_decode(&decoder, byte, &frame) != TSR_OK || frame.type != TSR_LINK_ANSWER) {
            continue;
        }
        for (std::size_t at = 0; at < frame.body_len && at + frame.body[at] < frame.body_len;
             at += 1u + frame.body[at]) {
            read_status(time_us, frame.body + at + 1, frame.body[at]);
        }
    }
}

void Traffic::read_status(std::uint64_t time_us, const std::uint8_t *bytes, std::size_t len)
{
    tsr_fragment fragment{};
    tsr_message_header header{};
    tsr_body_status status{};
    if (tsr_fragment_read(bytes, len, &fragment) != TSR_OK) {
        return;
    }
    const auto cipher = node_ciphers_.find(fragment.destination);
    std::array<std::uint8_t, TSR_FRAGMENT_PIECE_MAX> message{};
    std::size_t body_len = 0;
    std::memcpy(message.data(), fragment.piece, fragment.piece_len);
    if (cipher == node_ciphers_.end() ||
        tsr_message_parse(message.data(), fragment.piece_len, fragment.origin, fragment.destination, &header) !=
            TSR_OK ||
        header.kind != TSR_MESSAGE_STATUS ||
        tsr_message_open(&header, &cipher->second, message.data(), fragment.piece_len, &body_len) != TSR_OK ||
        tsr_body_read_status(message.data() + TSR_MESSAGE_HEADER_LEN, body_len, &status) != TSR_OK ||
        status.state != TSR_DELIVERY_COMMITTED) {
        return;
    }
    /* A poll that was repeated is answered again, perhaps after another message's. */
    std::deque<std::uint16_t> &latest = committed_[fragment.destination];
    if (std::find(latest.begin(), latest.end(), status.message_id) != latest.end()) {
        return;
    }
    latest.push_back(status.message_id);
    if (latest.size() > kCommitsRemembered) {
        latest.pop_front();
    }
    const std::size_t kind = known_kind(fragment.destination, TSR_ADDRESS_SINK, status.message_id);
    commits_.push_back({time_us, fragment.destination, status.message_id, static_cast<std::uint8_t>(kind)});
}

} // namespace tsr
