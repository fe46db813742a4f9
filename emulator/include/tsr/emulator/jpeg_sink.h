/*
 * The sink of baseline nodes: puts their messages together, opens them, keeps
 * both JPEG files of each, and answers as tarsier-sink does.
 *
 * A message is two parts in a MAP's body: left view, right view.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_JPEG_SINK_H
#define TSR_EMULATOR_JPEG_SINK_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tsr/emulator/sink_link.h"
#include "tsr/host/keys.h"

extern "C" {
#include "tsr/wire/body.h"
#include "tsr/wire/link.h"
}

namespace tsr
{

class JpegSink : public SinkLink
{
  public:
    struct Received {
        std::uint16_t node = 0;
        std::uint32_t counter = 0;
        std::uint64_t capture_time_us = 0; /* the node's clock */
        std::size_t left_bytes = 0;
        std::size_t right_bytes = 0;
        std::string name; /* its files are NAME-left.jpg and NAME-right.jpg in the folder */
    };

    /* folder is made. Throws InputError. */
    JpegSink(const KeyRing &keys, std::filesystem::path folder);

    /* Throws InputError if a file cannot be written. */
    std::vector<std::uint8_t> exchange(const std::uint8_t *frame, std::size_t len) override;
    void restart() override;

    /* In the order of arrival. */
    const std::vector<Received> &received() const { return received_; }
    unsigned restarts() const { return restarts_; }

  private:
    struct Origin {
        tsr_cipher cipher{};
        std::vector<std::uint8_t> message; /* being put together */
        tsr_reassembly assembly{};
        std::deque<std::pair<std::uint16_t, tsr_delivery>> finished; /* message ids, the newest last */
    };

    std::vector<std::uint8_t> take_fragment(const std::uint8_t *bytes, std::size_t len);
    std::optional<tsr_body_status> judge(Origin &origin, const tsr_fragment &fragment);
    tsr_delivery finish(Origin &origin, const tsr_fragment &fragment);
    tsr_delivery keep(const tsr_message_header &header, std::span<const std::uint8_t> body);

    std::filesystem::path folder_;
    std::map<std::uint16_t, Origin> origins_;
    std::vector<Received> received_;
    tsr_link_decoder decoder_{};
    std::uint32_t counter_ = 0; /* last one sealed with */
    unsigned restarts_ = 0;
};

} // namespace tsr

#endif
