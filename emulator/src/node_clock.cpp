/* Clocks that drift. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/node_clock.h"

#include <algorithm>

namespace tsr
{

namespace
{

constexpr std::int64_t kMillion = 1'000'000;

std::int64_t floor_divide(std::int64_t value, std::int64_t by)
{
    return value / by - (value % by < 0 ? 1 : 0);
}

} // namespace

/* A year at 1000 ppm has 3.2e16 in the product: it fits. */
std::uint64_t NodeClock::Piece::local_at(std::uint64_t time_us) const
{
    const auto passed_us = static_cast<std::int64_t>(time_us - virtual_us);
    return local_us + static_cast<std::uint64_t>(passed_us + floor_divide(passed_us * ppm, kMillion));
}

void NodeClock::set_rate(std::uint64_t now_us, int ppm)
{
    pieces_.push_back({now_us, local_us(now_us), ppm});
}

std::uint64_t NodeClock::local_us(std::uint64_t now_us) const
{
    return pieces_.back().local_at(now_us);
}

std::uint64_t NodeClock::virtual_us(std::uint64_t local_us) const
{
    if (local_us == UINT64_MAX) {
        return UINT64_MAX;
    }
    /* The first piece begins at 0, so there is one. */
    const Piece &piece = *std::find_if(pieces_.rbegin(), pieces_.rend(),
                                       [local_us](const Piece &candidate) { return candidate.local_us <= local_us; });
    /* Whole seconds of the clock first: the product of all of it would not fit. */
    const auto passed_us = static_cast<std::int64_t>(local_us - piece.local_us);
    const std::int64_t rate = kMillion + piece.ppm;
    const std::int64_t guess_us = passed_us / rate * kMillion + passed_us % rate * kMillion / rate;
    std::uint64_t time_us = piece.virtual_us + static_cast<std::uint64_t>(guess_us);
    while (piece.local_at(time_us) < local_us) {
        ++time_us;
    }
    while (time_us > piece.virtual_us && piece.local_at(time_us - 1) >= local_us) {
        --time_us;
    }
    return time_us;
}

} // namespace tsr
