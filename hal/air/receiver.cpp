/* Lock, interference, capture, CCA. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/hal/air/receiver.h"

#include <algorithm>

#include "tsr/hal/air/decibel.h"

extern "C" {
#include "tsr/hal/radio.h"
}

namespace tsr::air
{
namespace
{

/* Here 8 % of the bits are wrong; with less no preamble is found (IEEE 802.15.4-2006, Figure E.2). */
constexpr int kLockSinrQ4 = -5 * 16;
/* Preamble and SFD: what a receiver synchronises to (IEEE 802.15.4-2006, 6.3, 10 symbols). */
constexpr std::uint64_t kSynchronisationUs = 10 * TSR_RADIO_SYMBOL_US;
constexpr std::uint64_t kBitUs = TSR_RADIO_OCTET_US / 8;
constexpr int kNegligibleQ4 = -10 * 16;

} // namespace

ReceiverModel::ReceiverModel(const AirModel &model)
    : noise_q4(level_q4(model.sensitivity_dbm) - errors.sensitivity_sinr_q4()),
      interference_q4(level_q4(model.capture_db) - errors.sensitivity_sinr_q4()),
      capture_q4(level_q4(model.capture_db)), lock_min_q4(noise_q4 + kLockSinrQ4), noise(power_of(noise_q4)),
      cca_threshold(power_of(level_q4(model.cca_threshold_dbm)))
{
}

int ReceiverModel::floor_q4() const
{
    return noise_q4 + kNegligibleQ4 - std::max(interference_q4, 0);
}

void Receiver::add(int level_q4)
{
    energy_ += power_of(level_q4);
    interference_ += power_of(level_q4 + model_->interference_q4);
}

void Receiver::tune(std::uint8_t channel, std::span<const int> levels_q4, std::uint64_t now_us)
{
    locked_ = false;
    heard_since_us_ = now_us;
    channel_ = channel;
    energy_ = interference_ = 0;
    for (const int level_q4 : levels_q4) {
        add(level_q4);
    }
    sense(now_us);
}

void Receiver::listen(bool on, std::uint64_t now_us)
{
    locked_ = locked_ && on;
    heard_since_us_ = listening_ && on ? heard_since_us_ : now_us;
    listening_ = on;
    sense(now_us);
}

/* Nothing has begun or ended since settled_us_: one piece of the frame at one SINR. */
void Receiver::settle(std::uint64_t now_us)
{
    if (!locked_ || !wanted_ || now_us <= settled_us_) {
        return;
    }
    const std::uint64_t bits = (now_us - followed_.start_us) / kBitUs - (settled_us_ - followed_.start_us) / kBitUs;
    const std::uint64_t others = interference_ - power_of(followed_.level_q4 + model_->interference_q4);
    const int sinr_q4 = followed_.level_q4 - level_of(model_->noise + others);
    success_q32_ = both_q32(success_q32_, model_->errors.success_q32(sinr_q4, bits));
    settled_us_ = now_us;
}

/* Not yet added. The cheap questions come first: most signals are too weak or come too late. */
Reception Receiver::reception_of(const Signal &signal) const
{
    if (!listening_) {
        return Reception::deaf;
    }
    if (signal.level_q4 < model_->lock_min_q4) {
        return Reception::weak;
    }
    if (locked_ && (signal.start_us >= followed_.start_us + kSynchronisationUs ||
                    signal.level_q4 < followed_.level_q4 + model_->capture_q4)) {
        return Reception::busy;
    }
    const bool clear = is_at_most(model_->noise + interference_, signal.level_q4 - kLockSinrQ4);
    return clear ? Reception::followed : Reception::hidden;
}

Reception Receiver::begin(const Signal &signal)
{
    if (signal.channel != channel_) {
        return Reception::other_channel;
    }
    settle(signal.start_us);
    const Reception reception = reception_of(signal);
    if (reception == Reception::followed) {
        locked_ = wanted_ = true;
        followed_ = signal;
        success_q32_ = kCertainQ32;
        settled_us_ = signal.start_us;
    }
    add(signal.level_q4);
    sense(signal.start_us);
    return reception;
}

void Receiver::fade(int level_q4, std::uint8_t channel, std::uint64_t now_us)
{
    if (channel == channel_) {
        settle(now_us);
        energy_ -= power_of(level_q4);
        interference_ -= power_of(level_q4 + model_->interference_q4);
    }
}

Outcome Receiver::end(std::uint64_t number)
{
    if (!locked_ || followed_.number != number) {
        return {};
    }
    locked_ = false;
    return wanted_ ? Outcome{true, success_q32_, followed_.level_q4} : Outcome{};
}

void Receiver::start_cca(std::uint64_t now_us)
{
    sensing_ = true;
    found_ = false;
    sense(now_us);
}

bool Receiver::finish_cca()
{
    sensing_ = false;
    return !found_;
}

/* The peak of a CCA's 8 symbols decides: called whenever what is on air may have changed. */
void Receiver::sense(std::uint64_t now_us)
{
    if (!sensing_ || found_) {
        return;
    }
    found_ = energy_ >= model_->cca_threshold || (locked_ && followed_.end_us > now_us);
}

} // namespace tsr::air
