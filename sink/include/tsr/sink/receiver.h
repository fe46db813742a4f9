/*
 * From fragments to stored maps and events: what the sink does with each UPLINK, without
 * sockets and without a clock, so that equal input gives equal answers.
 *
 *   fragment ─► reassembly ─► open (node key) ─► decode ─► judge ─► insert ─┐
 *      │ incomplete and polled            │ refused                        commit
 *      ▼                                  ▼                                 ▼
 *   STATUS missing                  STATUS refused                   STATUS committed
 *
 * A STATUS goes out when a fragment polls and when a message becomes complete. A
 * message that does not authenticate is forgotten and asked for again from the
 * start: one changed fragment must not lose it. Everything refused is counted
 * by cause (tally.h); no bytes stop the process.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_RECEIVER_H
#define TSR_SINK_RECEIVER_H

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tsr/host/keys.h"
#include "tsr/host/site.h"
#include "tsr/sink/select.h"
#include "tsr/sink/store.h"
#include "tsr/sink/tally.h"

extern "C" {
#include "tsr/wire/body.h"
}

namespace tsr
{

/* One message of events that was committed, for the log. */
struct EventReport {
    const SitePair *pair = nullptr;
    StoredEvents events;
};

/* One map that was committed, for the log. */
struct MapReport {
    std::uint16_t node = 0;
    std::string pair;
    std::uint32_t counter = 0;
    std::uint64_t capture_time_us = 0;
    std::size_t map_len = 0;
    std::size_t reference_len = 0;
    bool kept = false;
    std::optional<double> mse_px2;
};

class Receiver
{
  public:
    /* site and store are kept as long as the receiver is used. */
    Receiver(const Site &site, const KeyRing &keys, Store &store);

    /* Called once for each map after its commit. */
    void on_map(std::function<void(const MapReport &)> report) { report_ = std::move(report); }
    void on_events(std::function<void(const EventReport &)> report) { report_events_ = std::move(report); }

    /*
     * Fragments as they came, all committed together. One result each, in the
     * same order: the fragment (at most TSR_FRAME_PAYLOAD_MAX bytes) to send
     * down, or nothing.
     */
    std::vector<std::vector<std::uint8_t>> receive(std::span<const std::vector<std::uint8_t>> fragments);

    Tally &tally() { return tally_; }
    const Tally &tally() const { return tally_; }
    /* Fragments and messages that came again after their message was finished. */
    std::uint64_t repeated() const { return repeated_; }

  private:
    struct Assembly { /* a message on its way */
        tsr_reassembly state{};
        std::vector<std::uint8_t> message;
        std::uint64_t last_use = 0;
    };
    struct Finished {
        std::uint16_t message_id = 0;
        tsr_delivery state = TSR_DELIVERY_COMMITTED;
    };
    struct Origin {
        const SitePair *pair = nullptr; /* as lead or binocular node; null: sends no maps */
        tsr_cipher cipher{};
        std::array<Assembly, 2> assemblies; /* the newest message and a straggler */
        std::deque<Finished> finished;      /* newest first */
    };
    struct Verdict { /* what one fragment calls for */
        std::uint16_t node = 0;
        std::optional<tsr_body_status> status;
        bool stored = false; /* the status promises a commit of this batch */
        std::optional<MapReport> report;
        std::optional<EventReport> events;
    };

    Verdict judge_fragment(const std::vector<std::uint8_t> &bytes);
    Assembly *assembly_for(Origin &origin, const tsr_fragment &fragment);
    Verdict finish(Origin &origin, Assembly &assembly, const tsr_fragment &fragment);
    std::optional<Cause> open_message(Origin &origin, Assembly &assembly, tsr_message_header &header,
                                      std::span<const std::uint8_t> &body);
    std::optional<Cause> store_message(const Origin &origin, const tsr_message_header &header,
                                       std::span<const std::uint8_t> body, Verdict &verdict);
    std::optional<Cause> store_map(const Origin &origin, const tsr_message_header &header,
                                   std::span<const std::uint8_t> body, Verdict &verdict);
    std::optional<Cause> store_events(const Origin &origin, const tsr_message_header &header,
                                      std::span<const std::uint8_t> body, Verdict &verdict);
    void begin_storing(Verdict &verdict);
    bool commit(std::vector<Verdict> &verdicts);
    void remember_stored(Origin &origin, std::uint16_t node) const;

    const Site &site_;
    Store &store_;
    Selector selector_;
    std::map<std::uint16_t, Origin> origins_;
    Tally tally_;
    std::function<void(const MapReport &)> report_;
    std::function<void(const EventReport &)> report_events_;
    std::uint64_t repeated_ = 0;
    std::uint64_t clock_ = 0; /* counts fragments: the order of last use */
    bool in_transaction_ = false;
};

} // namespace tsr

#endif
