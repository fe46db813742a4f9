/*
 * Choosing a scene.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/scene.h"

#include <map>
#include <stdexcept>

#include "scene_parts.h"

namespace tsr::scene
{

namespace
{

using Maker = Scene (*)(const SceneOptions &, const LayoutOptions &);

const std::map<std::string, Maker> &makers()
{
    static const std::map<std::string, Maker> all = {{"bedroom", make_bedroom},
                                                     {"car", make_car},
                                                     {"house", make_house},
                                                     {"street", make_street},
                                                     {"tank", make_tank}};
    return all;
}

} // namespace

const std::vector<std::string> &scene_kinds()
{
    static const std::vector<std::string> kinds = [] {
        std::vector<std::string> names;
        for (const auto &[name, maker] : makers()) {
            names.push_back(name);
        }
        return names;
    }();
    return kinds;
}

Scene make_scene(const SceneOptions &options, const LayoutOptions &layout)
{
    const auto maker = makers().find(options.kind);
    if (maker == makers().end()) {
        throw std::invalid_argument("no scene '" + options.kind + "'");
    }
    return maker->second(options, layout);
}

} // namespace tsr::scene
