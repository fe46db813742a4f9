/*
 * Virtual time that does not run ahead of the wall clock: --speed.
 *
 * At a speed of s, what happens at virtual time t is not begun before t / s of
 * the wall clock has passed. Waiting is sleep. What is late stays late: the run
 * catches up as fast as it can and nothing is left out, so results do not know
 * of it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_PACE_H
#define TSR_EMULATOR_PACE_H

#include <cstdint>
#include <functional>
#include <string>

namespace tsr
{

class Pace
{
  public:
    /* Longest sleep: so often somebody can look at a signal and draw progress. */
    static constexpr std::uint64_t kNapUs = 100'000;

    struct Clock {                             /* of the wall */
        std::function<std::uint64_t()> now_us; /* since any instant, never back */
        std::function<void(std::uint64_t)> sleep_us;
    };
    static Clock wall_clock();

    /* Virtual time 0 is now. speed: virtual seconds a second, above 0. */
    explicit Pace(double speed, Clock clock = wall_clock());

    /* True when virtual time may be time_us. After each nap go_on is told how far it may be by now; if it says false,
     * false at once. */
    bool wait_for(std::uint64_t time_us, const std::function<bool(std::uint64_t)> &go_on);

    /* How long after its time something was begun, s of the wall clock: the longest, and the latest. */
    double worst_late_s() const { return worst_late_s_; }
    double late_s() const { return late_s_; }

  private:
    double speed_;
    Clock clock_;
    std::uint64_t start_us_;
    double late_s_ = 0;
    double worst_late_s_ = 0;
};

/* "realtime", or a factor: 0.001 .. 1000000. Throws InputError. */
double parse_speed(const std::string &text);

} // namespace tsr

#endif
