/* Bit errors and what they do to frames. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/hal/air/packet_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tsr/hal/air/decibel.h"

extern "C" {
#include "tsr/hal/radio.h"
}

namespace tsr::air
{

double bit_error_rate(double sinr)
{
    double sum = 0;
    double binomial = 16; /* C(16, 1) */
    for (int k = 2; k <= 16; ++k) {
        binomial = binomial * (17 - k) / k;
        const double term = binomial * exponential(20 * sinr * (1.0 / k - 1));
        sum += k % 2 == 0 ? term : -term;
    }
    return 8.0 / 15 / 16 * sum;
}

PacketError::PacketError()
{
    for (std::size_t i = 0; i < bit_success_q32_.size(); ++i) {
        const double sinr_db = (static_cast<int>(i) + kLowestQ4) / 16.0;
        const double success = 1 - bit_error_rate(ratio_of(sinr_db));
        bit_success_q32_[i] = static_cast<std::uint64_t>(std::llround(success * static_cast<double>(kCertainQ32)));
    }
    constexpr std::uint64_t kBits = 8 * (TSR_RADIO_PHY_HEADER_OCTETS + 20);
    while (success_q32(sensitivity_sinr_q4_, kBits) < kCertainQ32 / 100 * 99) {
        ++sensitivity_sinr_q4_;
    }
}

std::uint64_t PacketError::success_q32(int sinr_q4, std::uint64_t bits) const
{
    std::uint64_t power =
        bit_success_q32_[static_cast<std::size_t>(std::clamp(sinr_q4, kLowestQ4, kHighestQ4) - kLowestQ4)];
    std::uint64_t result = kCertainQ32;
    for (; bits > 0; bits >>= 1) {
        if ((bits & 1) != 0) {
            result = both_q32(result, power);
        }
        power = both_q32(power, power);
    }
    return result;
}

} // namespace tsr::air
