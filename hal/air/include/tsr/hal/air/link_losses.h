/*
 * What disturbs single links for a while: somebody stands in between, an antenna is bent.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_LINK_LOSSES_H
#define TSR_HAL_AIR_LINK_LOSSES_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tsr::air
{

inline constexpr std::size_t kEveryRadio = SIZE_MAX;

class LinkLosses
{
  public:
    /* Both ways between two radios, or between one and all others: frames arrive weaker by loss_db, >= 0, and the part
     * frame_loss, 0..1, of those that would be right is lost. The number ends it again. */
    std::size_t begin(std::size_t radio, std::size_t other, double loss_db, double frame_loss);
    void end(std::size_t number);

    int loss_q4(std::size_t from, std::size_t to) const;            /* dB */
    std::uint64_t kept_q32(std::size_t from, std::size_t to) const; /* probability */

  private:
    struct Loss {
        std::size_t number;
        std::size_t radio;
        std::size_t other;
        int loss_q4;
        std::uint64_t kept_q32;
        bool concerns(std::size_t from, std::size_t to) const;
    };

    std::vector<Loss> losses_; /* few, mostly none */
    std::size_t begun_ = 0;
};

} // namespace tsr::air

#endif
