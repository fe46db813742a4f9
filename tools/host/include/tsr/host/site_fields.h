/*
 * Tables of site.toml that other files have too, docs/units.md, 2.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_SITE_FIELDS_H
#define TSR_HOST_SITE_FIELDS_H

#include "tsr/host/site.h"
#include "tsr/host/toml_fields.h"

namespace tsr
{

/* [radio], [thresholds] and [battery]: what the table gives, the rest unchanged. Throw InputError; unknown fields are
 * refused. */
void read_radio(TomlFields &fields, SiteRadio &radio);
void read_thresholds(TomlFields &fields, SiteThresholds &limits);
void read_battery(TomlFields &fields, SiteBattery &battery);
/* All [[fault]] tables of a file; whether their nodes can have them, check_site() tells. */
std::vector<SiteFault> read_faults(TomlFields &top);
/* All [[zone]] tables; of_any_pair: one that names no pair is every pair's. */
std::vector<SiteZone> read_zones(TomlFields &top, bool of_any_pair);
/* Gives each pair its own. Throws InputError for a pair that does not exist; check_site() looks at the rest. */
void place_zones(Site &site, const std::vector<SiteZone> &zones);

} // namespace tsr

#endif
