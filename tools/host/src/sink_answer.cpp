/* STATUS and ANSWER. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/sink_answer.h"

#include <array>
#include <stdexcept>

extern "C" {
#include "tsr/wire/address.h"
}

namespace tsr
{

std::vector<std::uint8_t> answer_frame(std::uint16_t sequence, const std::vector<std::uint8_t> &fragment)
{
    std::vector<std::uint8_t> body;
    if (!fragment.empty()) {
        body.push_back(static_cast<std::uint8_t>(fragment.size()));
        body.insert(body.end(), fragment.begin(), fragment.end());
    }
    const tsr_link_frame frame{TSR_LINK_ANSWER, sequence, body.data(), body.size()};
    std::vector<std::uint8_t> bytes(TSR_LINK_FRAME_MAX);
    std::size_t len = 0;
    if (tsr_link_encode(&frame, bytes.data(), bytes.size(), &len) != TSR_OK) {
        throw std::logic_error("answer_frame: an ANSWER does not fit its frame");
    }
    bytes.resize(len);
    return bytes;
}

std::vector<std::uint8_t> status_fragment(const tsr_cipher &cipher, std::uint16_t node, std::uint32_t counter,
                                          const tsr_body_status &status)
{
    std::array<std::uint8_t, TSR_BODY_STATUS_MAX + TSR_MESSAGE_OVERHEAD_LEN> message{};
    std::size_t body_len = 0;
    std::size_t message_len = 0;
    const tsr_message_header header{TSR_MESSAGE_STATUS, TSR_KEY_NODE, TSR_ADDRESS_SINK, node, counter};
    if (tsr_body_write_status(&status, message.data() + TSR_MESSAGE_HEADER_LEN, TSR_BODY_STATUS_MAX, &body_len) !=
            TSR_OK ||
        tsr_message_seal(&header, &cipher, message.data(), message.size(), body_len, &message_len) != TSR_OK) {
        throw std::logic_error("status_fragment: a STATUS does not fit its message");
    }
    tsr_fragment fragment = tsr_fragment_of(message.data(), message_len, 0);
    fragment.origin = TSR_ADDRESS_SINK;
    fragment.destination = node;
    fragment.message_id = static_cast<std::uint16_t>(counter);
    std::vector<std::uint8_t> bytes(TSR_FRAME_PAYLOAD_MAX);
    std::size_t len = 0;
    if (tsr_fragment_write(&fragment, bytes.data(), bytes.size(), &len) != TSR_OK) {
        throw std::logic_error("status_fragment: a STATUS does not fit one fragment");
    }
    bytes.resize(len);
    return bytes;
}

} // namespace tsr
