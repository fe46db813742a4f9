/*
 * Which node hands its messages to which.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_TREE_H
#define TSR_SCENARIO_TREE_H

#include "tsr/host/site.h"

namespace tsr
{

/* Sets the parents of all nodes but the gateway and wings: a binary tree with short links (tsr/scenario/staging.h). */
void join_tree(Site &site, double reach_m);

} // namespace tsr

#endif
