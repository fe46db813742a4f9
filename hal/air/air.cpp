/*
 * The radio medium: transmissions, overlap, chance, acknowledgements.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/air.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tsr
{

namespace
{

constexpr std::uint16_t kBroadcast = 0xffff;
constexpr std::size_t kAddressedLen = 9; /* up to the source address: shorter ones are for nobody */
constexpr std::uint8_t kTypeAck = 0x02;  /* frame control field, IEEE 802.15.4-2015, 7.2.2.1 */
constexpr std::uint8_t kAckRequest = 0x20;

/* SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). */
std::uint64_t mix(std::uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* CRC of IEEE 802.15.4-2015, 7.2.11, as the radio appends it to its acknowledgements. */
std::uint16_t fcs(const std::vector<std::uint8_t> &bytes, std::size_t len)
{
    unsigned crc = 0;
    for (std::size_t i = 0; i < len; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 1u) != 0 ? crc >> 1 ^ 0x8408u : crc >> 1;
        }
    }
    return static_cast<std::uint16_t>(crc);
}

std::uint64_t duration_us(std::size_t psdu_len)
{
    return (TSR_RADIO_PHY_HEADER_OCTETS + psdu_len) * std::uint64_t{TSR_RADIO_OCTET_US};
}

} // namespace

struct Air::Radio {
    Air *air = nullptr;
    std::size_t index = 0;
    std::array<double, 3> position_m{};
    EventHandler handler;
    std::uint8_t channel = 0;
    std::uint16_t pan_id = 0;
    std::uint16_t address = 0;
    bool receiving = false;
    bool sending = false;                 /* its own PSDU is on air */
    bool busy = false;                    /* between transmit() and TX_DONE */
    std::uint64_t listening_since_us = 0; /* neither asleep nor sending since then */
    std::vector<std::uint8_t> psdu;       /* of the transmit() under way */
    std::uint64_t frame_end_us = 0;
    std::uint64_t attempt = 0; /* counts transmit() calls */
    std::vector<int> rssi_dbm; /* heard from each radio, filled lazily by index */
    mutable AirTimes times;
    mutable std::uint64_t accounted_us = 0;
};

struct Air::Transmission {
    std::uint64_t number = 0;
    std::size_t sender = 0;
    std::uint8_t channel = 0;
    std::uint64_t start_us = 0;
    std::uint64_t end_us = 0;
    std::vector<std::uint8_t> psdu;
    std::vector<std::size_t> overlaps; /* senders of transmissions that overlapped this one */
    Radio *acknowledges = nullptr;     /* an acknowledgement's addressee */
    std::uint64_t frame_end_us = 0;    /* of the frame it acknowledges */
};

const tsr_radio_ops Air::kOps = {&Air::configure, &Air::set_receiving, &Air::transmit};

Air::Air(const AirModel &model, Clock clock)
    : model_(model), clock_(std::move(clock)),
      loss_q16_(static_cast<std::uint32_t>(std::lround(model.frame_loss * 65536)))
{
}

Air::~Air() = default;

std::size_t Air::add_radio(const std::array<double, 3> &position_m, EventHandler handler)
{
    auto radio = std::make_unique<Radio>();
    radio->air = this;
    radio->index = radios_.size();
    radio->position_m = position_m;
    radio->handler = std::move(handler);
    for (const auto &other : radios_) {
        double squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            squared += std::pow(position_m[axis] - other->position_m[axis], 2);
        }
        const double distance_m = std::max(std::sqrt(squared), 0.1);
        const double loss_db = model_.reference_loss_db + 10 * model_.path_loss_exponent * std::log10(distance_m);
        /* Whole dBm: a difference in the last bit of log10 cannot reach a result. */
        const int heard_dbm = static_cast<int>(std::lround(model_.tx_power_dbm - loss_db));
        radio->rssi_dbm.push_back(heard_dbm);
        other->rssi_dbm.push_back(heard_dbm);
    }
    radio->rssi_dbm.push_back(0); /* itself */
    radios_.push_back(std::move(radio));
    return radios_.size() - 1;
}

tsr_radio Air::radio(std::size_t index)
{
    return {&kOps, radios_.at(index).get()};
}

int Air::rssi_dbm(std::size_t from, std::size_t to) const
{
    return radios_.at(to)->rssi_dbm.at(from);
}

bool Air::audible(std::size_t from, std::size_t to) const
{
    return rssi_dbm(from, to) >= static_cast<int>(std::lround(model_.sensitivity_dbm));
}

void Air::account(Radio &radio) const
{
    const std::uint64_t now_us = clock_.now_us();
    const std::uint64_t passed_us = now_us - radio.accounted_us;
    radio.accounted_us = now_us;
    /* Sensing and waiting for an acknowledgement need the receiver, whatever the MAC wants. */
    (radio.sending                   ? radio.times.transmitting
     : radio.receiving || radio.busy ? radio.times.receiving
                                     : radio.times.sleeping) += passed_us;
}

AirTimes Air::times(std::size_t index) const
{
    account(*radios_.at(index));
    return radios_.at(index)->times;
}

tsr_status Air::configure(void *radio, std::uint8_t channel, std::uint16_t pan_id, std::uint16_t address)
{
    auto &self = *static_cast<Radio *>(radio);
    if (channel < 11 || channel > 26) {
        return TSR_ERR_ARG;
    }
    self.channel = channel;
    self.pan_id = pan_id;
    self.address = address;
    return TSR_OK;
}

tsr_status Air::set_receiving(void *radio, bool receiving)
{
    auto &self = *static_cast<Radio *>(radio);
    self.air->account(self);
    if (receiving && !self.receiving) {
        self.listening_since_us = self.air->clock_.now_us();
    }
    self.receiving = receiving;
    return TSR_OK;
}

tsr_status Air::transmit(void *radio, const std::uint8_t *psdu, std::size_t psdu_len)
{
    auto &self = *static_cast<Radio *>(radio);
    if (psdu_len == 0 || psdu_len > 127) {
        return TSR_ERR_ARG;
    }
    if (self.busy) {
        return TSR_ERR_BUSY;
    }
    self.air->account(self);
    self.busy = true;
    ++self.attempt;
    self.psdu.assign(psdu, psdu + psdu_len);
    Air &air = *self.air;
    air.clock_.at(air.clock_.now_us() + TSR_RADIO_CCA_US, [&air, &self] { air.sense(self); });
    return TSR_OK;
}

bool Air::channel_clear(const Radio &radio) const
{
    return !radio.sending && std::none_of(on_air_.begin(), on_air_.end(), [&](const auto &transmission) {
        return transmission->channel == radio.channel && audible(transmission->sender, radio.index);
    });
}

void Air::sense(Radio &radio)
{
    if (!channel_clear(radio)) {
        finish(radio, TSR_RADIO_CHANNEL_BUSY, clock_.now_us());
        return;
    }
    clock_.at(clock_.now_us() + TSR_RADIO_TURNAROUND_US, [this, &radio] { send_data(radio); });
}

std::shared_ptr<Air::Transmission> Air::begin(Radio &sender, std::vector<std::uint8_t> psdu)
{
    account(sender);
    sender.sending = true;
    auto transmission = std::make_shared<Transmission>();
    transmission->number = transmissions_++;
    transmission->sender = sender.index;
    transmission->channel = sender.channel;
    transmission->start_us = clock_.now_us();
    transmission->end_us = transmission->start_us + duration_us(psdu.size());
    transmission->psdu = std::move(psdu);
    for (const auto &other : on_air_) {
        if (other->channel == transmission->channel) {
            other->overlaps.push_back(sender.index);
            transmission->overlaps.push_back(other->sender);
        }
    }
    on_air_.push_back(transmission);
    clock_.at(transmission->end_us, [this, transmission] { end(transmission); });
    return transmission;
}

void Air::send_data(Radio &radio)
{
    if (radio.sending) { /* an acknowledgement of its own is on air */
        finish(radio, TSR_RADIO_CHANNEL_BUSY, clock_.now_us());
        return;
    }
    begin(radio, radio.psdu);
}

void Air::send_ack(Radio &radio, Radio &to, std::uint8_t sequence, std::uint64_t frame_end_us)
{
    if (radio.sending) {
        return;
    }
    std::vector<std::uint8_t> psdu = {kTypeAck, 0, sequence};
    const std::uint16_t check = fcs(psdu, psdu.size());
    psdu.push_back(static_cast<std::uint8_t>(check));
    psdu.push_back(static_cast<std::uint8_t>(check >> 8));
    const auto ack = begin(radio, std::move(psdu));
    ack->acknowledges = &to;
    ack->frame_end_us = frame_end_us;
}

/* Near enough, not sending, and nothing else in the way. */
bool Air::reaches(const Radio &receiver, const Transmission &transmission) const
{
    if (receiver.index == transmission.sender || receiver.sending || receiver.channel != transmission.channel ||
        !audible(transmission.sender, receiver.index)) {
        return false;
    }
    return std::none_of(transmission.overlaps.begin(), transmission.overlaps.end(),
                        [&](std::size_t other) { return other == receiver.index || audible(other, receiver.index); });
}

/* A data frame needs a receiver that was on all the time. For its acknowledgement
 * a radio listens by itself, even if the MAC has told it to sleep. */
bool Air::hears(const Radio &receiver, const Transmission &transmission) const
{
    return receiver.receiving && receiver.listening_since_us <= transmission.start_us &&
           reaches(receiver, transmission);
}

bool Air::chance_loses(const Transmission &transmission, std::size_t receiver) const
{
    const std::uint64_t draw = mix(mix(model_.seed + transmission.number) + receiver);
    return (draw >> 48) < loss_q16_;
}

void Air::deliver(Radio &receiver, const Transmission &transmission)
{
    tsr_radio_event event{};
    event.kind = TSR_RADIO_RECEIVED;
    event.time_us = transmission.end_us;
    event.received.psdu = transmission.psdu.data();
    event.received.psdu_len = static_cast<std::uint8_t>(transmission.psdu.size());
    event.received.rssi_dbm =
        static_cast<std::int8_t>(std::clamp(rssi_dbm(transmission.sender, receiver.index), -128, 127));
    receiver.handler(event);
}

void Air::end(const std::shared_ptr<Transmission> &transmission)
{
    on_air_.erase(std::find(on_air_.begin(), on_air_.end(), transmission));
    Radio &sender = *radios_[transmission->sender];
    account(sender);
    sender.sending = false;
    sender.listening_since_us = clock_.now_us();

    const auto &psdu = transmission->psdu;
    const AirFrame frame{transmission->start_us, sender.index, transmission->channel, psdu.data(), psdu.size(), 0};
    const AirFate fate = judge_ ? judge_(transmission->number, frame) : AirFate::natural;
    if (transmission->acknowledges != nullptr) {
        end_ack(*transmission, frame, fate);
    } else {
        end_data(*transmission, frame, fate);
    }
}

void Air::end_ack(const Transmission &transmission, AirFrame frame, AirFate fate)
{
    Radio &to = *transmission.acknowledges;
    const bool got = fate != AirFate::lost && reaches(to, transmission) && !chance_loses(transmission, to.index);
    frame.lost_at = got ? 0 : 1;
    if (tap_) {
        tap_(frame);
    }
    if (got && to.busy) {
        finish(to, TSR_RADIO_ACKED, transmission.frame_end_us);
    }
}

/* Those addressed that get the frame; lost_at counts those that do not. */
std::vector<Air::Radio *> Air::receivers_of(const Transmission &transmission, AirFate fate,
                                            std::uint64_t &lost_at) const
{
    const auto &psdu = transmission.psdu;
    std::vector<Radio *> receivers;
    if (psdu.size() < kAddressedLen) {
        return receivers;
    }
    const unsigned pan_id = psdu[3] | psdu[4] << 8;
    const unsigned destination = psdu[5] | psdu[6] << 8;
    for (const auto &radio : radios_) {
        if (radio->index == transmission.sender || radio->pan_id != pan_id ||
            (destination != kBroadcast && radio->address != destination)) {
            continue;
        }
        if (fate != AirFate::lost && hears(*radio, transmission) && !chance_loses(transmission, radio->index)) {
            receivers.push_back(radio.get());
        } else {
            ++lost_at;
        }
    }
    return receivers;
}

void Air::end_data(const Transmission &transmission, AirFrame frame, AirFate fate)
{
    Radio &sender = *radios_[transmission.sender];
    const auto &psdu = transmission.psdu;
    const std::vector<Radio *> receivers = receivers_of(transmission, fate, frame.lost_at);
    if (tap_) {
        tap_(frame);
    }
    const std::uint64_t end_us = transmission.end_us;
    const bool broadcast = psdu.size() < kAddressedLen || (psdu[5] | psdu[6] << 8) == kBroadcast;
    if ((psdu[0] & kAckRequest) == 0 || broadcast) {
        finish(sender, TSR_RADIO_SENT, end_us);
    } else {
        if (!receivers.empty()) {
            Radio &receiver = *receivers.front();
            const std::uint8_t sequence = psdu[2];
            clock_.at(end_us + TSR_RADIO_TURNAROUND_US,
                      [this, &receiver, &sender, sequence, end_us] { send_ack(receiver, sender, sequence, end_us); });
        }
        clock_.at(end_us + TSR_RADIO_ACK_WAIT_US, [this, &sender, end_us, attempt = sender.attempt] {
            if (sender.busy && sender.attempt == attempt) {
                finish(sender, TSR_RADIO_NO_ACK, end_us);
            }
        });
    }
    for (Radio *receiver : receivers) {
        deliver(*receiver, transmission);
        if (fate == AirFate::twice) {
            deliver(*receiver, transmission);
        }
    }
}

void Air::finish(Radio &radio, tsr_radio_outcome outcome, std::uint64_t frame_end_us)
{
    account(radio);
    radio.busy = false;
    tsr_radio_event event{};
    event.kind = TSR_RADIO_TX_DONE;
    event.time_us = frame_end_us;
    event.outcome = outcome;
    radio.handler(event);
}

} // namespace tsr
