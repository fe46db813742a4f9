/*
 * Parts of the tiny site: what can fail in it, and what its cameras see.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_TINY_SITE_PARTS_H
#define TSR_TEST_TINY_SITE_PARTS_H

#include <array>
#include <cstdint>

namespace tsr::test
{

enum class FaultKind {
    none,
    lose_frame,   /* data frame n on air reaches nobody */
    double_frame, /* it arrives twice */
    lose_ack,     /* acknowledgement n on air reaches nobody */
    camera_call,  /* capture() n is refused */
    camera_done,  /* capture n ends with an error */
    transmit,     /* transmit() n of any radio is refused */
    port_write,   /* write() n is refused */
    port_damage,  /* write() n arrives with a changed byte */
    lose_answer,  /* what the sink writes the n-th time is lost */
    double_answer,
    kind_count
};

inline const char *fault_name(FaultKind kind)
{
    static constexpr std::array<const char *, static_cast<std::size_t>(FaultKind::kind_count)> kNames = {
        "none",     "lose_frame", "double_frame", "lose_ack",    "camera_call",  "camera_done",
        "transmit", "port_write", "port_damage",  "lose_answer", "double_answer"};
    return kNames.at(static_cast<std::size_t>(kind));
}

struct Fault {
    FaultKind kind = FaultKind::none;
    std::uint64_t n = 0;
};

/* What a camera sees: blocks of gray, a plane with a box in front, other ones after the change. */
struct TinyScene {
    static std::uint8_t texture(unsigned x, unsigned y, unsigned version)
    {
        std::uint32_t hash = (x / 2 * 73856093u) ^ (y / 2 * 19349663u) ^ (version * 83492791u);
        hash = (hash ^ hash >> 13) * 0x5bd1e995u;
        return static_cast<std::uint8_t>(60 + (hash >> 24) % 120);
    }
    static unsigned disparity(unsigned x, unsigned y, unsigned version)
    {
        const bool box = x >= 12 && x < 26 && y >= 6 && y < 20;
        return version == 0 ? 3u : box ? 10u : 5u;
    }
    static std::uint8_t pixel(bool right, unsigned x, unsigned y, unsigned version)
    {
        if (!right) {
            return texture(x, y, version);
        }
        for (const unsigned d : {10u, 5u, 3u}) {
            if (disparity(x + d, y, version) == d) {
                return texture(x + d, y, version);
            }
        }
        return texture(x, y, version);
    }
};

} // namespace tsr::test

#endif
