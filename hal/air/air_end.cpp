/*
 * The end of a frame on air: who got it, who acknowledges, what the sender learns.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "air_parts.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "tsr/hal/air/chance.h"
#include "tsr/hal/air/decibel.h"

namespace tsr
{

/* UQ0.32. */
std::uint64_t Air::draw_of(const Transmission &transmission, std::size_t receiver) const
{
    return air::mix(air::mix(seed_ + transmission.number) + receiver) >> 32;
}

bool Air::chance_keeps(const Transmission &transmission, std::size_t receiver, std::uint64_t success_q32) const
{
    const std::uint64_t kept_q32 = air::both_q32(kept_q32_, losses_.kept_q32(transmission.sender, receiver));
    return draw_of(transmission, receiver) < air::both_q32(success_q32, kept_q32);
}

void Air::deliver(const Receipt &receipt, const Transmission &transmission)
{
    tsr_radio_event event{};
    event.kind = TSR_RADIO_RECEIVED;
    event.time_us = transmission.end_us;
    event.received.psdu = transmission.psdu.data();
    event.received.psdu_len = static_cast<std::uint8_t>(transmission.psdu.size());
    event.received.rssi_dbm = static_cast<std::int8_t>(std::clamp(air::to_dbm(receipt.level_q4), -128, 127));
    receipt.radio->handler(event);
}

void Air::end(Transmission &transmission)
{
    Radio &sender = *radios_[transmission.sender];
    account(sender);
    sender.sending = false;
    sender.sending_ack = false;
    sender.on_air.reset();
    update_listening(sender);
    const std::vector<Receipt> heard = leave(transmission);

    const auto &psdu = transmission.psdu;
    const AirFrame frame{transmission.start_us, sender.index, transmission.channel, psdu.data(), psdu.size(), 0};
    const AirFate fate = judge_ ? judge_(transmission.number, frame) : AirFate::natural;
    if (transmission.acknowledges != nullptr) {
        end_ack(transmission, frame, fate, heard);
    } else {
        end_data(transmission, frame, fate, heard);
    }
}

void Air::end_ack(const Transmission &transmission, AirFrame frame, AirFate fate, const std::vector<Receipt> &heard)
{
    Radio &to = *transmission.acknowledges;
    const bool got = fate != AirFate::lost && std::any_of(heard.begin(), heard.end(), [&to](const Receipt &receipt) {
                         return receipt.radio == &to;
                     });
    frame.lost_at = got ? 0 : 1;
    frame.acknowledged = to.index;
    frame.cause = got ? air::LossCause::none : cause_of_loss(transmission, fate);
    if (tap_) {
        tap_(frame);
    }
    if (got && to.busy && to.life == transmission.asker_life) {
        finish(to, TSR_RADIO_ACKED, transmission.frame_end_us);
    }
}

std::uint64_t Air::broadcast_losses(const Transmission &transmission, std::uint64_t got) const
{
    const auto &links = neighbours_.of(transmission.sender);
    const auto meant = std::count_if(links.begin(), links.end(), [&](const air::Link &link) {
        return radios_[link.radio]->pan_id == air::pan_of(transmission.psdu);
    });
    return static_cast<std::uint64_t>(meant) - got;
}

void Air::end_data(const Transmission &transmission, AirFrame frame, AirFate fate, const std::vector<Receipt> &heard)
{
    const auto &psdu = transmission.psdu;
    const bool addressed = psdu.size() >= air::kAddressedLen;
    const bool broadcast = !addressed || air::destination_of(psdu) == air::kBroadcast;
    std::vector<Receipt> got;
    if (addressed && fate != AirFate::lost) {
        std::copy_if(heard.begin(), heard.end(), std::back_inserter(got),
                     [&](const Receipt &receipt) { return receipt.radio->receiving; });
    }
    if (addressed) {
        frame.lost_at = broadcast ? broadcast_losses(transmission, got.size()) : got.empty();
    }
    if (frame.lost_at > 0 && !broadcast) {
        frame.cause = cause_of_loss(transmission, fate);
    }
    if (tap_) {
        tap_(frame);
    }
    Radio &sender = *radios_[transmission.sender];
    if ((psdu[0] & air::kAckRequest) == 0 || broadcast) {
        finish(sender, TSR_RADIO_SENT, transmission.end_us);
    } else {
        answer(sender, got.empty() ? nullptr : got.front().radio, transmission);
    }
    for (const Receipt &receipt : got) {
        deliver(receipt, transmission);
        if (fate == AirFate::twice) {
            deliver(receipt, transmission);
        }
    }
}

/* The acknowledgement that follows, if anybody got the frame, and the end of the wait for it. */
void Air::answer(Radio &sender, Radio *receiver, const Transmission &transmission)
{
    const std::uint64_t end_us = transmission.end_us;
    if (receiver != nullptr) {
        clock_.at(end_us + TSR_RADIO_TURNAROUND_US,
                  [this, receiver, life = receiver->life, &sender, asker_life = sender.life,
                   sequence = transmission.psdu[2], end_us] {
                      if (receiver->life == life) {
                          send_ack(*receiver, sender, asker_life, sequence, end_us);
                      }
                  });
    }
    clock_.at(end_us + TSR_RADIO_ACK_WAIT_US, [this, &sender, end_us, attempt = sender.attempt] {
        if (sender.busy && sender.attempt == attempt) {
            finish(sender, TSR_RADIO_NO_ACK, end_us);
        }
    });
}

void Air::finish(Radio &radio, tsr_radio_outcome outcome, std::uint64_t frame_end_us)
{
    account(radio);
    radio.busy = false;
    update_listening(radio);
    tsr_radio_event event{};
    event.kind = TSR_RADIO_TX_DONE;
    event.time_us = frame_end_us;
    event.outcome = outcome;
    radio.handler(event);
}

} // namespace tsr
