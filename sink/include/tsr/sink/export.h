/*
 * What the sink knows, as files; every one complete or absent, and equal for
 * equal stores: no time of day, nothing unsorted.
 *
 *   cloud.ply                       latest kept map of each pair, site metres, coloured
 *   maps/NODE-COUNTER.pfm           each map, restored, disparity in px, +infinity = no match
 *   maps/NODE-COUNTER.png           the same in colours (tsr/host/colour_map.h)
 *   maps/NODE-COUNTER-reference.png its reference image, if one came
 *   events.csv                      one line per event of a depth rule, in the order of arrival
 *   sink.json                       numbers: per node and pair, events, and refusals by cause
 *
 * Cloud, PFM and PNG are of restored maps (tsr/codec/map_restore.h); the maps as sent are in the store.
 * NODE has five digits and COUNTER ten, so names sort as numbers do.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_EXPORT_H
#define TSR_SINK_EXPORT_H

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "tsr/host/site.h"
#include "tsr/sink/link_session.h"
#include "tsr/sink/store.h"
#include "tsr/sink/tally.h"

namespace tsr
{

/* What this process has seen; zero after a mere export. */
struct SessionNumbers {
    Tally tally;
    LinkCounts link;
    std::uint64_t repeated_messages = 0;
};

struct ExportResult {
    std::size_t maps = 0;
    std::size_t events = 0;
    std::size_t points = 0; /* in cloud.ply */
};

/* Creates folder out if needed. Throws InputError if it cannot write there. */
ExportResult export_site(const Site &site, const Store &store, const SessionNumbers &session,
                         const std::filesystem::path &out);

} // namespace tsr

#endif
