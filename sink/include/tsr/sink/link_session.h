/*
 * The sink's side of the gateway link (tsr/wire/link.h) on bytes, without
 * descriptors: bytes of several connections in, ANSWER frames out.
 *
 * Each HELLO and UPLINK gets exactly one ANSWER with its sequence. An UPLINK
 * that comes again (same sequence, same bytes), also over a new connection of
 * the same gateway, gets the same answer again and changes nothing.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_LINK_SESSION_H
#define TSR_SINK_LINK_SESSION_H

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "tsr/sink/receiver.h"

extern "C" {
#include "tsr/wire/link.h"
}

namespace tsr
{

struct LinkCounts {
    std::uint64_t bytes_in = 0;
    std::uint64_t bytes_out = 0;
    std::uint64_t hellos = 0;
    std::uint64_t uplinks = 0;
    std::uint64_t repeated_uplinks = 0;
};

/* One connection's state; kept by its owner between batches. */
class LinkSession
{
  public:
    LinkSession() { tsr_link_decoder_init(&decoder_); }
    /* Whether one good frame has come: a gateway says HELLO at once. */
    bool has_spoken() const { return decoder_.frames > 0; }
    /* Bytes waiting to be written to this connection. */
    std::vector<std::uint8_t> &outgoing() { return outgoing_; }

  private:
    friend class LinkServer;
    struct LastAnswer {
        std::uint16_t sequence = 0;
        std::vector<std::uint8_t> uplink; /* empty: none yet */
        std::vector<std::uint8_t> answer;
    };

    tsr_link_decoder decoder_{};
    bool refused_ = false;
    std::shared_ptr<LastAnswer> last_ = std::make_shared<LastAnswer>();
    std::vector<std::uint8_t> outgoing_;
};

class LinkServer
{
  public:
    /* receiver is kept. pan_id is the site's. */
    LinkServer(Receiver &receiver, std::uint16_t pan_id) : receiver_(receiver), pan_id_(pan_id) {}

    struct Input {
        LinkSession *session;
        std::vector<std::uint8_t> bytes;
    };
    /* Bytes that arrived together are answered together, after one commit. */
    void process(std::span<const Input> inputs);
    const LinkCounts &counts() const { return counts_; }

  private:
    struct Request { /* an UPLINK to be answered */
        LinkSession *session;
        std::uint16_t sequence;
        std::vector<std::uint8_t> body;
    };

    void take_frame(LinkSession &session, const tsr_link_frame &frame, std::vector<Request> &requests);
    void hello(LinkSession &session, const tsr_link_frame &frame);
    void answer_all(std::vector<Request> &requests);
    void send(LinkSession &session, std::span<const std::uint8_t> frame);

    Receiver &receiver_;
    std::uint16_t pan_id_;
    std::map<std::uint16_t, std::shared_ptr<LinkSession::LastAnswer>> last_answers_; /* by gateway */
    LinkCounts counts_;
};

} // namespace tsr

#endif
