/*
 * Captures of IEEE 802.15.4 frames that Wireshark and tshark open.
 *
 * pcapng (draft-ietf-opsawg-pcapng) with one section and one interface of
 * LINKTYPE_IEEE802_15_4_TAP (283): each PSDU behind a TAP header that names
 * its FCS type and channel. Times are virtual, in microseconds.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_PCAPNG_H
#define TSR_HOST_PCAPNG_H

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "tsr/host/atomic_file.h"

namespace tsr
{

class PcapngCapture
{
  public:
    /* Frames go to the disk as they come. Throws InputError. */
    explicit PcapngCapture(const std::filesystem::path &file);
    /* psdu includes its FCS. */
    void add(std::uint64_t time_us, std::uint8_t channel, std::span<const std::uint8_t> psdu);
    /* The file is there, complete or not at all. Throws InputError. Call last. */
    void complete();

  private:
    void flush();

    AtomicFile file_;
    std::vector<std::uint8_t> bytes_; /* not yet in the file */
};

} // namespace tsr

#endif
