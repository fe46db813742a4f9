/* Look-ups in a site. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/site.h"

#include <algorithm>
#include <stdexcept>

namespace tsr
{

std::string_view role_name(Role role)
{
    switch (role) {
    case Role::gateway: return "gateway";
    case Role::relay: return "relay";
    case Role::lead: return "lead";
    case Role::wing: return "wing";
    case Role::binocular: return "binocular";
    }
    return "unknown";
}

bool has_camera(Role role)
{
    return role == Role::lead || role == Role::wing || role == Role::binocular;
}

const SiteNode *Site::node(std::uint16_t id) const
{
    const auto found = std::find_if(nodes.begin(), nodes.end(), [id](const SiteNode &n) { return n.id == id; });
    return found == nodes.end() ? nullptr : &*found;
}

const SiteNode &Site::gateway() const
{
    const auto found =
        std::find_if(nodes.begin(), nodes.end(), [](const SiteNode &n) { return n.role == Role::gateway; });
    if (found == nodes.end()) {
        throw std::logic_error("Site::gateway: the site was not checked");
    }
    return *found;
}

const SitePair *Site::pair_of(std::uint16_t camera_node) const
{
    const auto found = std::find_if(pairs.begin(), pairs.end(), [camera_node](const SitePair &p) {
        return camera_node != kNodeNone && (p.lead == camera_node || p.wing == camera_node);
    });
    return found == pairs.end() ? nullptr : &*found;
}

std::filesystem::path Site::resolve(const std::filesystem::path &folder) const
{
    return file.parent_path() / folder;
}

} // namespace tsr
