/*
 * The sink as the gateway of a run sees it: frames of the gateway link in,
 * answers out, while virtual time stands still.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_SINK_LINK_H
#define TSR_EMULATOR_SINK_LINK_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tsr
{

class SinkLink
{
  public:
    virtual ~SinkLink() = default;
    /* Send one encoded link frame; returns the bytes of its ANSWER. */
    virtual std::vector<std::uint8_t> exchange(const std::uint8_t *frame, std::size_t len) = 0;
    /* Kill it and start it again: it keeps what it has acknowledged and forgets the rest. */
    virtual void restart() = 0;
};

} // namespace tsr

#endif
