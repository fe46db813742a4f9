/*
 * Virtual cameras for nodes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/scene_pictures.h"

#include <cmath>

namespace tsr
{

namespace
{

class SceneSource : public FrameSource
{
  public:
    SceneSource(VirtualCamera &camera, scene::RayCaster &caster) : camera_(camera), caster_(caster) {}

    ImageSize size() const override { return {camera_.camera().width, camera_.camera().height}; }
    void show(std::uint64_t time_us, const tsr_gray &image) override { camera_.capture(caster_, time_us, image); }

  private:
    VirtualCamera &camera_;
    scene::RayCaster &caster_;
};

} // namespace

ScenePictures::ScenePictures(const Scenario &scenario, const Staging &staging)
    : scenario_(scenario), caster_(*staging.geometry)
{
    for (const StagedCamera &staged : staging.cameras) {
        auto &camera = cameras_[{staged.node, staged.right}];
        camera = std::make_unique<VirtualCamera>(scenario, staging, staged);
        if (staged.right && !scenario.pairs.two_boards) {
            camera->follow(*cameras_.at({staged.node, false}));
        }
    }
}

VirtualCamera *ScenePictures::camera(std::uint16_t node, bool right)
{
    const auto found = cameras_.find({node, right});
    return found == cameras_.end() ? nullptr : found->second.get();
}

std::unique_ptr<FrameSource> ScenePictures::source(const SiteNode &node, bool right)
{
    if (right && node.role == Role::wing) {
        return nullptr;
    }
    VirtualCamera *seen = camera(node.id, right || node.role == Role::wing);
    return seen == nullptr ? nullptr : std::make_unique<SceneSource>(*seen, caster_);
}

std::uint64_t ScenePictures::end_us() const
{
    return static_cast<std::uint64_t>(std::llround(scenario_.scene.duration_s * 1e6));
}

std::optional<PairTruth> ScenePictures::truth(const SitePair &pair, std::uint64_t time_us)
{
    return PairTruth{true_disparity(pair, camera(pair.lead, false)->truth(caster_, time_us)), pair.name};
}

} // namespace tsr
