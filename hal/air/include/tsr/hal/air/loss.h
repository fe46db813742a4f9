/*
 * Why a frame was not received by the radio it was for.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_LOSS_H
#define TSR_HAL_AIR_LOSS_H

#include <array>
#include <cstddef>
#include <cstdint>

namespace tsr::air
{

/*
 * What the receiver did when the frame began. Of a frame that was followed to its end, what would have kept it right
 * with the same draw of chance: no frame_loss, no other frame on air, no loss_db, in this order.
 */
enum class LossCause : std::uint8_t {
    none,
    collision,     /* another frame hid its preamble, took the receiver over or broke its bits */
    noise,         /* too weak at the receiver, or out of its reach, with nobody else on air */
    receiver_busy, /* the receiver was following an earlier frame */
    half_duplex,   /* it was sending, or turning round to send */
    not_listening, /* it slept, was on another channel or had no power */
    link_fault     /* loss_db or frame_loss of a fault or of [radio] */
};

inline constexpr std::size_t kLossCauses = 7; /* none among them */
/* Of LossCause, in its order. */
inline constexpr std::array<const char *, kLossCauses> kLossNames = {
    "none", "collision", "noise", "receiver_busy", "half_duplex", "not_listening", "link_fault"};

/* Frames by their cause; none: of broadcasts, which are for no one radio. */
using LossTally = std::array<std::uint64_t, kLossCauses>;

} // namespace tsr::air

#endif
