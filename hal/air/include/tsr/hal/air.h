/*
 * Air: a radio medium in one process, in virtual time.
 *
 * Every transmission reaches every other radio with the power of a table that
 * is computed once from positions (log-distance path loss) and then quantised
 * to whole dBm, so that results do not depend on the machine. A frame is lost
 * at a receiver if another audible transmission overlaps it there, if the
 * receiver did not listen all the time, or by chance, with the probability the
 * table gives; chance is a hash of seed, transmission and receiver.
 *
 * The simple model of a first version: no fading, no capture effect.
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

namespace tsr
{

/* Path loss at distance d: reference_loss_db + 10 exponent log10(d / 1 m)
 * (Rappaport, Wireless Communications, 2nd ed., eq. 4.68, without shadowing). */
struct AirModel {
    double tx_power_dbm = 0;
    double reference_loss_db = 40; /* free space at 1 m, 2.45 GHz: 40.2 dB */
    double path_loss_exponent = 3;
    double sensitivity_dbm = -95;
    double frame_loss = 0; /* 0..1, of every frame and acknowledgement, whatever the distance */
    std::uint64_t seed = 1;
};

struct AirTimes { /* what a radio did, us */
    std::uint64_t transmitting = 0;
    std::uint64_t receiving = 0;
    std::uint64_t sleeping = 0;
};

/* One PSDU on air, acknowledgements included. */
struct AirFrame {
    std::uint64_t start_us = 0;
    std::size_t sender = 0; /* radio index */
    std::uint8_t channel = 0;
    const std::uint8_t *psdu = nullptr;
    std::size_t psdu_len = 0;
    std::uint64_t lost_at = 0; /* receivers addressed that did not get it: 0 or 1; broadcasts: their number */
};

/* What becomes of one transmission, when a test decides it. */
enum class AirFate {
    natural, /* distance, overlap and chance decide */
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
    std::uint64_t transmissions() const { return transmissions_; }
    AirTimes times(std::size_t index) const; /* until now */
    int rssi_dbm(std::size_t from, std::size_t to) const;

  private:
    struct Radio;
    struct Transmission;

    static tsr_status configure(void *radio, std::uint8_t channel, std::uint16_t pan_id, std::uint16_t address);
    static tsr_status set_receiving(void *radio, bool receiving);
    static tsr_status transmit(void *radio, const std::uint8_t *psdu, std::size_t psdu_len);
    static const tsr_radio_ops kOps;

    bool audible(std::size_t from, std::size_t to) const;
    bool channel_clear(const Radio &radio) const;
    void sense(Radio &radio);
    void send_data(Radio &radio);
    void send_ack(Radio &radio, Radio &to, std::uint8_t sequence, std::uint64_t frame_end_us);
    std::shared_ptr<Transmission> begin(Radio &sender, std::vector<std::uint8_t> psdu);
    void end(const std::shared_ptr<Transmission> &transmission);
    void end_data(const Transmission &transmission, AirFrame frame, AirFate fate);
    void end_ack(const Transmission &transmission, AirFrame frame, AirFate fate);
    std::vector<Radio *> receivers_of(const Transmission &transmission, AirFate fate, std::uint64_t &lost_at) const;
    bool reaches(const Radio &receiver, const Transmission &transmission) const;
    bool hears(const Radio &receiver, const Transmission &transmission) const;
    bool chance_loses(const Transmission &transmission, std::size_t receiver) const;
    void deliver(Radio &receiver, const Transmission &transmission);
    void finish(Radio &radio, tsr_radio_outcome outcome, std::uint64_t frame_end_us);
    void account(Radio &radio) const;

    AirModel model_;
    Clock clock_;
    Tap tap_;
    Judge judge_;
    std::uint32_t loss_q16_ = 0;
    std::uint64_t transmissions_ = 0;
    std::vector<std::unique_ptr<Radio>> radios_;
    std::vector<std::shared_ptr<Transmission>> on_air_; /* under way */
};

} // namespace tsr

#endif
