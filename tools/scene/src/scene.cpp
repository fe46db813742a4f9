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

namespace
{

/* Shadows step as far as the true sun's do in a minute, 0.25 degrees, however fast it goes; those of a sun that stands
 * never do. */
std::uint64_t sun_step_us(const SceneOptions &options)
{
    if (options.sun_hours <= 0) {
        return UINT64_MAX;
    }
    return static_cast<std::uint64_t>(60e6 * options.duration_s / (3600 * options.sun_hours)) + 1;
}

} // namespace

Scene make_scene(const SceneOptions &options, const LayoutOptions &layout)
{
    const auto maker = makers().find(options.kind);
    if (maker == makers().end()) {
        throw std::invalid_argument("no scene '" + options.kind + "'");
    }
    Scene scene = maker->second(options, layout);
    scene.world.sun_step_us = sun_step_us(options);
    return scene;
}

} // namespace tsr::scene
