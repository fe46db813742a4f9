/*
 * One camera of a scenario: its view of the scene and its sensor.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_VIRTUAL_CAMERA_H
#define TSR_SCENARIO_VIRTUAL_CAMERA_H

#include "tsr/host/pfm.h"
#include "tsr/scenario/staging.h"
#include "tsr/scene/view.h"

namespace tsr
{

class VirtualCamera
{
  public:
    /* staging is kept. */
    VirtualCamera(const Scenario &scenario, const Staging &staging, const StagedCamera &camera);

    /* Two sensors on one board expose alike: for captures of one instant this one takes the other's exposure and gain.
     * The other is kept. */
    void follow(const VirtualCamera &other) { master_ = &other; }

    /* A capture whose exposure begins at time_us, or the jitter off it, in two steps. The first, which takes long, may
     * run on another thread than all else, but not beside anything of this camera. */
    void render(scene::RayCaster &caster, std::uint64_t time_us);
    /* image has the camera's size. */
    void expose(std::uint64_t time_us, const tsr_gray &image);
    void capture(scene::RayCaster &caster, std::uint64_t time_us, const tsr_gray &image)
    {
        render(caster, time_us);
        expose(time_us, image);
    }

    const scene::Camera &camera() const { return view_.camera(); }
    /* Of the pixels' centres, without jitter. */
    scene::Truth truth(scene::RayCaster &caster, std::uint64_t time_us) const { return view_.truth(caster, time_us); }
    std::uint64_t traced() const { return view_.traced(); }

  private:
    std::uint64_t jittered(std::uint64_t time_us) const;

    const Staging &staging_;
    scene::View view_;
    const scene::Layers *layers_ = nullptr; /* the last rendered */
    scene::Sensor sensor_;
    const VirtualCamera *master_ = nullptr;
    std::uint64_t last_us_ = UINT64_MAX; /* of the last capture */
    scene::Sensor last_sensor_;          /* before it */
    std::uint64_t seed_;
    std::uint64_t jitter_us_;
};

/* What a perfect matcher finds: d = f B / Z - d0, kFloatInvalid for the sky. */
FloatImage true_disparity(const SitePair &pair, const scene::Truth &truth);

} // namespace tsr

#endif
