/*
 * An image sensor: light in, gray levels out.
 *
 *   e    = full_well exposure radiance (1 - v r^2)                 electrons, at most the full well
 *   n    = e + sqrt(e) g1 + read_noise g2                              shot noise as its normal limit
 *   gray = round(255 gain n / full_well), 0 .. 255
 *
 * with g1, g2 of mean 0 and variance 1 (EMVA 1288, release 4.0, chapter 2: the linear camera
 * model), v the vignetting, r = 1 in the corners. Randomness is a hash of seed, capture
 * and pixel: equal captures are equal.
 *
 * Exposure control, as sensors have it: after each capture the mean gray level is compared with
 * the wanted one; outside a dead band exposure and gain go towards it in steps of 1/8, at most
 * by half, exposure first, gain when exposure is at its end. The next capture has the new values.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_SENSOR_H
#define TSR_SCENE_SENSOR_H

#include <cstdint>

extern "C" {
#include "tsr/base/image.h"
}
#include "tsr/scene/view.h"

namespace tsr::scene
{

struct SensorModel {
    bool noise = true;
    float full_well_e = 10'000; /* electrons at gray 255 with gain 1; HM01B0-like: small pixels */
    float read_noise_e = 15;    /* electrons, RMS */
    float vignetting = 0.25F;   /* light lost in the corners, 0 .. 1 */
    bool exposure_control = true;
    float wanted_mean = 110; /* gray levels */
    float dead_band = 12;    /* gray levels to either side */
    float gain_max = 8;
    std::uint64_t seed = 1;
};

class Sensor
{
  public:
    explicit Sensor(const SensorModel &model) : model_(model) {}

    /* Expose layers under light into image, whose size is the camera's. */
    void expose(const Camera &camera, const Layers &layers, const Light &light, const tsr_gray &image);

    /* For the sensor at its side, which must see alike: the same exposure and gain from now on. */
    void follow(const Sensor &other);

    float exposure() const { return exposure_; } /* 1/64 .. 1 of the longest */
    float gain() const { return gain_; }
    std::uint64_t captures() const { return captures_; }

  private:
    void control(const tsr_gray &image);

    SensorModel model_;
    float exposure_ = 0.5F;
    float gain_ = 1;
    std::uint64_t captures_ = 0;
};

} // namespace tsr::scene

#endif
