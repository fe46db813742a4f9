/* Links that are disturbed for a while. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/hal/air/link_losses.h"

#include <cmath>

#include "tsr/hal/air/decibel.h"
#include "tsr/hal/air/packet_error.h"

namespace tsr::air
{

bool LinkLosses::Loss::concerns(std::size_t from, std::size_t to) const
{
    const auto is_end = [this](std::size_t end) { return other == kEveryRadio || other == end; };
    return (radio == from && is_end(to)) || (radio == to && is_end(from));
}

std::size_t LinkLosses::begin(std::size_t radio, std::size_t other, double loss_db, double frame_loss)
{
    const auto kept_q32 = static_cast<std::uint64_t>(std::llround((1 - frame_loss) * static_cast<double>(kCertainQ32)));
    losses_.push_back({begun_, radio, other, air::level_q4(loss_db), kept_q32});
    return begun_++;
}

void LinkLosses::end(std::size_t number)
{
    std::erase_if(losses_, [number](const Loss &loss) { return loss.number == number; });
}

int LinkLosses::loss_q4(std::size_t from, std::size_t to) const
{
    int sum = 0;
    for (const Loss &loss : losses_) {
        sum += loss.concerns(from, to) ? loss.loss_q4 : 0;
    }
    return sum;
}

std::uint64_t LinkLosses::kept_q32(std::size_t from, std::size_t to) const
{
    std::uint64_t kept_q32 = kCertainQ32;
    for (const Loss &loss : losses_) {
        if (loss.concerns(from, to)) {
            kept_q32 = both_q32(kept_q32, loss.kept_q32);
        }
    }
    return kept_q32;
}

} // namespace tsr::air
