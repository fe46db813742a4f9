/*
 * What a radio medium is told: docs/radio.md says where every number comes from.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_MODEL_H
#define TSR_HAL_AIR_MODEL_H

#include <cstdint>

namespace tsr
{

/* Mean loss at distance d: reference_loss_db + 10 path_loss_exponent log10(d / 1 m) + shadowing
 * (Rappaport, Wireless Communications, 2nd ed., eq. 4.69a). docs/units.md has the ranges. */
struct AirModel {
    double tx_power_dbm = 0;
    double reference_loss_db = 40; /* free space at 1 m, 2.45 GHz: 40.2 dB */
    double path_loss_exponent = 3;
    double shadowing_db = 0;               /* standard deviation over links */
    double fading_db = 0;                  /* standard deviation of one link over time */
    std::uint32_t fading_period_ms = 1000; /* a link's fading is drawn anew so often */
    double sensitivity_dbm = -95;   /* 1 % of frames with 20 octets are lost (IEEE 802.15.4-2006, 6.1.7, 6.5.3.3) */
    double capture_db = 3;          /* over another frame, with the same 1 %: CC2420 data sheet, co-channel rejection */
    double cca_threshold_dbm = -85; /* 10 dB above the sensitivity at most: IEEE 802.15.4-2006, 6.9.9 */
    double frame_loss = 0;          /* 0..1, of every frame and acknowledgement, whatever the distance */
    std::uint64_t seed = 1;
    bool cca_at_end = false; /* read at the end of its 8 symbols, not their peak: ns-3.37 does so, for comparison */
};

} // namespace tsr

#endif
