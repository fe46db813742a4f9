/* Decibels: the functions and the table. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/hal/air/decibel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tsr::air
{
namespace
{

constexpr double kLn2 = 0.69314718055994530942;
constexpr double kLn10 = 2.30258509299404568402;
PowerTable make_powers()
{
    PowerTable made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
        made[i] = static_cast<std::uint64_t>(std::llround(ratio_of(static_cast<double>(i) / 16)));
    }
    return made;
}

} // namespace

const PowerTable kPowers = make_powers();

/* e^x = (e^(x / 2^n))^(2^n), the inner one by its Taylor series. */
double exponential(double x)
{
    int halvings = 0;
    for (; std::abs(x) > 1.0 / 16; x /= 2) {
        ++halvings;
    }
    double sum = 1;
    double term = 1;
    for (int k = 1; k <= 12; ++k) {
        term = term * x / k;
        sum += term;
    }
    for (; halvings > 0; --halvings) {
        sum *= sum;
    }
    return sum;
}

/* ln m = 2 artanh((m - 1) / (m + 1)) for the mantissa, which is 1/2 .. 1. */
double decibels(double ratio)
{
    int exponent = 0;
    const double mantissa = std::frexp(ratio, &exponent);
    const double t = (mantissa - 1) / (mantissa + 1);
    double sum = 0;
    double power = t;
    for (int k = 1; k <= 41; k += 2) {
        sum += power / k;
        power *= t * t;
    }
    return 10 / kLn10 * (exponent * kLn2 + 2 * sum);
}

double ratio_of(double decibels)
{
    return exponential(decibels * kLn10 / 10);
}

int level_q4(double decibels)
{
    return static_cast<int>(std::lround(decibels * 16));
}

int to_dbm(int level_q4)
{
    return (level_q4 + (level_q4 < 0 ? -8 : 8)) / 16;
}

int level_of(std::uint64_t power)
{
    const auto *above = std::upper_bound(kPowers.begin(), kPowers.end(), power);
    return kPowerLowestQ4 + std::max(static_cast<int>(above - kPowers.begin()) - 1, 0);
}

} // namespace tsr::air
