/*
 * The clock of one node beside virtual time.
 *
 *   local(t) = local_0 + (t - t_0) + floor((t - t_0) ppm / 10^6)
 *
 * from the last change of its rate at (t_0, local_0) on. It starts with virtual
 * time and runs on through a loss of power, as a clock with a battery of its
 * own does; so every local time belongs to one virtual time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_NODE_CLOCK_H
#define TSR_EMULATOR_NODE_CLOCK_H

#include <cstdint>
#include <vector>

namespace tsr
{

class NodeClock
{
  public:
    /* From virtual time now_us on; |ppm| < 10^6, now_us not before the last change. */
    void set_rate(std::uint64_t now_us, int ppm);
    /* Not for times before the last change, but for those of a frame that was on air then. */
    std::uint64_t local_us(std::uint64_t now_us) const;
    /* The first virtual time at which the clock shows local_us or more, past or to come; UINT64_MAX, never, stays. */
    std::uint64_t virtual_us(std::uint64_t local_us) const;

  private:
    struct Piece {
        std::uint64_t virtual_us = 0;
        std::uint64_t local_us = 0;
        std::int64_t ppm = 0;
        std::uint64_t local_at(std::uint64_t time_us) const;
    };

    std::vector<Piece> pieces_{Piece{}};
};

} // namespace tsr

#endif
