/* How far a run is. SPDX-License-Identifier: Apache-2.0 */
#ifndef TSR_EMULATOR_APP_PROGRESS_BAR_H
#define TSR_EMULATOR_APP_PROGRESS_BAR_H

#include <chrono>
#include <cstdint>
#include <string>

namespace tsr::app
{

/* One line on a terminal, rewritten ten times a second at most. */
class ProgressBar
{
  public:
    /* label stands before the bar; may be empty. */
    ProgressBar(bool wanted, std::string label);

    void after_event(std::uint64_t now_us, std::uint64_t end_us);
    /* Between two events. */
    void waiting(std::uint64_t now_us) { look(now_us); }
    void finish() const;

  private:
    static constexpr unsigned kCallsPerLook = 64; /* an event takes less time than a look at the clock */

    void look(std::uint64_t now_us);
    void draw(std::uint64_t now_us, double wall_s) const;

    bool shown_;
    std::string label_;
    unsigned calls_ = 0;
    std::uint64_t end_us_ = 0; /* 0: no event has told */
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_{};
};

} // namespace tsr::app

#endif
