/*
 * Geometries that cannot be.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_IMPOSSIBLE_H
#define TSR_SCENARIO_IMPOSSIBLE_H

#include "tsr/scenario/staging.h"

namespace tsr
{

/* Throws InputError for the first one found: see stage_scenario(). */
void refuse_impossible(const Scenario &scenario, const Staging &staging);

} // namespace tsr

#endif
