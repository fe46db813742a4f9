/*
 * The radios of a medium and what they have on air: private to hal/air.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_PARTS_H
#define TSR_HAL_AIR_PARTS_H

#include <memory>
#include <utility>
#include <vector>

#include "tsr/hal/air.h"

namespace tsr
{

struct Air::Radio {
    Radio(Air &medium, std::size_t index_in_it, EventHandler owner)
        : air(&medium), index(index_in_it), handler(std::move(owner))
    {
    }

    air::Receiver &receiver() const { return air->receivers_[index]; }

    Air *air;
    std::size_t index;
    EventHandler handler;
    std::uint8_t channel = 0;
    std::uint16_t pan_id = 0;
    std::uint16_t address = 0;
    std::uint16_t last_address = 0; /* without power too */
    bool receiving = false;
    bool turning = false;           /* from a clear channel to the transmission: deaf */
    bool sending = false;           /* a PSDU of its own is on air: frame or acknowledgement */
    bool sending_ack = false;       /* it is an acknowledgement */
    bool sent = false;              /* the frame of the transmit() under way has been on air */
    bool busy = false;              /* between transmit() and TX_DONE */
    std::vector<std::uint8_t> psdu; /* of the transmit() under way */
    std::uint64_t attempt = 0;      /* counts transmit() calls */
    std::uint64_t life = 0;         /* counts losses of power: what an earlier life has begun does not go on */
    bool powered = true;
    std::shared_ptr<Transmission> on_air; /* while sending */
    mutable AirTimes times;
    mutable std::uint64_t accounted_us = 0;
};

struct Arrival {
    int level_q4;          /* dBm */
    air::LossCause missed; /* at its begin; none: followed */
};

struct Air::Transmission {
    std::uint64_t number = 0;
    std::size_t sender = 0;
    std::uint8_t channel = 0;
    std::uint64_t start_us = 0;
    std::uint64_t end_us = 0;
    std::vector<std::uint8_t> psdu;
    Radio *acknowledges = nullptr;  /* an acknowledgement's addressee */
    std::uint64_t asker_life = 0;   /* in which life the addressee asked for it */
    std::uint64_t frame_end_us = 0; /* of the frame it acknowledges */
    bool cut = false;               /* its sender lost its power */
    bool faded = false;             /* nobody hears it any more, though its end may still be to come at this instant */
    std::vector<Arrival> arrivals;  /* at each of the sender's neighbours, in their order */
    air::Outcome broken;            /* of the receiver that followed it and has it wrong */
};

inline air::LossCause Air::cause_of_miss(const Radio &radio, air::Reception reception)
{
    using air::LossCause;
    using air::Reception;
    switch (reception) {
    case Reception::followed: return LossCause::none;
    case Reception::other_channel: return LossCause::not_listening;
    case Reception::deaf: return radio.sending || radio.turning ? LossCause::half_duplex : LossCause::not_listening;
    case Reception::weak: return LossCause::noise;
    case Reception::busy: return LossCause::receiver_busy;
    case Reception::hidden: return LossCause::collision;
    }
    return LossCause::none;
}

namespace air
{

inline constexpr std::uint16_t kBroadcast = 0xffff;
inline constexpr std::size_t kAddressedLen = 9;   /* up to the source address: shorter ones are for nobody */
inline constexpr std::uint8_t kAckRequest = 0x20; /* frame control field, IEEE 802.15.4-2015, 7.2.2.1 */

/* Of frames of at least kAddressedLen octets. */
inline unsigned pan_of(const std::vector<std::uint8_t> &psdu)
{
    return psdu[3] | psdu[4] << 8;
}

inline unsigned destination_of(const std::vector<std::uint8_t> &psdu)
{
    return psdu[5] | psdu[6] << 8;
}

} // namespace air

} // namespace tsr

#endif
