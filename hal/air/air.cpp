/*
 * The radio medium: radios, their transmissions and acknowledgements.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "air_parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "tsr/hal/air/chance.h"
#include "tsr/hal/air/decibel.h"

namespace tsr
{

namespace
{

constexpr std::uint8_t kTypeAck = 0x02; /* frame control field, IEEE 802.15.4-2015, 7.2.2.1 */

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

const tsr_radio_ops Air::kOps = {&Air::configure, &Air::set_receiving, &Air::transmit};

Air::Air(const AirModel &model, Clock clock)
    : seed_(model.seed), cca_at_end_(model.cca_at_end), propagation_(model), receiver_model_(model),
      neighbours_(propagation_, receiver_model_.floor_q4()),
      kept_q32_(
          static_cast<std::uint64_t>(std::llround((1 - model.frame_loss) * static_cast<double>(air::kCertainQ32)))),
      clock_(std::move(clock))
{
}

Air::~Air() = default;

std::size_t Air::add_radio(const std::array<double, 3> &position_m, EventHandler handler)
{
    const std::size_t index = neighbours_.add(position_m);
    radios_.push_back(std::make_unique<Radio>(*this, index, std::move(handler)));
    receivers_.emplace_back(receiver_model_);
    return index;
}

tsr_radio Air::radio(std::size_t index)
{
    return {&kOps, radios_.at(index).get()};
}

int Air::rssi_dbm(std::size_t from, std::size_t to) const
{
    for (const air::Link &link : neighbours_.of(from)) {
        if (link.radio == to) {
            return air::to_dbm(link.mean_q4);
        }
    }
    return kSilentDbm;
}

int Air::noise_dbm() const
{
    return air::to_dbm(receiver_model_.noise_q4);
}

void Air::account(Radio &radio) const
{
    const std::uint64_t now_us = clock_.now_us();
    const std::uint64_t passed_us = now_us - radio.accounted_us;
    radio.accounted_us = now_us;
    AirTimes &times = radio.times;
    /* Sensing and waiting for an acknowledgement need the receiver, whatever the MAC wants. */
    (!radio.powered              ? times.off
     : radio.sending_ack         ? times.acknowledging
     : radio.sending             ? times.transmitting
     : radio.busy && !radio.sent ? times.assessing
     : radio.busy                ? times.awaiting
     : radio.receiving           ? times.receiving
                                 : times.sleeping) += passed_us;
}

AirTimes Air::times(std::size_t index) const
{
    account(*radios_.at(index));
    return radios_.at(index)->times;
}

/* For an acknowledgement a radio listens by itself, even if the MAC has told it to sleep. */
void Air::update_listening(Radio &radio)
{
    fade_ended();
    radio.receiver().listen(!radio.sending && !radio.turning && (radio.receiving || radio.busy), clock_.now_us());
}

tsr_status Air::configure(void *radio, std::uint8_t channel, std::uint16_t pan_id, std::uint16_t address)
{
    auto &self = *static_cast<Radio *>(radio);
    if (channel < 11 || channel > 26) {
        return TSR_ERR_ARG;
    }
    Air &air = *self.air;
    self.channel = channel;
    self.pan_id = pan_id;
    self.address = self.last_address = address;
    air.fade_ended();
    self.receiver().tune(channel, air.levels_at(self.index, channel), air.clock_.now_us());
    return TSR_OK;
}

tsr_status Air::set_receiving(void *radio, bool receiving)
{
    auto &self = *static_cast<Radio *>(radio);
    self.air->account(self);
    self.receiving = receiving;
    self.air->update_listening(self);
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
    Air &air = *self.air;
    air.account(self);
    self.busy = true;
    self.sent = false;
    ++self.attempt;
    self.psdu.assign(psdu, psdu + psdu_len);
    air.update_listening(self);
    if (!air.cca_at_end_) {
        self.receiver().start_cca(air.clock_.now_us());
    }
    air.clock_.at(air.clock_.now_us() + TSR_RADIO_CCA_US, [&air, &self, life = self.life] {
        if (self.life == life) {
            air.sense(self);
        }
    });
    return TSR_OK;
}

void Air::sense(Radio &radio)
{
    if (cca_at_end_) {
        fade_ended();
        radio.receiver().start_cca(clock_.now_us());
    }
    if (!radio.receiver().finish_cca() || radio.sending) {
        finish(radio, TSR_RADIO_CHANNEL_BUSY, clock_.now_us());
        return;
    }
    radio.turning = true;
    update_listening(radio);
    clock_.at(clock_.now_us() + TSR_RADIO_TURNAROUND_US, [this, &radio, life = radio.life] {
        if (radio.life == life) {
            send_data(radio);
        }
    });
}

std::shared_ptr<Air::Transmission> Air::begin(Radio &sender, std::vector<std::uint8_t> psdu, Radio *acknowledges)
{
    account(sender);
    sender.sending = true;
    update_listening(sender);
    auto transmission = std::make_shared<Transmission>();
    transmission->number = transmissions_++;
    transmission->sender = sender.index;
    transmission->channel = sender.channel;
    transmission->start_us = clock_.now_us();
    transmission->end_us = transmission->start_us + duration_us(psdu.size());
    transmission->psdu = std::move(psdu);
    transmission->acknowledges = acknowledges;
    sender.on_air = transmission;
    arrive(*transmission);
    clock_.at(transmission->end_us, [this, transmission] {
        if (!transmission->cut) {
            end(*transmission);
        }
    });
    return transmission;
}

void Air::arrive(Transmission &transmission)
{
    fade_ended();
    air::Signal signal;
    signal.number = transmission.number;
    signal.start_us = transmission.start_us;
    signal.end_us = transmission.end_us;
    signal.channel = transmission.channel;
    const auto &links = neighbours_.of(transmission.sender);
    transmission.arrivals.reserve(links.size());
    for (const air::Link &link : links) {
        signal.level_q4 = link.mean_q4 +
                          propagation_.fading_q4(transmission.sender, link.radio, transmission.start_us) -
                          losses_.loss_q4(transmission.sender, link.radio);
        const air::Reception reception = receivers_[link.radio].begin(signal);
        transmission.arrivals.push_back({signal.level_q4, cause_of_miss(*radios_[link.radio], reception)});
        if (reception == air::Reception::followed && !is_for(transmission, *radios_[link.radio])) {
            receivers_[link.radio].disregard();
        }
    }
    arrivals_ += links.size();
    on_air_.push_back(&transmission);
    next_fade_us_ = std::min(next_fade_us_, transmission.end_us);
}

void Air::fade(Transmission &transmission)
{
    const std::uint64_t now_us = clock_.now_us();
    const auto &links = neighbours_.of(transmission.sender);
    for (std::size_t i = 0; i < links.size(); ++i) {
        receivers_[links[i].radio].fade(transmission.arrivals[i].level_q4, transmission.channel, now_us);
    }
    transmission.faded = true;
    std::erase(on_air_, &transmission);
    next_fade_us_ = UINT64_MAX;
    for (const Transmission *other : on_air_) {
        next_fade_us_ = std::min(next_fade_us_, other->end_us);
    }
}

/* What ends now is over before anything else happens now, in whatever order the events of this instant come. */
void Air::fade_ended()
{
    while (next_fade_us_ <= clock_.now_us()) {
        fade(**std::find_if(on_air_.begin(), on_air_.end(),
                            [this](const Transmission *one) { return one->end_us == next_fade_us_; }));
    }
}

/* Of what is on air on a channel, where a radio is. */
std::vector<int> Air::levels_at(std::size_t radio, std::uint8_t channel) const
{
    std::vector<int> levels_q4;
    for (const Transmission *transmission : on_air_) {
        const auto &links = neighbours_.of(transmission->sender);
        const auto link =
            std::find_if(links.begin(), links.end(), [radio](const air::Link &one) { return one.radio == radio; });
        if (transmission->channel == channel && link != links.end()) {
            levels_q4.push_back(transmission->arrivals[static_cast<std::size_t>(link - links.begin())].level_q4);
        }
    }
    return levels_q4;
}

bool Air::is_for(const Transmission &transmission, const Radio &radio)
{
    const auto &psdu = transmission.psdu;
    if (transmission.acknowledges != nullptr) {
        return transmission.acknowledges == &radio;
    }
    return psdu.size() >= air::kAddressedLen && radio.pan_id == air::pan_of(psdu) &&
           (air::destination_of(psdu) == air::kBroadcast || radio.address == air::destination_of(psdu));
}

/* Takes it from the air; gives those that have got it right. */
std::vector<Air::Receipt> Air::leave(Transmission &transmission)
{
    if (!transmission.faded) {
        fade(transmission);
    }
    std::vector<Receipt> heard;
    for (const air::Link &link : neighbours_.of(transmission.sender)) {
        const air::Outcome outcome = receivers_[link.radio].end(transmission.number);
        if (outcome.followed && chance_keeps(transmission, link.radio, outcome.success_q32)) {
            heard.push_back({radios_[link.radio].get(), outcome.level_q4});
        } else if (outcome.followed) {
            transmission.broken = outcome;
        }
    }
    return heard;
}

void Air::send_data(Radio &radio)
{
    radio.turning = false;
    if (radio.sending) { /* an acknowledgement of its own is on air */
        finish(radio, TSR_RADIO_CHANNEL_BUSY, clock_.now_us());
        return;
    }
    begin(radio, radio.psdu, nullptr);
    radio.sent = true;
}

void Air::send_ack(Radio &radio, Radio &to, std::uint64_t asker_life, std::uint8_t sequence, std::uint64_t frame_end_us)
{
    if (radio.sending) {
        return;
    }
    std::vector<std::uint8_t> psdu = {kTypeAck, 0, sequence};
    const std::uint16_t check = fcs(psdu, psdu.size());
    psdu.push_back(static_cast<std::uint8_t>(check));
    psdu.push_back(static_cast<std::uint8_t>(check >> 8));
    const auto ack = begin(radio, std::move(psdu), &to);
    radio.sending_ack = true;
    ack->asker_life = asker_life;
    ack->frame_end_us = frame_end_us;
}

} // namespace tsr
