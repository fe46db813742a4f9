/*
 * What goes wrong during a run, and when: [[fault]] of site.toml and
 * scenario.toml (docs/units.md has every field, docs/faults.md what each does).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_FAULT_H
#define TSR_HOST_FAULT_H

#include <cstdint>
#include <string_view>
#include <vector>

namespace tsr
{

enum class SiteFaultKind {
    death,           /* a node is off from then on */
    reboot,          /* it loses its RAM and starts anew at once */
    brown_out,       /* it is off for a while, then starts anew */
    clock_drift,     /* its clock is fast or slow */
    link_loss,       /* what is sent between two nodes, or to and from one, arrives weaker or seldom */
    camera_failure,  /* its captures end with an error */
    gateway_restart, /* a reboot or, if it lasts, a brown-out of the gateway */
    sink_restart     /* the sink process is killed and started again while virtual time stands still */
};

inline constexpr std::uint64_t kFaultTimeUsMax = 31'536'000'000'000; /* a year */
inline constexpr int kDriftPpmMax = 1000;
inline constexpr double kLinkLossDbMax = 200; /* nothing gets through */

struct SiteFault {
    std::uint64_t at_us = 0;  /* virtual time */
    std::uint64_t for_us = 0; /* 0: for ever, or it does not last */
    SiteFaultKind kind = SiteFaultKind::reboot;
    std::uint16_t node = 0;          /* kNodeNone: the gateway's, the sink's */
    std::uint16_t other = 0;         /* link loss: the other end; kNodeNone: every node */
    int ppm = 0;                     /* clock drift: above 0 the clock is fast */
    double loss_db = 0;              /* link loss: that frames arrive weaker by */
    double frame_loss = 0;           /* link loss: part of the frames that are lost besides */
    std::uint32_t counter_start = 0; /* of the life that follows; 0: the configuration's again */
    int line = 0;                    /* in its file; 0 = built in memory */
};

std::string_view fault_name(SiteFaultKind kind);
/* The node is off for for_us and then starts anew. */
bool is_restart(SiteFaultKind kind);

} // namespace tsr

#endif
