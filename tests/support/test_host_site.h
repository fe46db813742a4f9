/*
 * A small site for tests: gateway 1, relay 2, lead 3 with wing 4, binocular 5.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_HOST_SITE_H
#define TSR_TEST_HOST_SITE_H

#include "tsr/host/site.h"

namespace tsr::test
{

inline SitePair pair_of_size(const std::string &name, std::uint16_t lead, std::uint16_t wing, int width, int height)
{
    SitePair pair;
    pair.name = name;
    pair.lead = lead;
    pair.wing = wing;
    pair.width = width;
    pair.height = height;
    pair.disparities = 16;
    pair.focal_px = 100.0;
    pair.baseline_mm = 60.0;
    pair.d0_px = 1.5;
    pair.principal_px = {(width - 1) / 2.0, (height - 1) / 2.0};
    return pair;
}

inline Site small_site()
{
    Site site;
    site.name = "test";
    const auto add = [&](std::uint16_t id, Role role, std::uint16_t parent) {
        SiteNode node;
        node.id = id;
        node.name = "node " + std::to_string(id);
        node.role = role;
        node.parent = parent;
        node.position_m = {1.0 * id, 0.5, 2.0};
        site.nodes.push_back(node);
    };
    add(1, Role::gateway, kNodeNone);
    add(2, Role::relay, 1);
    add(3, Role::lead, 2);
    add(4, Role::wing, 3);
    add(5, Role::binocular, 2);
    site.pairs = {pair_of_size("porch", 3, 4, 32, 24), pair_of_size("yard", 5, kNodeNone, 48, 32)};
    return site;
}

} // namespace tsr::test

#endif
