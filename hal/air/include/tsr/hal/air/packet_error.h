/*
 * Which part of the frames survives: O-QPSK with 32 chips for 4 bits.
 *
 *   BER = 8/15 1/16 sum_{k=2}^{16} (-1)^k C(16, k) exp(20 SINR (1/k - 1))
 *                              IEEE 802.15.4-2006, E.4.1.8, formula 7
 *
 * with SINR as a ratio. Interference counts as noise; bits fail independently.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_PACKET_ERROR_H
#define TSR_HAL_AIR_PACKET_ERROR_H

#include <array>
#include <cstdint>

namespace tsr::air
{

inline constexpr std::uint64_t kCertainQ32 = std::uint64_t{1} << 32;

/* a b of two probabilities, UQ1.32, rounded to nearest. */
constexpr std::uint64_t both_q32(std::uint64_t a, std::uint64_t b)
{
    /* Both are at most 2^32, so the product fits but for the one case that needs no product. */
    return a == kCertainQ32 ? b : b == kCertainQ32 ? a : (a * b + (kCertainQ32 >> 1)) >> 32;
}

double bit_error_rate(double sinr);

class PacketError
{
  public:
    PacketError();
    /* Probability, UQ1.32, that as many bits are right at this SINR. */
    std::uint64_t success_q32(int sinr_q4, std::uint64_t bits) const;
    /* Lowest SINR at which 99 % of the frames of 20 octets survive, what a sensitivity is given for
     * (IEEE 802.15.4-2006, 6.1.7). */
    int sensitivity_sinr_q4() const { return sensitivity_sinr_q4_; }

  private:
    static constexpr int kLowestQ4 = -16 * 16; /* 46 % of the bits are wrong */
    static constexpr int kHighestQ4 = 8 * 16;  /* none is, in 2^32 */
    std::array<std::uint64_t, kHighestQ4 - kLowestQ4 + 1> bit_success_q32_;
    int sensitivity_sinr_q4_ = kLowestQ4;
};

} // namespace tsr::air

#endif
