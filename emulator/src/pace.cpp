/*
 * Waiting for the wall clock.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/pace.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr double kSpeedMin = 1e-3;
constexpr double kSpeedMax = 1e6;

} // namespace

Pace::Clock Pace::wall_clock()
{
    Clock clock;
    clock.now_us = [] {
        const auto since = std::chrono::steady_clock::now().time_since_epoch();
        return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(since).count());
    };
    clock.sleep_us = [](std::uint64_t us) { std::this_thread::sleep_for(std::chrono::microseconds(us)); };
    return clock;
}

Pace::Pace(double speed, Clock clock) : speed_(speed), clock_(std::move(clock)), start_us_(clock_.now_us()) {}

bool Pace::wait_for(std::uint64_t time_us, const std::function<bool(std::uint64_t)> &go_on)
{
    const auto due_us = static_cast<std::uint64_t>(std::ceil(static_cast<double>(time_us) / speed_));
    std::uint64_t passed_us = clock_.now_us() - start_us_;
    late_s_ = passed_us > due_us ? static_cast<double>(passed_us - due_us) / 1e6 : 0;
    worst_late_s_ = std::max(worst_late_s_, late_s_);
    while (passed_us < due_us) {
        clock_.sleep_us(std::min(due_us - passed_us, kNapUs));
        passed_us = clock_.now_us() - start_us_;
        const auto reached_us = static_cast<std::uint64_t>(static_cast<double>(passed_us) * speed_);
        if (!go_on(std::min(reached_us, time_us))) {
            return false;
        }
    }
    return true;
}

double parse_speed(const std::string &text)
{
    if (text == "realtime") {
        return 1;
    }
    double speed = 0;
    const char *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, speed);
    if (error != std::errc() || stop != end || !(speed >= kSpeedMin && speed <= kSpeedMax)) {
        throw InputError("command line", "--speed",
                         "'" + text + "' is neither realtime nor a factor of 0.001..1000000");
    }
    return speed;
}

} // namespace tsr
