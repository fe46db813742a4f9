/*
 * What travels, as one who holds all keys sees it: the frames of each link by
 * the kind of message they carry, and when the sink committed which message.
 *
 * A frame on air is opened with the link key: the fragment in it names origin,
 * destination and message, and a message's first fragment its kind. An answer
 * of the sink is opened with the node's key. Nothing is kept but sums, one
 * record for a link that was used and one for a message that was committed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_TRAFFIC_H
#define TSR_EMULATOR_TRAFFIC_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

extern "C" {
#include "tsr/wire/fragment.h"
#include "tsr/wire/message.h"
}
#include "tsr/hal/air.h"
#include "tsr/host/keys.h"
#include "tsr/host/site.h"

namespace tsr
{

/* A kind of message with its name in reports. A kind that is added to the wire is added here; until then it counts
 * as "other", the last. */
struct MessageName {
    std::uint8_t kind; /* enum tsr_message_kind; 0: any other */
    const char *name;
};
inline constexpr std::array<MessageName, 6> kMessageNames = {{{TSR_MESSAGE_WAKE, "wake"},
                                                              {TSR_MESSAGE_VIEW, "view"},
                                                              {TSR_MESSAGE_MAP, "map"},
                                                              {TSR_MESSAGE_STATUS, "status"},
                                                              {TSR_MESSAGE_EVENT, "event"},
                                                              {0, "other"}}};
/* Place of a kind in kMessageNames. */
std::size_t message_index(std::uint8_t kind);

struct FrameTally {
    std::uint64_t frames = 0; /* repetitions included */
    std::uint64_t bytes = 0;  /* PSDU octets */
};

/* One direction of a link. */
struct LinkTally {
    std::array<FrameTally, kMessageNames.size()> kinds{}; /* data frames, as kMessageNames */
    std::uint64_t received = 0;                           /* of these, got by the node they are for */
    std::uint64_t received_bytes = 0;                     /* PSDU octets of them */
    std::uint64_t acknowledged = 0;                       /* of these, the sender heard the acknowledgement */
    FrameTally acknowledgements;                          /* sent for them, the other way */
    air::LossTally lost{};                                /* data frames that were not received */

    FrameTally data() const; /* sum over kinds */
};

/* The sink has a message on disk. */
struct Commit {
    std::uint64_t time_us = 0; /* its answer is at the gateway */
    std::uint16_t node = kNodeNone;
    std::uint16_t message_id = 0; /* low half of the message's counter */
    std::uint8_t kind = 0;        /* place in kMessageNames */
};

class Traffic
{
  public:
    using Links = std::map<std::pair<std::uint16_t, std::uint16_t>, LinkTally>; /* by sender and receiver */

    Traffic(const Site &site, const KeyRing &keys);

    /* A PSDU that was on air. sender and receiver: whose radios they are; receiver of an acknowledgement alone. */
    void count(const AirFrame &frame, std::uint16_t sender, std::uint16_t receiver);
    /* The sink's answer to the gateway, as bytes of the link. */
    void hear_sink(std::uint64_t time_us, const std::vector<std::uint8_t> &answer);

    const Links &links() const { return links_; }
    /* Each message once, in order of time. */
    const std::vector<Commit> &commits() const { return commits_; }

  private:
    /* The last messages between two ends: fragments of an older one may still be on their way. */
    struct Messages {
        std::array<std::pair<std::uint16_t, std::uint8_t>, 4> latest{}; /* message id, place in kMessageNames */
        std::size_t seen = 0;                                           /* entries written, the oldest over and over */
    };

    static constexpr std::size_t kCommitsRemembered = 8; /* a node has two messages under way at most */

    std::size_t kind_of(const tsr_fragment &fragment);
    std::size_t known_kind(std::uint16_t origin, std::uint16_t destination, std::uint16_t message_id) const;
    void read_status(std::uint64_t time_us, const std::uint8_t *bytes, std::size_t len);

    tsr_cipher link_cipher_{};
    std::map<std::uint16_t, tsr_cipher> node_ciphers_;
    std::map<std::pair<std::uint16_t, std::uint16_t>, Messages> messages_; /* by origin and destination */
    std::map<std::uint16_t, std::deque<std::uint16_t>> committed_;         /* the last message ids of each node */
    Links links_;
    std::vector<Commit> commits_;
};

} // namespace tsr

#endif
