/* Radios that lose their power. SPDX-License-Identifier: Apache-2.0 */
#include "air_parts.h"

namespace tsr
{

namespace
{

constexpr std::uint16_t kNoPan = 0xffff; /* of a radio that nobody has configured */

} // namespace

/* A receiver that has followed it waits for no more: the rest never comes. */
void Air::cut(Radio &sender)
{
    Transmission &transmission = *sender.on_air;
    transmission.cut = true;
    leave(transmission);
    sender.on_air.reset();
}

void Air::set_power(std::size_t index, bool on)
{
    Radio &radio = *radios_.at(index);
    if (radio.powered == on) {
        return;
    }
    account(radio);
    radio.powered = on;
    if (on) {
        return;
    }
    ++radio.life;
    if (radio.on_air) {
        cut(radio);
    }
    radio.receiving = radio.turning = radio.sending = radio.sending_ack = radio.busy = false;
    radio.pan_id = radio.address = kNoPan;
    radio.psdu.clear();
    update_listening(radio);
}

} // namespace tsr
