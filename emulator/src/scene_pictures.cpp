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
    SceneSource(VirtualCamera &camera, RenderPool &pool) : camera_(camera), pool_(pool) {}

    ImageSize size() const override { return {camera_.camera().width, camera_.camera().height}; }
    void prepare(std::uint64_t time_us) override
    {
        if (rendered_.valid()) { /* of a capture that lost its power */
            rendered_.wait();
        }
        prepared_us_ = time_us;
        rendered_ = pool_.render(camera_, time_us);
    }
    /* For the instant that was prepared: a clock may have been set meanwhile. */
    void show(std::uint64_t, const tsr_gray &image) override
    {
        rendered_.get();
        camera_.expose(prepared_us_, image);
    }

  private:
    VirtualCamera &camera_;
    RenderPool &pool_;
    std::future<void> rendered_;
    std::uint64_t prepared_us_ = 0;
};

} // namespace

ScenePictures::ScenePictures(const Scenario &scenario, const Staging &staging, unsigned threads)
    : scenario_(scenario), staging_(staging), caster_(*staging.geometry), pool_(*staging.geometry, threads)
{
    for (const StagedCamera &staged : staging.cameras) {
        auto &camera = cameras_[{staged.node, staged.right}];
        camera = std::make_unique<VirtualCamera>(scenario, staging, staged);
        if (staged.right && !scenario.pairs.two_boards) {
            camera->follow(*cameras_.at({staged.node, false}));
        }
    }
}

std::uint64_t ScenePictures::memory(const Staging &staging)
{
    std::uint64_t octets = 0;
    for (const auto &[node, right, camera] : staging.cameras) {
        octets += static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height) *
                  scene::View::kOctetsPerPixel;
    }
    return octets;
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
    return seen == nullptr ? nullptr : std::make_unique<SceneSource>(*seen, pool_);
}

std::uint64_t ScenePictures::end_us() const
{
    return static_cast<std::uint64_t>(std::llround(scenario_.scene.duration_s * 1e6));
}

std::optional<PairTruth> ScenePictures::truth(const SitePair &pair, std::uint64_t time_us)
{
    return PairTruth{true_disparity(pair, camera(pair.lead, false)->truth(caster_, time_us)), pair.name};
}

std::vector<SceneEvent> ScenePictures::events() const
{
    std::vector<SceneEvent> events;
    for (const scene::Event &event : staging_.scene->world.events) {
        events.push_back({event.time_us, event.what});
    }
    return events;
}

} // namespace tsr
