/*
 * What each zone of a run came to.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_ZONE_RECORD_H
#define TSR_EMULATOR_ZONE_RECORD_H

#include <cstddef>
#include <vector>

#include "tsr/emulator/run_record.h"

namespace tsr
{

struct ZoneRecord {
    const SitePair *pair = nullptr;
    const SiteZone *zone = nullptr;
    std::size_t events = 0; /* that the sink has */
    /* It began at its pair's first look and never ended: what always stands there is beyond its limit, and it can tell
     * of nothing else. Not of one that follows a surface. */
    bool always_begun = false;
};

/* Of all zones, in the site's order. run is kept by pointers. */
std::vector<ZoneRecord> zone_records(const RunRecord &run);

} // namespace tsr

#endif
