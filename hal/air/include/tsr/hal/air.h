/*
 * Air: a radio medium in one process, in virtual time (docs/radio.md).
 *
 * A transmission arrives at every radio near enough to matter with the level
 * of its link: path loss, shadowing, fading (tsr/hal/air/propagation.h). Each
 * receiver follows one frame at a time and takes the others for interference
 * (receiver.h); SINR and length give the probability that the frame is right
 * (packet_error.h), and chance, a hash of seed, transmission and receiver,
 * decides. Levels, powers and probabilities are integers from tables made when
 * the medium is made, the same on every machine.
 *
 * A transmission costs in proportion to the sender's neighbours (neighbours.h),
 * a radio in proportion to those around it; nothing loops over all radios.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_H
#define TSR_HAL_AIR_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

extern "C" {
#include "tsr/hal/radio.h"
}
#include "tsr/hal/air/link_losses.h"
#include "tsr/hal/air/loss.h"
#include "tsr/hal/air/model.h"
#include "tsr/hal/air/neighbours.h"
#include "tsr/hal/air/propagation.h"
#include "tsr/hal/air/receiver.h"

namespace tsr
{

struct AirTimes {                    /* what a radio did, us; all together the time that has passed */
    std::uint64_t transmitting = 0;  /* frames of its own */
    std::uint64_t assessing = 0;     /* from transmit() to the frame or to a busy channel: CCA, turnaround */
    std::uint64_t awaiting = 0;      /* from the end of a frame to its acknowledgement or the end of the wait */
    std::uint64_t acknowledging = 0; /* acknowledgements on air for others' frames */
    std::uint64_t receiving = 0;     /* listening, whether or not there is anything to hear */
    std::uint64_t sleeping = 0;
    std::uint64_t off = 0; /* without power */
};

/* One PSDU on air, acknowledgements included. */
struct AirFrame {
    static constexpr std::size_t kNobody = SIZE_MAX;

    std::uint64_t start_us = 0;
    std::size_t sender = 0; /* radio index */
    std::uint8_t channel = 0;
    const std::uint8_t *psdu = nullptr;
    std::size_t psdu_len = 0;
    std::uint64_t lost_at = 0; /* 1: nobody addressed got it; broadcasts: the sender's neighbours that did not */
    std::size_t acknowledged = kNobody;          /* radio index: whose frame this acknowledges */
    air::LossCause cause = air::LossCause::none; /* why it is lost, if it was for one radio */
};

/* What becomes of one transmission, when a test decides it. */
enum class AirFate {
    natural, /* levels, overlap and chance decide */
    lost,    /* nobody gets it */
    twice    /* who gets it gets it twice; an acknowledgement counts once */
};

class Air
{
  public:
    struct Clock {
        std::function<std::uint64_t()> now_us;
        std::function<void(std::uint64_t, std::function<void()>)> at;
    };
    using EventHandler = std::function<void(const tsr_radio_event &)>;
    using Tap = std::function<void(const AirFrame &)>;
    /* number: transmissions counted from 0, acknowledgements included. */
    using Judge = std::function<AirFate(std::uint64_t number, const AirFrame &)>;

    Air(const AirModel &model, Clock clock);
    ~Air();
    Air(const Air &) = delete;
    Air &operator=(const Air &) = delete;

    /* Add a radio at a place; its index counts from 0. Call before time runs. */
    std::size_t add_radio(const std::array<double, 3> &position_m, EventHandler handler);
    tsr_radio radio(std::size_t index);
    /* Sees every PSDU when its transmission ends. */
    void set_tap(Tap tap) { tap_ = std::move(tap); }
    /* Asked once at the end of every transmission, before the tap. */
    void set_judge(Judge judge) { judge_ = std::move(judge); }
    /*
     * Without power a radio is deaf and forgets its configuration; what it sends is cut: nobody gets it, the tap does
     * not see it, and no TX_DONE comes. With power it sleeps until it is configured anew. Not from an event handler.
     */
    void set_power(std::size_t index, bool on);
    /* Frames that begin while a loss is there suffer it; losses of one link add up. */
    air::LinkLosses &losses() { return losses_; }
    std::uint64_t transmissions() const { return transmissions_; }
    AirTimes times(std::size_t index) const; /* until now */
    /* Of a link without its fading, rounded; kSilentDbm between radios that are no neighbours. */
    static constexpr int kSilentDbm = -128;
    int rssi_dbm(std::size_t from, std::size_t to) const;
    /* Of every receiver, rounded; the sensitivity sets it. */
    int noise_dbm() const;
    /* What has been done: pairs of radios compared, receivers that a transmission was brought to. */
    std::uint64_t pairs_compared() const { return neighbours_.compared(); }
    std::uint64_t arrivals() const { return arrivals_; }

  private:
    struct Radio;
    struct Transmission;
    struct Receipt { /* a receiver that followed a transmission and has it right */
        Radio *radio;
        int level_q4;
    };

    static tsr_status configure(void *radio, std::uint8_t channel, std::uint16_t pan_id, std::uint16_t address);
    static tsr_status set_receiving(void *radio, bool receiving);
    static tsr_status transmit(void *radio, const std::uint8_t *psdu, std::size_t psdu_len);
    static const tsr_radio_ops kOps;

    void sense(Radio &radio);
    void send_data(Radio &radio);
    void send_ack(Radio &radio, Radio &to, std::uint64_t asker_life, std::uint8_t sequence, std::uint64_t frame_end_us);
    std::shared_ptr<Transmission> begin(Radio &sender, std::vector<std::uint8_t> psdu, Radio *acknowledges);
    void cut(Radio &sender);
    void arrive(Transmission &transmission);
    void fade(Transmission &transmission);
    void fade_ended();
    std::vector<int> levels_at(std::size_t radio, std::uint8_t channel) const;
    static bool is_for(const Transmission &transmission, const Radio &radio);
    std::vector<Receipt> leave(Transmission &transmission);
    void end(Transmission &transmission);
    void end_data(const Transmission &transmission, AirFrame frame, AirFate fate, const std::vector<Receipt> &heard);
    void end_ack(const Transmission &transmission, AirFrame frame, AirFate fate, const std::vector<Receipt> &heard);
    std::uint64_t broadcast_losses(const Transmission &transmission, std::uint64_t got) const;
    void answer(Radio &sender, Radio *receiver, const Transmission &transmission);
    std::uint64_t draw_of(const Transmission &transmission, std::size_t receiver) const;
    bool chance_keeps(const Transmission &transmission, std::size_t receiver, std::uint64_t success_q32) const;
    static air::LossCause cause_of_miss(const Radio &radio, air::Reception reception);
    air::LossCause cause_of_loss(const Transmission &transmission, AirFate fate) const;
    air::LossCause cause_on_link(const Transmission &transmission, std::size_t place) const;
    void deliver(const Receipt &receipt, const Transmission &transmission);
    void finish(Radio &radio, tsr_radio_outcome outcome, std::uint64_t frame_end_us);
    void account(Radio &radio) const;
    void update_listening(Radio &radio);

    std::uint64_t seed_;
    bool cca_at_end_;
    air::Propagation propagation_;
    air::ReceiverModel receiver_model_;
    air::Neighbours neighbours_;
    air::LinkLosses losses_;
    std::uint64_t kept_q32_; /* part of the frames that frame_loss leaves */
    Clock clock_;
    Tap tap_;
    Judge judge_;
    std::uint64_t transmissions_ = 0;
    std::uint64_t arrivals_ = 0;
    std::vector<std::unique_ptr<Radio>> radios_;
    std::vector<air::Receiver> receivers_; /* of the radios, side by side: a transmission visits many of them */
    std::vector<Transmission *> on_air_;   /* that have not faded */
    std::uint64_t next_fade_us_ = UINT64_MAX;
};

} // namespace tsr

#endif
