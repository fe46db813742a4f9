/*
 * Refusing a site with the place of the fault.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_SITE_FAULTS_H
#define TSR_HOST_SITE_FAULTS_H

#include <string>

#include "tsr/host/site.h"

namespace tsr
{

[[noreturn]] void refuse_site(const Site &site, int line, const std::string &field, const std::string &reason);
[[noreturn]] void refuse_node(const Site &site, const SiteNode &node, const std::string &field,
                              const std::string &reason);
[[noreturn]] void refuse_pair(const Site &site, const SitePair &pair, const std::string &field,
                              const std::string &reason);

/* What is wrong, or nothing. */
std::string fault_in_name(const std::string &name);
std::string fault_in_rectangle(const SiteRectangle &part, const SitePair &pair);

/* The cameras of a pair: rotations that are rotations, a right camera that
 * stands where the baseline says and looks the same way. Throws InputError. */
void check_pair_geometry(const Site &site, const SitePair &pair);

/* Faults of nodes that exist, can have them and live. Throws InputError. */
void check_faults(const Site &site);
/* Zones inside their pictures, with limits that their pair can measure. Throws InputError. */
void check_zones(const Site &site);

} // namespace tsr

#endif
