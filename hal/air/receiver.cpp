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

void Receiver::tune(std::uint8_t channel, std::uint64_t now_us)
{
    locked_ = false;
    channel_ = channel;
    sense(now_us);
}

void Receiver::listen(bool on, std::uint64_t now_us)
{
    locked_ = locked_ && on;
    listening_ = on;
    sense(now_us);
}

/* Noise, and all others on the channel with the weight that a frame has against noise. */
std::uint64_t Receiver::disturbance(std::uint64_t but_number, std::uint64_t now_us) const
{
    std::uint64_t sum = model_->noise;
    for (const Heard &other : signals_) {
        if (other.number != but_number && other.channel == channel_ && other.end_us > now_us) {
            sum += other.weight;
        }
    }
    return sum;
}

/* Nothing has begun or ended since settled_us_: one piece of the frame at one SINR. */
void Receiver::settle(std::uint64_t now_us)
{
    if (!locked_ || !followed_.wanted || now_us <= settled_us_) {
        return;
    }
    const std::uint64_t bits = (now_us - followed_.start_us) / kBitUs - (settled_us_ - followed_.start_us) / kBitUs;
    const int sinr = followed_.level_q4 - level_of(disturbance(followed_.number, settled_us_));
    success_q32_ = both_q32(success_q32_, model_->errors.success_q32(sinr, bits));
    settled_us_ = now_us;
}

/* Whether the receiver follows it from now on. The cheap questions come first: most signals are too weak or come too
 * late.
 */
bool Receiver::takes(const Signal &signal, std::uint64_t now_us) const
{
    if (!listening_ || signal.channel != channel_ || signal.level_q4 < model_->lock_min_q4) {
        return false;
    }
    if (locked_ && (now_us >= followed_.start_us + kSynchronisationUs ||
                    signal.level_q4 < followed_.level_q4 + model_->capture_q4)) {
        return false;
    }
    return is_at_most(disturbance(signal.number, now_us), signal.level_q4 - kLockSinrQ4);
}

void Receiver::begin(const Signal &signal)
{
    const std::uint64_t now_us = signal.start_us;
    settle(now_us);
    signals_.push_back({signal.number, signal.end_us, power_of(signal.level_q4),
                        power_of(signal.level_q4 + model_->interference_q4), signal.channel});
    if (takes(signal, now_us)) {
        locked_ = true;
        followed_ = signal;
        success_q32_ = kCertainQ32;
        settled_us_ = now_us;
    }
    sense(now_us);
}

Outcome Receiver::end(std::uint64_t number, std::uint64_t now_us)
{
    settle(now_us);
    const auto found =
        std::find_if(signals_.begin(), signals_.end(), [number](const Heard &one) { return one.number == number; });
    if (found != signals_.end()) {
        *found = signals_.back();
        signals_.pop_back();
    }
    if (!locked_ || followed_.number != number) {
        return {};
    }
    locked_ = false;
    return followed_.wanted ? Outcome{success_q32_, followed_.level_q4} : Outcome{};
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
    std::uint64_t energy = 0;
    for (const Heard &signal : signals_) {
        if (signal.channel == channel_ && signal.end_us > now_us) {
            energy += signal.power;
        }
    }
    found_ = energy >= model_->cca_threshold || (locked_ && followed_.end_us > now_us);
}

} // namespace tsr::air
