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
#include "tsr/emulator/render_pool.h"
#include "tsr/scenario/virtual_camera.h"

namespace tsr
{

class ScenePictures : public Pictures
{
  public:
    /* Scenario and staging are kept. threads >= 1 render; the result does not depend on their number. */
    ScenePictures(const Scenario &scenario, const Staging &staging, unsigned threads);
    /* Octets of what its cameras keep between captures. */
    static std::uint64_t memory(const Staging &staging);

    std::unique_ptr<FrameSource> source(const SiteNode &node, bool right) override;
    std::uint64_t end_us() const override;
    std::optional<PairTruth> truth(const SitePair &pair, std::uint64_t time_us) override;
    std::vector<SceneEvent> events() const override;

  private:
    /* A wing's only camera is the right one of its pair. */
    VirtualCamera *camera(std::uint16_t node, bool right);

    const Scenario &scenario_;
    const Staging &staging_;
    scene::RayCaster caster_; /* of this thread, for truths */
    std::map<std::pair<std::uint16_t, bool>, std::unique_ptr<VirtualCamera>> cameras_;
    RenderPool pool_; /* ends before the cameras do */
};

} // namespace tsr

#endif
