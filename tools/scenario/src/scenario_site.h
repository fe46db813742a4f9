/*
 * What a scenario says of its site.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_SCENARIO_SITE_H
#define TSR_SCENARIO_SCENARIO_SITE_H

#include "tsr/host/site.h"
#include "tsr/scenario/scenario.h"

namespace tsr
{

/* Without nodes, pairs and zones. */
Site site_of(const Scenario &scenario);

} // namespace tsr

#endif
