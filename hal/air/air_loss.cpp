/* Why a frame was lost: docs/radio.md, 3. SPDX-License-Identifier: Apache-2.0 */
#include "air_parts.h"

#include <algorithm>

namespace tsr
{

using air::LossCause;

LossCause Air::cause_of_loss(const Transmission &transmission, AirFate fate) const
{
    if (fate == AirFate::lost) {
        return LossCause::link_fault;
    }
    const auto &links = neighbours_.of(transmission.sender);
    const auto link = std::find_if(links.begin(), links.end(), [&](const air::Link &one) {
        const Radio &radio = *radios_[one.radio];
        return transmission.acknowledges != nullptr ? transmission.acknowledges == &radio
                                                    : radio.last_address == air::destination_of(transmission.psdu);
    });
    return link == links.end() ? LossCause::noise
                               : cause_on_link(transmission, static_cast<std::size_t>(link - links.begin()));
}

/* place: of the link to the addressed radio among the sender's. */
LossCause Air::cause_on_link(const Transmission &transmission, std::size_t place) const
{
    const air::Link &link = neighbours_.of(transmission.sender)[place];
    const Radio &radio = *radios_[link.radio];
    const int level_q4 = transmission.arrivals[place].level_q4;
    const int fault_q4 =
        link.mean_q4 + propagation_.fading_q4(transmission.sender, link.radio, transmission.start_us) - level_q4;
    const LossCause missed = transmission.arrivals[place].missed;
    if (missed == LossCause::noise && level_q4 + fault_q4 >= receiver_model_.lock_min_q4) {
        return LossCause::link_fault;
    }
    if (missed != LossCause::none) {
        return missed;
    }
    if (transmission.broken.followed) {
        const std::uint64_t bits = (transmission.end_us - transmission.start_us) / (TSR_RADIO_OCTET_US / 8);
        const std::uint64_t draw = draw_of(transmission, link.radio);
        const auto right_at = [&](int level) {
            return draw < receiver_model_.errors.success_q32(level - receiver_model_.noise_q4, bits);
        };
        return draw < transmission.broken.success_q32 ? LossCause::link_fault
               : right_at(level_q4)                   ? LossCause::collision
               : right_at(level_q4 + fault_q4)        ? LossCause::link_fault
                                                      : LossCause::noise;
    }
    if (!receivers_[link.radio].was_deaf_since(transmission.start_us)) {
        return LossCause::collision; /* a stronger frame took the receiver over */
    }
    return radio.receiving ? LossCause::half_duplex : LossCause::not_listening;
}

} // namespace tsr
