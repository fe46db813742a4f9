/*
 * What one radio makes of everything that is on air around it.
 *
 *               preamble, SINR >= -5 dB
 *     SEARCH ───────────────────────────► LOCKED ── end of the frame: right with a probability
 *        ▲                                 │  ▲ │
 *        └─────────────────────────────────┘  └─┘ a stronger preamble, before the frame's own is over
 *            end, deaf, another channel
 *
 * A receiver follows one frame at a time; all others are interference, which
 * counts as noise and so much more as the model's capture margin says. While
 * nothing begins or ends the SINR is constant: each such piece of a frame
 * survives by its own number of bits, the frame if all of them do.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_RECEIVER_H
#define TSR_HAL_AIR_RECEIVER_H

#include <cstdint>
#include <span>

#include "tsr/hal/air/model.h"
#include "tsr/hal/air/packet_error.h"

namespace tsr::air
{

/* The model's receiver as integers, one for all radios. */
struct ReceiverModel {
    explicit ReceiverModel(const AirModel &model);

    PacketError errors;
    int noise_q4;        /* dBm, from the sensitivity: receivers differ in nothing else */
    int interference_q4; /* dB that a frame counts for more than noise of its level; may be negative */
    int capture_q4;      /* dB that takes a receiver over */
    int lock_min_q4;     /* dBm: below it noise alone hides a preamble */
    std::uint64_t noise;
    std::uint64_t cca_threshold;
    /* Links below this level, dBm, change no SINR by more than 0.41 dB: they are 10 dB below the noise. */
    int floor_q4() const;
};

/* A transmission as it arrives at one receiver. */
struct Signal {
    std::uint64_t number = 0; /* of the transmission */
    std::uint64_t start_us = 0;
    std::uint64_t end_us = 0;
    int level_q4 = 0; /* dBm; constant over a frame, whose 4 ms are short against fading */
    std::uint8_t channel = 0;
};

/* What a receiver does about a transmission that begins. */
enum class Reception : std::uint8_t {
    followed,
    other_channel,
    deaf,
    weak,  /* noise alone hides its preamble */
    busy,  /* an earlier frame is followed */
    hidden /* others on air hide its preamble */
};

/* How a transmission ended for one receiver. */
struct Outcome {
    bool followed = false; /* until its end, and wanted */
    /* Probability that its frame is right; 0 if it was not followed. */
    std::uint64_t success_q32 = 0;
    int level_q4 = 0; /* dBm */
};

/*
 * What is on air is kept as two sums of powers, so that a transmission costs a receiver the same however many there
 * are: whoever tells of a signal's begin() tells of its fade() too, before anything else happens at that instant.
 */
class Receiver
{
  public:
    /* model is kept. */
    explicit Receiver(const ReceiverModel &model) : model_(&model) {}

    /* levels_q4: of what is on air there. It loses the frame it follows, on whatever channel: what comes next may be
     * wanted otherwise. */
    void tune(std::uint8_t channel, std::span<const int> levels_q4, std::uint64_t now_us);
    /* A deaf receiver loses the frame it follows. */
    void listen(bool on, std::uint64_t now_us);
    /* A transmission begins; now is its start. */
    Reception begin(const Signal &signal);
    /* Nobody asks how probable the frame is that it follows. The receiver is busy with it all the same. */
    void disregard() { wanted_ = false; }
    /* A transmission of this level and channel is heard no more: its end, or its sender's. */
    void fade(int level_q4, std::uint8_t channel, std::uint64_t now_us);
    /* It ends, having faded. */
    Outcome end(std::uint64_t number);
    /* It has been deaf, or on another channel, at start_us or later. */
    bool was_deaf_since(std::uint64_t start_us) const { return !listening_ || heard_since_us_ > start_us; }

    /* Between these the channel was clear if neither energy nor a frame was found (CCA mode 3 with OR,
     * IEEE 802.15.4-2006, 6.9.9: energy alone, its mode 1, decides where no preamble was heard). */
    void start_cca(std::uint64_t now_us);
    bool finish_cca();

  private:
    void add(int level_q4);
    Reception reception_of(const Signal &signal) const;
    void settle(std::uint64_t now_us);
    void sense(std::uint64_t now_us);

    const ReceiverModel *model_;
    std::uint64_t energy_ = 0;       /* of all on the channel */
    std::uint64_t interference_ = 0; /* the same, with the weight that a frame has against noise */
    std::uint8_t channel_ = 0;
    bool listening_ = false;
    bool locked_ = false;
    bool wanted_ = false;
    bool sensing_ = false;
    bool found_ = false; /* by the CCA under way */
    Signal followed_;
    std::uint64_t heard_since_us_ = 0; /* listening on this channel without a break */
    std::uint64_t settled_us_ = 0;     /* success_q32_ holds for the frame until then */
    std::uint64_t success_q32_ = 0;
};

} // namespace tsr::air

#endif
