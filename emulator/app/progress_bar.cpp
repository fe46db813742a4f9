/* A bar of number signs. SPDX-License-Identifier: Apache-2.0 */
#include "progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace tsr::app
{

ProgressBar::ProgressBar(bool wanted, std::string label)
    : shown_(wanted && isatty(STDERR_FILENO) != 0), label_(std::move(label))
{
}

void ProgressBar::after_event(std::uint64_t now_us, std::uint64_t end_us)
{
    end_us_ = end_us;
    if (shown_ && ++calls_ % kCallsPerLook == 0) {
        look(now_us);
    }
}

void ProgressBar::look(std::uint64_t now_us)
{
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || end_us_ == 0 || now - last_ < std::chrono::milliseconds(100)) {
        return;
    }
    last_ = now;
    draw(std::min(now_us, end_us_), std::chrono::duration<double>(now - start_).count());
}

void ProgressBar::finish() const
{
    if (shown_) {
        std::fputs("\r\x1b[K", stderr);
    }
}

void ProgressBar::draw(std::uint64_t now_us, double wall_s) const
{
    constexpr std::size_t kWidth = 40;
    const double share = static_cast<double>(now_us) / static_cast<double>(end_us_);
    const auto filled = static_cast<std::size_t>(share * kWidth);
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    const double virtual_s = static_cast<double>(now_us) / 1e6;
    std::fprintf(stderr, "\r%s[%s] %5.1f s of %.1f s, %.0f x real time, %.0f s left \x1b[K", label_.c_str(),
                 bar.c_str(), virtual_s, static_cast<double>(end_us_) / 1e6, wall_s > 0 ? virtual_s / wall_s : 0,
                 share > 0 ? wall_s / share - wall_s : 0);
    std::fflush(stderr);
}

} // namespace tsr::app
