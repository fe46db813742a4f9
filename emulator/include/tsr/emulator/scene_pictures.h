/*
 * Pictures of a virtual scene, made when a camera asks for them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_SCENE_PICTURES_H
#define TSR_EMULATOR_SCENE_PICTURES_H

#include <map>
#include <memory>

#include "tsr/emulator/pictures.h"
#include "tsr/scenario/virtual_camera.h"

namespace tsr
{

class ScenePictures : public Pictures
{
  public:
    /* Both are kept. */
    ScenePictures(const Scenario &scenario, const Staging &staging);

    std::unique_ptr<FrameSource> source(const SiteNode &node, bool right) override;
    std::uint64_t end_us() const override;
    std::optional<PairTruth> truth(const SitePair &pair, std::uint64_t time_us) override;

  private:
    /* A wing's only camera is the right one of its pair. */
    VirtualCamera *camera(std::uint16_t node, bool right);

    const Scenario &scenario_;
    scene::RayCaster caster_;
    std::map<std::pair<std::uint16_t, bool>, std::unique_ptr<VirtualCamera>> cameras_;
};

} // namespace tsr

#endif
